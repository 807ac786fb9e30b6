// Sizes that rows at leading and trailing edges ask for: lengths along their lines, and where the curvature of noses asks for nothing because rows answer for
// it.
#pragma once

#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/size_sites.h"
#include "surfmesh/remesh/line_rows.h"

namespace sterna::surfmesh {

/// Lengths that edges along lines with rows are to have, at places no further apart than that; smaller towards the ends of noses, where rows end.
std::vector<SizeSite> sites_of_rows(const Reference& reference, const RowLines& rows);

/// How far rows climb from a place of a line.
struct RowReach {
  Point point;
  double height = 0.0;  ///< m
};

/// Of the places of noses, as high as the law of their rows makes them.
std::vector<RowReach> foreseen_reaches(const Reference& reference, const RowLines& rows);

/// Vertices of the reference nearer to places of noses than rows climb there. Empty without such places.
Column<VertexId, std::uint8_t> covered_by_noses(const Reference& reference, std::span<const RowReach> reaches, const RunContext& context);

}  // namespace sterna::surfmesh
