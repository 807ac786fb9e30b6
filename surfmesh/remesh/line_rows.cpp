#include "surfmesh/remesh/line_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "surfmesh/face/band_rows.h"
#include "surfmesh/model/band_target.h"
#include "surfmesh/model/wing_edges.h"
#include "surfmesh/remesh/remesh_sizes.h"

namespace sterna::surfmesh {
namespace {

/// The bend of a nose is measured over the first fraction of the adjacent width. A nose line is longer than the second fraction of that width.
constexpr double k_nose_probe = 0.01, k_nose_length = 0.25;
/// Largest ratio of the larger to the smaller of the widths on both sides of a leading edge.
constexpr double k_alike_width = 3.0;
/// Largest number of triangles on one path across the surface.
constexpr int k_most_passed = 100'000;

/// Properties of a line at one location.
struct LineLook {
  double turn = 0.0;  ///< rad
  bool is_convex = false;
  Vec3 looks;                   ///< unit outward direction, halfway between both sides
  std::array<Vec3, 2> normal;   ///< normals of the surface beside it
  std::array<double, 2> width;  ///< m, width of the surface on each side
};

LineLook look_at_line(const Reference& r, const FeatureLine& line, std::size_t segment, double most) {
  LineLook look;
  HalfedgeId left = line.halfedges[segment];
  if (r.topology.from(left) != line.vertices[segment]) left = r.topology.twin(left);
  const std::array<HalfedgeId, 2> sides{left, r.topology.twin(left)};
  std::array<Vec3, 2> inwards;
  for (std::size_t k = 0; k < 2; ++k) {
    const HalfedgeId h = sides[k];
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
  /// Numbers of sampled locations with a sharp turn, with a convex turn, and with the turn of a corner of a base.
  std::size_t n_sharp = 0, n_convex = 0, n_corner = 0;
  double looks = 0.0;                     ///< mean x component of the outward direction
  std::array<double, 2> looks_of_side{};  ///< mean x component of each side's normal
  std::array<double, 2> width{};          ///< m, mean width of each side
};

/// Returns the segment of the k-th sampled location on a line.
std::uint32_t segment_of_look(const Reference& r, std::int32_t line, std::size_t k) {
  const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(k_looks);
  return r.line_location(line, share * r.lines[static_cast<std::size_t>(line)].length()).segment;
}

/// \param most m, upper limit of the measured widths
LineShape shape_of_line(const Reference& r, std::int32_t number, double most) {
  LineShape shape;
  for (std::size_t k = 0; k < k_looks; ++k) {
    const LineLook look = look_at_line(r, r.lines[static_cast<std::size_t>(number)], segment_of_look(r, number, k), most);
    if (look.turn > k_sharp_turn) ++shape.n_sharp;
    if (look.turn < k_base_turn_to && look.is_convex) ++shape.n_convex;
    if (look.turn > k_base_turn_from && look.turn < k_base_turn_to && look.is_convex) ++shape.n_corner;
    shape.looks += look.looks.x / k_looks;
    for (std::size_t i = 0; i < 2; ++i) {
      shape.looks_of_side[i] += look.normal[i].x / k_looks;
      shape.width[i] += look.width[i] / k_looks;
    }
  }
  return shape;
}

/// Returns the number of the narrow side if the line is a side of a base that faces aft.
std::optional<std::size_t> base_side(const LineShape& shape, double length) {
  for (std::size_t i = 0; i < 2; ++i)
    if (shape.looks_of_side[i] > k_looks_along && shape.width[i] < k_strip_width * shape.width[1 - i] && length > k_strip_length * shape.width[i]) return i;
  return std::nullopt;
}

/// Returns the radius of the bend across the line in metres, measured over `reach` to each side. The result is the mean over all sampled locations.
double radius_across(const Reference& r, std::int32_t number, double reach) {
  double sum = 0.0;
  for (std::size_t k = 0; k < k_looks; ++k) {
    const HalfedgeId h = r.lines[static_cast<std::size_t>(number)].halfedges[segment_of_look(r, number, k)];
    std::array<Vec3, 2> normals;
    std::size_t i = 0;
    for (const HalfedgeId e : {h, r.topology.twin(h)}) {
      const Point &a = r.mesh->points[r.topology.from(e)], &b = r.mesh->points[r.topology.to(e)];
      const Vec3 n = normalized(r.normals[e] + r.normals[next(e)]);
      normals[i++] = r.normal(r.nearest(0.5 * (a + b) + reach * normalized(cross(n, b - a)), triangle_of(e)));
    }
    sum += angle_between(normals[0], normals[1]);
  }
  return sum > 0.0 ? 2.0 * reach * k_looks / sum : std::numeric_limits<double>::infinity();
}

/// Returns true if the surface faces forward along the line.
bool is_ahead(const Reference& r, const FeatureLine& line) {
  std::size_t n = 0;
  for (const HalfedgeId h : line.halfedges) n += r.normals[h].x < -k_looks_along ? 1 : 0;
  return n * k_looks >= k_agreeing * line.halfedges.size();
}

}  // namespace

double width_across(const Reference& r, HalfedgeId h, double most) {
  const auto& points = r.mesh->points;
  Point p = 0.5 * (points[r.topology.from(h)] + points[r.topology.to(h)]);
  const auto inward_of = [&](HalfedgeId e) {
    return normalized(cross(r.triangle_normals[triangle_of(e)], points[r.topology.to(e)] - points[r.topology.from(e)]));
  };
  Vec3 way = inward_of(h);
  double length = 0.0;
  for (int i = 0; i < k_most_passed && length < most; ++i) {
    // The path leaves the triangle across the edge that it meets first.
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

namespace {

/// Returns true if the line lies between two triangles that are both re-meshed, all along.
bool is_free(const Reference& r, const FeatureLine& line) {
  return std::ranges::all_of(line.halfedges, [&](HalfedgeId h) {
    const HalfedgeId o = r.topology.twin(h);
    return o.is_valid() && r.is_kept[triangle_of(h)] == 0 && r.is_kept[triangle_of(o)] == 0;
  });
}

/// A line that is an edge of a wing.
struct WingLine {
  BandKind kind;
  std::optional<std::size_t> base;  ///< side of the line that is a narrow base, which gets no rows
  double nose_radius = 0.0;         ///< m; 0 if the line is no nose
};

/// Classifies a line as a leading or trailing edge; nothing if it is neither.
std::optional<WingLine> wing_line_of(const Reference& r, std::int32_t number, const LineShape& shape) {
  const FeatureLine& line = r.lines[static_cast<std::size_t>(number)];
  const double width = std::min(shape.width[0], shape.width[1]);
  if (shape.n_sharp >= k_agreeing && std::abs(shape.looks) > k_looks_along) return WingLine{.kind = shape.looks > 0.0 ? BandKind::trailing : BandKind::leading};
  if ((line.is_nose ? is_ahead(r, line) : shape.n_convex >= k_agreeing && shape.looks < -k_looks_along) && line.length() > k_nose_length * width &&
      std::max(shape.width[0], shape.width[1]) < k_alike_width * width) {
    const double radius = radius_across(r, number, k_nose_probe * width);
    if (radius <= k_nose_radius * width) return WingLine{.kind = BandKind::leading, .nose_radius = radius};
    return std::nullopt;
  }
  if (shape.n_corner < k_agreeing) return std::nullopt;
  const std::optional<std::size_t> base = base_side(shape, line.length());
  return base ? std::optional(WingLine{.kind = BandKind::trailing, .base = base}) : std::nullopt;
}

/// Returns the rows on both sides of a line. \p requests rows requested on each patch
LineRows rows_of(const Reference& r, std::int32_t number, const LineShape& shape, const WingLine& wing_line, const SurfaceLimitTable& limits_of,
                 const std::vector<BandTargets>& requests) {
  const FeatureLine& line = r.lines[static_cast<std::size_t>(number)];
  LineRows rows{.line = number, .sides = {}, .longest = std::numeric_limits<double>::infinity()};
  HalfedgeId left = line.halfedges.front();
  if (r.topology.from(left) != line.vertices.front()) left = r.topology.twin(left);
  const std::array<TriangleId, 2> beside{triangle_of(left), triangle_of(r.topology.twin(left))};
  for (std::size_t i = 0; i < 2; ++i) {
    if (wing_line.base == i) continue;
    const BandTargets& target = requests[r.mesh->triangle_patch[beside[i]].index()];
    const BandTarget& band = wing_line.kind == BandKind::leading ? target.leading : target.trailing;
    if (!band.is_any()) continue;
    const SurfaceLimits& limits = limits_of.of(beside[i]);
    rows.sides[i] = {true, std::min(limits.max_edge, band.first_height(limits.max_edge)), band.growth, limits.curvature_angle, limits.min_edge};
    rows.longest = std::min(rows.longest, band.longest(limits.max_edge));
    // All rows of one side must fit into their fraction of its width.
    const double room = k_share_of_chord * shape.width[i];
    rows.longest =
        std::min(rows.longest, std::max(rows.sides[i].first, (room * (band.growth - 1.0) + rows.sides[i].first) / (k_isotropic_height * band.growth)));
  }
  if (wing_line.nose_radius > 0.0) {
    rows.is_nose = true;
    rows.at_ends = rows.longest;
    for (const SideRows& side : rows.sides)
      if (side.is_any) rows.at_ends = std::min(rows.at_ends, std::max(side.curvature_angle * wing_line.nose_radius, side.min_edge));
  }
  return rows;
}

/// Lets rows continue where another line with rows begins at the same vertex.
void let_rows_go_on(const Reference& r, std::vector<LineRows>& lines) {
  std::vector<std::uint32_t> n_at(r.mesh->n_vertices(), 0);
  for (const LineRows& rows : lines)
    for (const VertexId v : {r.lines[static_cast<std::size_t>(rows.line)].vertices.front(), r.lines[static_cast<std::size_t>(rows.line)].vertices.back()})
      ++n_at[v.index()];
  for (LineRows& rows : lines) {
    const FeatureLine& line = r.lines[static_cast<std::size_t>(rows.line)];
    rows.is_going_on = {n_at[line.vertices.front().index()] == 2, n_at[line.vertices.back().index()] == 2};
  }
}

}  // namespace

RowLines find_row_lines(const Reference& r, const SurfaceLimitTable& limits_of, const RemeshOptions& options, std::span<const Rule> patches) {
  RowLines found;
  std::vector<BandTargets> targets;
  for (const Patch& patch : r.mesh->patches) targets.push_back(band_targets(patch.name, resolve(options, patches, patch.name).sizes, patches));
  const bool is_leading_requested = std::ranges::any_of(targets, [](const BandTargets& target) { return target.leading.is_any(); });
  const bool is_trailing_requested = std::ranges::any_of(targets, [](const BandTargets& target) { return target.trailing.is_any(); });
  if (!is_leading_requested && !is_trailing_requested) return found;
  const double length = body_length(*r.mesh);
  bool is_leading_found = false, is_trailing_found = false;
  for (std::size_t l = 0; l < r.lines.size(); ++l) {
    if (!is_free(r, r.lines[l])) continue;
    const auto number = static_cast<std::int32_t>(l);
    const LineShape shape = shape_of_line(r, number, length);
    const std::optional<WingLine> wing_line = wing_line_of(r, number, shape);
    if (!wing_line) continue;
    const LineRows rows = rows_of(r, number, shape, *wing_line, limits_of, targets);
    if (!rows.sides[0].is_any && !rows.sides[1].is_any) continue;
    (wing_line->kind == BandKind::leading ? is_leading_found : is_trailing_found) = true;
    found.lines.push_back(rows);
  }
  let_rows_go_on(r, found.lines);
  if (is_trailing_requested && !is_trailing_found)
    found.notes.push_back("no rows at trailing edges: the surface has no trailing edge (a sharp edge, or a side of a narrow base, that faces aft along x)");
  if (is_leading_requested && !is_leading_found)
    found.notes.push_back(
        "no rows at leading edges: the surface has no leading edge (a sharp edge that faces forward along x, or a smooth nose, curved much more than the "
        "surface "
        "behind it)");
  return found;
}

}  // namespace sterna::surfmesh
