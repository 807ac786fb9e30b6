// Proofs about OpenFOAM's skewness at sharp edges of the wall. A line that sees both facets lies in the narrow wedge between their extensions. The side between
// the two columns also lies there, while the centres of their cells lie far back on the two facets. The line between the centres passes the side's centre at a
// distance that hardly depends on the direction within the wedge. The search covers all directions of the edge's two lines that see both facets at least half
// as well as the best direction does. It proceeds by boxes of directions, and bounds the skewness in each box by interval arithmetic.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/base/print_text.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/math/spherical_cap.h"
#include "geom/mesh/forced_layer.h"

namespace sterna::check_parts {
namespace {

/// Number of direction boxes for each of the edge's lines.
constexpr int k_wedge_boxes = 16;
/// Fraction of the distance between the centres that counts as a side's extent (OpenFOAM).
constexpr double k_centre_reach = 0.2;
/// rad; half of the widest wedge that is searched. In a wider wedge no skewness is forced.
constexpr double k_widest_half_wedge = 15 * k_degree;
/// Part of the wedge, around its middle, that is assumed to contain the lines: they see both facets at least half as well as the best direction does.
constexpr double k_used_wedge = 0.5;
/// Largest assumed rise of one end of a triangle over the other, relative to their distance. It is the largest amount by which a step that leans by 10 degrees
/// along the edge can increase its angle.
constexpr double k_twist = 0.1;

/// Edges at which the wall turns back to within this angle, rad, are sharp: they need several normals.
constexpr double k_sharp = 80 * k_degree;
/// The skewness of a thin layer may exceed that of the bare wall's edge by this factor.
constexpr double k_like = 1.05;

struct Interval {
  double low = 0.0, high = 0.0;
  Interval grown(double by) const { return {low - by, high + by}; }
};
Interval operator*(double factor, const Interval& i) {
  return factor >= 0.0 ? Interval{factor * i.low, factor * i.high} : Interval{factor * i.high, factor * i.low};
}
Interval operator+(const Interval& a, const Interval& b) { return {a.low + b.low, a.high + b.high}; }

/// Returns the share of a corner with height `own` in the centre of a prism whose other two heights sum to `others`.
double share_of(double own, double others) { return (2.0 * own + others) / (4.0 * (own + others)); }
Interval share(const Interval& own, const Interval& others) { return {share_of(own.low, others.high), share_of(own.high, others.low)}; }

/// Returns the heights over a facet of a step of length `length` at angles `from` to `to` off the facet's plane.
Interval heights(const Interval& length, double from, double to) {
  return {length.low * std::sin(std::clamp(from, 0.0, 0.5 * std::numbers::pi)), length.high * std::sin(std::clamp(to, 0.0, 0.5 * std::numbers::pi))};
}

/// Returns x / (x + y) for x and y of at least zero, each known within `error`.
Interval part(const Interval& x, const Interval& y, double error) {
  const auto of = [](double a, double b) { return a + b > 0.0 ? a / (a + b) : 0.5; };
  return {of(std::max(0.0, x.low - error), y.high + error), of(x.high + error, std::max(0.0, y.low - error))};
}

}  // namespace

/// Geometry of the edge: two triangles that meet at it in a wedge.
struct GivenLayer::Wedge {
  std::array<double, 2> reach{};     ///< m, distances of the opposite corners from the edge
  std::array<double, 2> along{};     ///< m, positions of the opposite corners along the edge, from its first end
  std::array<Interval, 2> far{};     ///< m, heights of the steps of the opposite lines
  std::array<Interval, 2> opened{};  ///< rad, opening of the layer triangles beyond the wall triangles, since their far corners have risen
  std::array<Interval, 2> across{};  ///< m, components of the steps at the edge's ends, perpendicular to it
  double edge = 0.0;                 ///< m
  double half = 0.0;                 ///< rad, half of the angle between the triangles
  double visible = 0.0;              ///< rad, largest angle of a step to the wedge's middle plane
  double moved_along = 0.0;          ///< m, as `moved`, along the edge
  double moved = 0.0;                ///< m, largest distance of a corner of the two cells from the wall
  double error = 0.0;                ///< m, error of the centres' distances from the side's plane

