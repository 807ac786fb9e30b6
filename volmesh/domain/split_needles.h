// Needles and caps of the walls that users bring, made into triangles that tetrahedra can stand on: edges are flipped where the wall is flat, long edges are
// bisected.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/needle_options.h"

namespace sterna::volmesh {

/// What was done about the needles of a wall: triangles of walls with layers that have an angle below NeedleOptions::split_needles.
struct NeedleReport {
  std::int64_t n_given = 0;      ///< triangles of walls with layers, as they came; 0 where needles were not looked for
  std::int64_t n_triangles = 0;  ///< the same behind this step
  std::int64_t n_needles = 0;    ///< of n_given
  std::int64_t n_flips = 0;
  std::int64_t n_left = 0;      ///< needles among n_triangles
  bool is_over_budget = false;  ///< some of them would have been split with a larger needle_budget
  Point first_left{};           ///< m, the middle of the first of them
  bool has_changed() const { return n_flips > 0 || n_triangles != n_given; }
  friend bool operator==(const NeedleReport&, const NeedleReport&) = default;
};

/// "wall: 1234 needles, 56 edges flipped: 44736 -> 60000 triangles; 7 needles left"
std::string describe(const NeedleReport& report);

/// Of each corner of a triangle: barycentric weights in the triangle that it is part of. All zero: it is part of more than one.
using CornerWeights = std::array<std::array<double, 3>, 3>;

struct NeedleSplits {
  Column<TriangleId, TriangleId> sources;     ///< of each triangle now: the one whose part it is, or mostly was; empty where nothing has changed
  Column<TriangleId, CornerWeights> weights;  ///< in that one; likewise
  NeedleReport report;
};

/// Flips and splits edges between triangles of walls with layers. An edge inside a patch at which the wall turns by less than flip_angle is flipped where that
/// makes the smallest angle of its two triangles larger and one of them is a needle; the surface moves by less than k_flip_drift flip_angle of the edge, in
/// all. Bisection alone makes no angle larger: it is there for what flips then do with the new vertices. Where a needle can become better by them, one of its
/// two long edges is bisected, a crease before one that can be flipped, unless the triangle beyond has a much longer edge, which is first then (Rivara's path).
/// Mildest needles first, so that a budget that ends makes the most of them good. Not touched: edges of patches without layers, needles between creases that
/// leave no larger angle, and those that would take more than k_needle_reach pieces. New vertices are middles of edges, not moved to a model behind the wall: a
/// run that is continued from a file has to find the same wall. Vertices keep their numbers, new ones follow; triangles stay in the order of those that they
/// come from. Where the surface would cross itself, it stays as it was. \p has_layer: of each patch.
/// \pre boundary closed, manifold
/// \post closed, manifold, the same for any number of threads; without needles unchanged
NeedleSplits split_needles(TriMesh& boundary, const Column<PatchId, std::uint8_t>& has_layer, const NeedleOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
