// Converts sliver triangles (needles and caps) of user-supplied walls into triangles on which tetrahedra of good quality can stand. Edges are flipped where the
// wall is flat, and long edges are bisected.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/sliver_options.h"

namespace sterna::volmesh {

/// Results for the sliver triangles of a wall, that is, for triangles of walls with layers that have an angle below SliverOptions::split_needles.
struct SliverReport {
  std::int64_t n_given = 0;      ///< number of triangles of walls with layers in the input; 0 if slivers were not searched
  std::int64_t n_triangles = 0;  ///< number of triangles of walls with layers after this step
  std::int64_t n_slivers = 0;    ///< number of slivers among n_given
  std::int64_t n_flips = 0;
  std::int64_t n_left = 0;      ///< number of slivers among n_triangles
  bool is_over_budget = false;  ///< some of the remaining slivers would have been split with a larger needle_budget
  Point first_left{};           ///< m, centre of the first remaining sliver
  bool has_changed() const { return n_flips > 0 || n_triangles != n_given; }
  friend bool operator==(const SliverReport&, const SliverReport&) = default;
};

/// Returns a line such as "wall: 1234 needles, 56 edges flipped: 44736 -> 60000 triangles; 7 needles left".
std::string describe(const SliverReport& report);

/// Barycentric weights in the source triangle for each corner of a triangle. If all are zero, the triangle is part of several source triangles.
using CornerWeights = std::array<std::array<double, 3>, 3>;

struct SliverSplits {
  Column<TriangleId, TriangleId> sources;     ///< source triangle of each new triangle, or the triangle that covers most of it; empty if nothing has changed
  Column<TriangleId, CornerWeights> weights;  ///< weights in the source triangle; empty if nothing has changed
  SliverReport report;
};

/// Flips and splits edges between triangles of walls with layers.
///
/// An edge inside a patch at which the wall turns by less than flip_angle is flipped if one of its two triangles is a sliver and the flip increases their
/// smallest angle. In total, the surface moves by less than k_flip_drift flip_angle of the edge. Bisection alone increases no angle; its purpose is the flips
/// that the new vertices allow. One of the two long edges of a sliver is bisected if such flips can then improve the sliver. A crease (an edge that must not be
/// flipped) is preferred to an edge that can be flipped. If the triangle beyond has a much longer edge, that edge is bisected first (Rivara's path). The
/// mildest slivers come first, so that a limited budget repairs as many as possible.
///
/// The following are unchanged: edges of patches without layers, slivers between creases that leave no larger angle, and slivers that would need more than
/// k_sliver_reach pieces. New vertices are the midpoints of edges. They are not moved to the CAD model of the wall, because a run that is continued from a file
/// has to find the same wall. Vertices keep their numbers, and new ones follow. Triangles stay in the order of their source triangles. If the surface would
/// intersect itself, it stays unchanged. \p has_layer flag of each patch.
/// \pre the boundary is closed and manifold
/// \post the boundary is closed and manifold, and the same for any number of threads; without slivers it is unchanged
SliverSplits split_slivers(TriMesh& boundary, const Column<PatchId, std::uint8_t>& has_layer, const SliverOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
