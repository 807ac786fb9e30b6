// Private to geom/boolean: remeshes a strip along the intersection curves of the parts. The rest of the surface is unchanged.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/boolean/strip_mesh.h"
#include "geom/boolean/union_meshes.h"

namespace sterna {

/// Edge lengths of the input around a vertex, used as limits by the remesher.
struct LocalLength {
  double shortest = 0.0;  ///< m; edges below a fraction of it are collapsed
  double longest = 0.0;   ///< m; edges above a multiple of it are split
};

struct StripInput {
  Column<VertexId, Vec3> points;
  Column<TriangleId, StripTriangle> triangles;
  Column<TriangleId, std::uint32_t> solid;  ///< per triangle: the intersection curve consists of the edges between different solids
  Column<VertexId, LocalLength> length;     ///< per vertex: lengths of the input triangles of which its triangles are pieces
};

struct StripOutput {
  Column<VertexId, Vec3> points;
  std::vector<StripTriangle> triangles;
  std::vector<char> is_in_strip;  ///< per triangle
};

/// Runs rounds of splitting, collapsing, flipping and smoothing within options.strip_width local edge lengths of the curve. Edge lengths grow from those of the
/// curve to those of the input. Kept edges (borders of regions, ridges) remain polylines of their own vertices and midpoints. Never adds a crossing; no
/// triangle is farther than options.deviation local edge lengths from the input. Serial; ends after a fixed number of rounds. Fills the strip statistics in
/// `report`.
/// \pre closed, manifold
StripOutput remesh_strip(StripInput input, const UnionOptions& options, UnionReport& report, const RunContext& context);

}  // namespace sterna
