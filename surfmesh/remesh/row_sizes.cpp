#include "surfmesh/remesh/row_sizes.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "surfmesh/face/band_rows.h"

namespace sterna::surfmesh {
namespace {

/// Change per distance of the edge length along the line, at the ends of a nose's rows.
constexpr double k_change_at_ends = 0.3;
/// Offset that keeps sizes positive, relative to the largest height of rows.
constexpr double k_reach_offset = 1e-3;

}  // namespace

std::vector<SizePoint> size_points_of_rows(const Reference& reference, const RowLines& rows) {
  std::vector<SizePoint> size_points;
  for (const LineRows& l : rows.lines) {
    const double length = reference.lines[static_cast<std::size_t>(l.line)].length();
    const auto size_at = [&](double s) {
      if (!l.is_nose) return l.longest;
      double size = l.longest;
      if (!l.is_going_on[0]) size = std::min(size, l.at_ends + k_change_at_ends * s);
      if (!l.is_going_on[1]) size = std::min(size, l.at_ends + k_change_at_ends * (length - s));
      return size;
    };
    for (double s = 0.0; s < length; s += size_at(s)) size_points.push_back({reference.line_point(l.line, s), size_at(s)});
    size_points.push_back({reference.line_point(l.line, length), size_at(length)});
  }
  return size_points;
}

std::vector<RowReach> foreseen_reaches(const Reference& reference, const RowLines& rows) {
  std::vector<RowReach> reaches;
  RowLines noses;
  for (const LineRows& l : rows.lines) {
    if (!l.is_nose) continue;
    double height = 0.0;
    for (const SideRows& side : l.sides)
      if (side.is_any) height = std::max(height, (k_isotropic_height * l.longest * side.growth - side.first) / (side.growth - 1.0));
    noses.lines = {l};
    for (const SizePoint& size_point : size_points_of_rows(reference, noses)) reaches.push_back({size_point.point, height * size_point.size / l.longest});
  }
  return reaches;
}

Column<VertexId, std::uint8_t> covered_by_noses(const Reference& reference, std::span<const RowReach> reaches, const RunContext& context) {
  Column<VertexId, std::uint8_t> covered;
  if (reaches.empty()) return covered;
  covered.assign(reference.mesh->n_vertices(), 0);
  double largest = 0.0;
  for (const RowReach& reach : reaches) largest = std::max(largest, reach.height);
  // Each size starts from the largest height minus the height here, and grows by 1 with the distance. Within the height of the rows the size is therefore at
  // most the largest height.
  std::vector<SizePoint> size_points;
  for (const RowReach& reach : reaches)
    if (reach.height > 0.0) size_points.push_back({reach.point, (largest - reach.height) + k_reach_offset * largest});
  if (size_points.empty()) return covered;
  const SizePointTree tree(size_points, 1.0, context);
  parallel_for(context, covered.size(), [&](std::size_t v) {
    covered[VertexId(v)] = tree.smallest(reference.mesh->points[VertexId(v)], {.cap = 2.0 * largest}) <= (1.0 + k_reach_offset) * largest ? 1 : 0;
  });
  return covered;
}

}  // namespace sterna::surfmesh
