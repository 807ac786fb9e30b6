// Private to geom/boolean: better triangles along the curves in which parts cross. The rest of the surface stays as it is.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/boolean/strip_mesh.h"
#include "geom/boolean/union_meshes.h"

namespace sterna {

/// What the remesher asks of the input around a vertex.
struct LocalLength {
  double shortest = 0.0;  ///< m; edges below a share of it are collapsed
  double longest = 0.0;   ///< m; edges above a multiple of it are split
};

struct StripInput {
  std::vector<Vec3> points;
  std::vector<StripTriangle> triangles;
  std::vector<std::uint32_t> solid;  ///< per triangle: where two differ, there is the curve
  std::vector<LocalLength> length;   ///< per vertex: of the input triangles that its triangles are pieces of
};

struct StripOutput {
  std::vector<Vec3> points;
  std::vector<StripTriangle> triangles;
  std::vector<char> is_in_strip;  ///< per triangle
};

/// Rounds of splitting, collapsing, flipping and smoothing within options.strip_width local edge lengths of the curve; lengths grow from those of the curve to
/// those of the input. Kept edges (borders of regions, ridges) stay polylines of their own vertices and midpoints. Never adds a crossing; farther than
/// options.deviation local edge lengths from the input no triangle comes. Serial; ends after a fixed number of rounds. Fills the figures of the strip in
/// `report`.
/// \pre closed, manifold
StripOutput remesh_strip(StripInput input, const UnionOptions& options, UnionReport& report, const RunContext& context);

}  // namespace sterna
