// Sizes required by rows at leading and trailing edges: edge lengths along their lines, and regions of noses where curvature is ignored because rows determine
// the size.
#pragma once

#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/size_points.h"
#include "surfmesh/remesh/line_rows.h"

namespace sterna::surfmesh {

/// Returns target edge lengths along lines with rows, at locations no farther apart than that length. They are smaller towards the ends of noses, where rows
/// end.
std::vector<SizePoint> size_points_of_rows(const Reference& reference, const RowLines& rows);

/// Height of the rows above a location of a line.
struct RowReach {
  Point point;
  double height = 0.0;  ///< m
};

/// Returns the height of the rows at the locations of noses, as predicted from their first height and growth.
std::vector<RowReach> foreseen_reaches(const Reference& reference, const RowLines& rows);

/// Returns the vertices of the reference that are nearer to a location of a nose than the rows reach there. Empty if there are no such locations.
Column<VertexId, std::uint8_t> covered_by_noses(const Reference& reference, std::span<const RowReach> reaches, const RunContext& context);

}  // namespace sterna::surfmesh