  double least_skewness(int box_a, int box_b) const;
};

double GivenLayer::Wedge::least_skewness(int box_a, int box_b) const {
  const auto direction = [&](int box) {
    const double width = 2.0 * visible / k_wedge_boxes;
    return Interval{-visible + box * width, -visible + (box + 1) * width};
  };
  const std::array<Interval, 2> psi = {direction(box_a), direction(box_b)};
  const Interval middle = {std::min(psi[0].low, psi[1].low), std::max(psi[0].high, psi[1].high)};
  std::array<Interval, 2> t, y, off;  // position of a cell centre along the edge, its distance from the edge in the triangle's plane, and its distance from the
                                      // side's plane
  for (std::size_t i = 0; i < 2; ++i) {
    const double sign = i == 0 ? 1.0 : -1.0;
    const auto to_facet = [&](const Interval& p) { return sign > 0.0 ? Interval{half - p.high, half - p.low} : Interval{half + p.low, half + p.high}; };
    std::array<Interval, 2> h;
    for (std::size_t k = 0; k < 2; ++k) h[k] = heights(across[k], to_facet(psi[k]).low + opened[i].low, to_facet(psi[k]).high + opened[i].high);
    const Interval at_far = share(far[i], h[0] + h[1]), at_end = share(h[1], h[0] + far[i]);
    t[i] = edge * at_end + along[i] * at_far;
    y[i] = reach[i] * at_far;
    const Interval angle = to_facet(middle);
    off[i] = {y[i].low * std::sin(std::max(0.0, angle.low)), y[i].high * std::sin(std::max(0.0, angle.high))};
  }
  const Interval f = part(off[0], off[1], error);
  Interval crossing = {k_infinity, -k_infinity};
  double apart = 0.0;
  for (const double t0 : {t[0].low, t[0].high})
    for (const double t1 : {t[1].low, t[1].high}) {
      for (const double share_of_way : {f.low, f.high}) {
        const double at = t0 + share_of_way * (t1 - t0);
        crossing = {std::min(crossing.low, at), std::max(crossing.high, at)};
      }
      for (const double y0 : {y[0].low, y[0].high})
        for (const double y1 : {y[1].low, y[1].high})
          apart = std::max(apart, std::sqrt((t1 - t0) * (t1 - t0) + y0 * y0 + y1 * y1 - 2.0 * y0 * y1 * std::cos(2.0 * half)));
    }
  apart += 2.0 * moved;
  // Position of the side's centre along the edge, and the distance of its corners from there.
  const auto centre_at = [&](double first, double second) { return edge * (first + 2.0 * second) / (3.0 * (first + second)); };
  const Interval centre = {centre_at(across[0].high, across[1].low), centre_at(across[0].low, across[1].high)};
  const double reach_along = std::max(centre.high, edge - centre.low) + 2.0 * moved_along;
  const Interval beside = Interval{crossing.low - centre.high, crossing.high - centre.low}.grown(2.0 * moved_along);
  const double most_beside = std::max(std::abs(beside.low), std::abs(beside.high));
  const double least_beside = beside.low > 0.0 ? beside.low : beside.high < 0.0 ? -beside.high : 0.0;
  const double back = std::min(y[0].low, y[1].low) * std::cos(half + visible) - 2.0 * moved;
  if (!(back > 0.0)) return 0.0;
  // Let a miss be the vector (e, x) from the line to the side's centre, e along the edge and x perpendicular to it. The side's extent is at most (e reach_along
  // + x thick) / |miss|. The skewness is least at e = `worst`, and grows with x if the side is thin.
  const double thick = 2.0 * moved;
  if (thick * most_beside > 2.0 * back * reach_along) return 0.0;
  const double worst = std::clamp(back * (std::hypot(thick, reach_along) - thick) / reach_along, least_beside, most_beside);
  const double by_side = (worst * worst + back * back) / (worst * reach_along + back * thick);
  return std::min(by_side, std::hypot(least_beside, back) / (k_centre_reach * apart));
}

std::optional<Forcing> GivenLayer::skewness(const ColumnSide& side, double limit) const {
  if (!is_between_prisms(side)) return std::nullopt;
  const std::array<std::uint32_t, 4> lines = lines_of(side);
  const Point &a = base_point(lines[0]), &b = base_point(lines[1]);
  const Vec3 n0 = area_vector(a, b, base_point(lines[2])), n1 = area_vector(b, a, base_point(lines[3]));
  if (!(dot(n0, base_point(lines[3]) - a) < 0.0)) return std::nullopt;  // the fluid is not on the outer side
  Wedge wedge;
  wedge.edge = distance(a, b);
  wedge.half = 0.5 * (std::numbers::pi - angle_between(n0, n1));
  const Vec3 along = (b - a) / wedge.edge;
  if (!(wedge.half < k_widest_half_wedge)) return std::nullopt;
  for (const std::uint32_t line : lines) wedge.moved = std::max(wedge.moved, length(line, side.layer + 1));
  wedge.visible = k_used_wedge * wedge.half;
  const double twist = k_twist * wedge.moved / wedge.edge;
  double longest = 0.0, leaning = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::uint32_t opposite = lines[2 + i];
    longest = std::max(longest, longest_side(a, b, base_point(opposite)));
    wedge.reach[i] = 2.0 * norm(i == 0 ? n0 : n1) / wedge.edge;
    wedge.along[i] = dot(base_point(opposite) - a, along);
    const double lean = smallest_spherical_cap(normals_around(opposite)).angle + k_lean_room;
    const double angle = angle_between(smallest_spherical_cap(normals_around(lines[i])).axis, along), off = std::abs(angle - 0.5 * std::numbers::pi);
    if (!(lean < 0.5 * std::numbers::pi && off + k_lean_room < 0.5 * std::numbers::pi)) return std::nullopt;
    leaning = std::max({leaning, lean, off + k_lean_room});
    const double rise = length(opposite, side.layer) * std::cos(lean), top = length(opposite, side.layer + 1);
    const double ends = wedge.moved * std::sin(wedge.half + wedge.visible);
    wedge.opened[i] =
        Interval{std::asin(std::clamp((rise - ends) / wedge.reach[i], -1.0, 1.0)), std::asin(std::clamp(top / wedge.reach[i], -1.0, 1.0))}.grown(twist);
    const double own = step(opposite, side.layer), end = step(lines[i], side.layer);
    wedge.far[i] = {own * std::cos(std::min(lean + std::max(0.0, wedge.opened[i].high), 0.5 * std::numbers::pi)), own};
    wedge.across[i] = {end * std::cos(off + k_lean_room), end * std::cos(std::max(0.0, off - k_lean_room))};
  }
  wedge.moved_along = wedge.moved * std::sin(leaning);
  wedge.error = 2.0 * wedge.moved * (1.0 + longest / wedge.edge);
  double bound = k_infinity;
  for (int i = 0; i < k_wedge_boxes; ++i)
    for (int j = 0; j < k_wedge_boxes; ++j) {
      bound = std::min(bound, wedge.least_skewness(i, j));
      if (!(bound > limit)) return std::nullopt;
    }
  return Forcing{"the wall has a sharp edge of " + print_text("%.3g deg", 2.0 * wedge.half * k_degrees) + " here: no skewness can be below " +
                     print_text("%.3g", bound) + " with one growth line per node",
                 k_more_normals};
}

