#include "surfmesh/remesh/line_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "surfmesh/model/band_wish.h"
#include "surfmesh/remesh/remesh_sizes.h"

namespace sterna::surfmesh {
namespace {

/// A line is looked at in so many places; one of nine may say something else.
constexpr std::size_t k_row_looks = 9;
constexpr double k_row_agreeing = 8.0 / 9.0;
/// As of edges of CAD (wing_bands.cpp): sharp, between a base and the sides of the wing, and the part of x in where an edge looks.
constexpr double k_sharp_line = 120.0 * k_degree;
constexpr double k_base_from = 40.0 * k_degree, k_base_to = 140.0 * k_degree;
constexpr double k_looks_aft = 0.2;
/// A base is longer than wide by this, and narrower than this part of what is beside it.
constexpr double k_base_length = 3.0, k_base_width = 0.1;
/// A nose's radius is at most this part of the width beside it, as of CAD (wing_bands.cpp), seen over this part of it, and it is longer than this part of it.
constexpr double k_widest_nose = 0.125, k_nose_probe = 0.01, k_nose_length = 0.25;
/// Sides of a leading edge are as wide as each other within this factor.
constexpr double k_alike_width = 3.0;
/// Change of the length along by distance where rows of a nose end.
constexpr double k_change_at_ends = 0.3;
/// Triangles that one way across the surface passes.
constexpr int k_most_passed = 100'000;

enum class LineKind { leading, trailing };

/// A line at one place.
struct LineLook {
  std::array<TriangleId, 2> triangle;  ///< left, right
  double turn = 0.0;                   ///< rad
  bool is_convex = false;
  Vec3 looks;                   ///< unit: away from both sides, in the middle between them
  std::array<Vec3, 2> normal;   ///< of the surface beside it
  std::array<double, 2> width;  ///< m, across each side
};

LineLook look_at_line(const Reference& r, const FeatureLine& line, std::size_t segment, double most) {
  LineLook look;
  HalfedgeId left = line.halfedges[segment];
  if (r.topology.from(left) != line.vertices[segment]) left = r.topology.twin(left);
  const std::array<HalfedgeId, 2> sides{left, r.topology.twin(left)};
  std::array<Vec3, 2> inwards;
  for (std::size_t k = 0; k < 2; ++k) {
    const HalfedgeId h = sides[k];
    look.triangle[k] = triangle_of(h);
    look.normal[k] = normalized(r.normals[h] + r.normals[next(h)]);
    const Vec3 along = r.mesh->points[r.topology.to(h)] - r.mesh->points[r.topology.from(h)];
    inwards[k] = normalized(cross(look.normal[k], along));
    look.width[k] = width_across(r, h, most);
  }
  look.turn = angle_between(look.normal[0], look.normal[1]);
  look.is_convex = dot(look.normal[0], inwards[1]) < 0.0;
  look.looks = normalized(-1.0 * (inwards[0] + inwards[1]));
  return look;
}

struct LineShape {
  std::size_t n = 0, n_sharp = 0, n_convex = 0, n_corner = 0;
  double looks = 0.0;                     ///< mean x
  std::array<double, 2> looks_of_side{};  ///< mean x of each side's normal
  std::array<double, 2> width{};          ///< m, mean
};

LineShape shape_of_line(const Reference& r, const FeatureLine& line) {
  LineShape shape;
  const std::size_t n_segments = line.halfedges.size();
  for (std::size_t k = 0; k < k_row_looks; ++k) {
    const double s = line.length() * (static_cast<double>(k) + 0.5) / static_cast<double>(k_row_looks);
    const auto after = std::upper_bound(line.lengths.begin() + 1, line.lengths.end() - 1, s);
    const std::size_t segment = std::min(static_cast<std::size_t>(after - line.lengths.begin()) - 1, n_segments - 1);
    const LineLook look =
        look_at_line(r, line, segment, line.length() + 1e3 * distance(r.mesh->points[line.vertices.front()], r.mesh->points[line.vertices[1]]));
    ++shape.n;
    if (look.turn > k_sharp_line) ++shape.n_sharp;
    if (look.turn < k_base_to && look.is_convex) ++shape.n_convex;
    if (look.turn > k_base_from && look.turn < k_base_to && look.is_convex) ++shape.n_corner;
    shape.looks += look.looks.x;
    for (std::size_t i = 0; i < 2; ++i) {
      shape.looks_of_side[i] += look.normal[i].x;
      shape.width[i] += look.width[i];
    }
  }
  const auto n = static_cast<double>(shape.n);
  shape.looks /= n;
  for (std::size_t i = 0; i < 2; ++i) {
    shape.looks_of_side[i] /= n;
    shape.width[i] /= n;
  }
  return shape;
}

/// The narrow side, where a line is the side of a base that looks aft.
std::optional<std::size_t> base_side(const LineShape& shape, double length) {
  for (std::size_t i = 0; i < 2; ++i)
    if (shape.looks_of_side[i] > k_looks_aft && shape.width[i] < k_base_width * shape.width[1 - i] && length > k_base_length * shape.width[i]) return i;
  return std::nullopt;
}

/// m, of the bend over `reach` to each side; the mean of all places.
double radius_across(const Reference& r, const FeatureLine& line, double reach) {
  double sum = 0.0;
  int n = 0;
  for (std::size_t k = 0; k < k_row_looks; ++k) {
    const double s = line.length() * (static_cast<double>(k) + 0.5) / static_cast<double>(k_row_looks);
    const auto after = std::upper_bound(line.lengths.begin() + 1, line.lengths.end() - 1, s);
    const HalfedgeId h = line.halfedges[std::min(static_cast<std::size_t>(after - line.lengths.begin()) - 1, line.halfedges.size() - 1)];
    std::array<Vec3, 2> normals;
    std::size_t i = 0;
    for (const HalfedgeId e : {h, r.topology.twin(h)}) {
      const Point &a = r.mesh->points[r.topology.from(e)], &b = r.mesh->points[r.topology.to(e)];
      const Vec3 n = normalized(r.normals[e] + r.normals[next(e)]);
      normals[i++] = r.normal(r.nearest(0.5 * (a + b) + reach * normalized(cross(n, b - a)), triangle_of(e)));
    }
    sum += angle_between(normals[0], normals[1]);
    ++n;
  }
  return sum > 0.0 ? 2.0 * reach * n / sum : std::numeric_limits<double>::infinity();
}

/// Whether the surface looks forward along the line.
bool is_ahead(const Reference& r, const FeatureLine& line) {
  std::size_t n = 0;
  for (const HalfedgeId h : line.halfedges) n += r.normals[h].x < -k_looks_aft ? 1 : 0;
  return static_cast<double>(n) >= k_row_agreeing * static_cast<double>(line.halfedges.size());
}

}  // namespace

std::vector<SizeSite> sites_of_rows(const Reference& reference, const RowLines& rows) {
  std::vector<SizeSite> sites;
  for (const LineRows& l : rows.lines) {
    const double length = reference.lines[static_cast<std::size_t>(l.line)].length();
    const auto size_at = [&](double s) {
      if (!l.is_nose) return l.longest;
      double size = l.longest;
      if (!l.is_going_on[0]) size = std::min(size, l.at_ends + k_change_at_ends * s);
      if (!l.is_going_on[1]) size = std::min(size, l.at_ends + k_change_at_ends * (length - s));
      return size;
    };
    for (double s = 0.0; s < length; s += size_at(s)) sites.push_back({reference.line_point(l.line, s), size_at(s)});
    sites.push_back({reference.line_point(l.line, length), size_at(length)});
  }
  return sites;
}

double width_across(const Reference& r, HalfedgeId h, double most) {
  const auto& points = r.mesh->points;
  Point p = 0.5 * (points[r.topology.from(h)] + points[r.topology.to(h)]);
  const auto inward_of = [&](HalfedgeId e) {
    return normalized(cross(r.triangle_normals[triangle_of(e)], points[r.topology.to(e)] - points[r.topology.from(e)]));
  };
  Vec3 way = inward_of(h);
  double length = 0.0;
  for (int i = 0; i < k_most_passed && length < most; ++i) {
    // Leaves the triangle over the edge that the way meets first.
    HalfedgeId out;
    double least = std::numeric_limits<double>::infinity();
    for (const HalfedgeId e : {next(h), previous(h)}) {
      const Vec3 inward = inward_of(e);
      const double speed = -dot(way, inward);
      if (!(speed > 0.0)) continue;
      const double t = std::max(0.0, dot(p - points[r.topology.from(e)], inward)) / speed;
      if (t < least) {
        least = t;
        out = e;
      }
    }
    if (!out.is_valid()) return length;
    p = p + least * way;
    length += least;
    const HalfedgeId o = r.topology.twin(out);
    if (!o.is_valid() || r.line[out] != k_no_line) return length;
    const Vec3 along = normalized(points[r.topology.to(o)] - points[r.topology.from(o)]);
    const double share = std::clamp(dot(way, along), -1.0, 1.0);
    way = normalized(share * along + std::sqrt(1.0 - share * share) * inward_of(o));
    h = o;
  }
  return std::min(length, most);
}

RowLines find_row_lines(const Reference& r, const SurfaceLimitTable& limits_of, const RemeshOptions& options, std::span<const PatchSurfaceOptions> patches) {
  RowLines found;
  std::vector<BandWishes> wishes;
  bool is_leading_asked = false, is_trailing_asked = false;
  for (const Patch& patch : r.mesh->patches) {
    wishes.push_back(band_wishes(patch.name, options, patches));
    is_leading_asked = is_leading_asked || wishes.back().leading.is_any();
    is_trailing_asked = is_trailing_asked || wishes.back().trailing.is_any();
  }
  if (!is_leading_asked && !is_trailing_asked) return found;
  bool is_leading_found = false, is_trailing_found = false;
  for (std::size_t l = 0; l < r.lines.size(); ++l) {
    const FeatureLine& line = r.lines[l];
    bool is_free = true;
    for (const HalfedgeId h : line.halfedges) {
      const HalfedgeId o = r.topology.twin(h);
      is_free = is_free && o.is_valid() && r.is_kept[triangle_of(h)] == 0 && r.is_kept[triangle_of(o)] == 0;
    }
    if (!is_free) continue;
    const LineShape shape = shape_of_line(r, line);
    const double agreeing = k_row_agreeing * static_cast<double>(shape.n);
    std::optional<LineKind> kind;
    std::optional<std::size_t> base;
    double nose_radius = 0.0;
    const double width = std::min(shape.width[0], shape.width[1]);
    if (static_cast<double>(shape.n_sharp) >= agreeing && std::abs(shape.looks) > k_looks_aft) {
      kind = shape.looks > 0.0 ? LineKind::trailing : LineKind::leading;
    } else if ((line.is_nose ? is_ahead(r, line) : static_cast<double>(shape.n_convex) >= agreeing && shape.looks < -k_looks_aft) &&
               line.length() > k_nose_length * width && std::max(shape.width[0], shape.width[1]) < k_alike_width * width) {
      nose_radius = radius_across(r, line, k_nose_probe * width);
      if (nose_radius <= k_widest_nose * width) kind = LineKind::leading;
    } else if (static_cast<double>(shape.n_corner) >= agreeing && (base = base_side(shape, line.length()))) {
      kind = LineKind::trailing;
    }
    if (!kind) continue;
    LineRows rows{.line = static_cast<std::int32_t>(l), .sides = {}, .longest = std::numeric_limits<double>::infinity()};
    HalfedgeId left = line.halfedges.front();
    if (r.topology.from(left) != line.vertices.front()) left = r.topology.twin(left);
    const std::array<TriangleId, 2> beside{triangle_of(left), triangle_of(r.topology.twin(left))};
    for (std::size_t i = 0; i < 2; ++i) {
      if (base && *base == i) continue;
      const BandWishes& wish = wishes[r.mesh->triangle_patch[beside[i]].index()];
      const BandWish& band = *kind == LineKind::leading ? wish.leading : wish.trailing;
      if (!band.is_any()) continue;
      const SurfaceLimits& limits = limits_of.of(beside[i]);
      rows.sides[i] = {true, std::min(limits.max_edge, band.first_height(limits.max_edge)), band.growth, limits.curvature_angle, limits.min_edge};
      rows.longest = std::min(rows.longest, band.longest(limits.max_edge));
      // All rows of one side fit into their share of its width.
      const double room = k_rows_of_width * shape.width[i];
      rows.longest =
          std::min(rows.longest, std::max(rows.sides[i].first, (room * (band.growth - 1.0) + rows.sides[i].first) / (k_last_row_height * band.growth)));
    }
    if (!rows.sides[0].is_any && !rows.sides[1].is_any) continue;
    if (nose_radius > 0.0) {
      rows.is_nose = true;
      rows.at_ends = rows.longest;
      for (const SideRows& side : rows.sides)
        if (side.is_any) rows.at_ends = std::min(rows.at_ends, std::max(side.curvature_angle * nose_radius, side.min_edge));
    }
    (*kind == LineKind::leading ? is_leading_found : is_trailing_found) = true;
    found.lines.push_back(rows);
  }
  // Rows go on where another line with rows begins.
  std::vector<std::uint32_t> n_at(r.mesh->n_vertices(), 0);
  for (const LineRows& rows : found.lines)
    for (const VertexId v : {r.lines[static_cast<std::size_t>(rows.line)].vertices.front(), r.lines[static_cast<std::size_t>(rows.line)].vertices.back()})
      ++n_at[v.index()];
  for (LineRows& rows : found.lines) {
    const FeatureLine& line = r.lines[static_cast<std::size_t>(rows.line)];
    rows.is_going_on = {n_at[line.vertices.front().index()] == 2, n_at[line.vertices.back().index()] == 2};
  }
  if (is_trailing_asked && !is_trailing_found)
    found.notes.push_back(
        "trailing edges: no line of the surface is one (a sharp edge, or a side of a narrow base, that looks aft along x), so there are no rows");
  if (is_leading_asked && !is_leading_found)
    found.notes.push_back(
        "leading edges: no nose was found (a smooth one, curved much more than what follows, or a sharp edge, that looks forward along x), so there are no "
        "rows");
  return found;
}

}  // namespace sterna::surfmesh