std::optional<Forcing> GivenLayer::skewness_of_edge(const ColumnSide& side, double limit, double value) const {
  if (!is_between_prisms(side)) return std::nullopt;
  const std::array<std::uint32_t, 4> lines = lines_of(side);
  const Point &a = base_point(lines[0]), &b = base_point(lines[1]);
  const std::array<Vec3, 2> normals = {normalized(area_vector(a, b, base_point(lines[2]))), normalized(area_vector(b, a, base_point(lines[3])))};
  const double angle = std::numbers::pi - angle_between(normals[0], normals[1]);
  if (!(dot(normals[0], base_point(lines[3]) - a) < 0.0 && angle < k_sharp)) return std::nullopt;
  const auto best = [&](std::uint32_t line) { return smallest_spherical_cap(normals_around(line)).axis; };
  const std::array<Vec3, 2> along_lines = {best(lines[0]), best(lines[1])};
  std::array<Point, 2> centres;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto height = [&](std::uint32_t line, const Vec3& direction) { return step(line, side.layer) * std::max(0.0, dot(direction, normals[i])); };
    const double first = height(lines[0], along_lines[0]), second = height(lines[1], along_lines[1]), far = height(lines[2 + i], best(lines[2 + i]));
    if (!(first + second + far > 0.0)) return std::nullopt;
    centres[i] = share_of(first, second + far) * a + share_of(second, far + first) * b + share_of(far, first + second) * base_point(lines[2 + i]);
  }
  const double at_a = step(lines[0], side.layer), at_b = step(lines[1], side.layer);
  const Point middle = a + (at_a + 2.0 * at_b) / (3.0 * (at_a + at_b)) * (b - a);
  const Vec3 normal = cross(b - a, along_lines[0] + along_lines[1]), between = centres[1] - centres[0], to_side = middle - centres[0];
  if (dot(normal, between) == 0.0) return std::nullopt;
  const Vec3 miss = to_side - (dot(normal, to_side) / dot(normal, between)) * between;
  const Vec3 direction = normalized(miss);
  const double reach = std::max({k_centre_reach * norm(between), std::abs(dot(direction, a - middle)), std::abs(dot(direction, b - middle))});
  const double of_wall = norm(miss) / reach;
  if (!(k_like * of_wall > limit && value <= k_like * of_wall)) return std::nullopt;
  return Forcing{"the wall has a sharp edge of " + print_text("%.3g deg", angle * k_degrees) +
                     " here: with one growth line per node, in the direction of best " + "visibility, thin cells have a skewness of " +
                     print_text("%.3g", of_wall),
                 k_more_normals};
}

}  // namespace sterna::check_parts
