// Triangulation of actuator discs, and their insertion into the outer boundary.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/actuator_disc.h"

namespace sterna::volmesh {

/// Returns the patch name of the downstream side.
std::string back_name(const ActuatorDisc& disc);

/// Triangulates the disc in rings. Edges follow the size field: they are shorter near walls, and at most `edge` (default: a twelfth of the radius). The result
/// has one patch of kind interface; normals point against the axis. No triangle has all its corners on boundary circles, and no interior edge joins two
/// boundary circles. \p walls determine the sizes; \p growth growth of the size field
/// \throws Error(bad_argument) for numbers that make no disc
TriMesh triangulate_disc(const ActuatorDisc& disc, const TriMesh& walls, double growth, const RunContext& context);

/// \throws Error(bad_argument) for numbers that make no disc
void require_sane(const ActuatorDisc& disc);
/// \throws Error(bad_argument) if a side of a disc has the name of another side or of a patch
void require_own_names(const std::vector<ActuatorDisc>& discs, const Column<PatchId, Patch>& outer, const Column<PatchId, Patch>& walls);

/// Returns the corners of a circle around the disc's centre, in its plane, counter-clockwise about the axis. The edges are those that triangulate_disc() makes
/// on boundary circles.
std::vector<Point> border_polygon(const ActuatorDisc& disc, double radius, const TriMesh& walls, double growth, const RunContext& context);
/// Returns a function for the longest edge in metres at a location of the disc: `edge`, or less near walls. The function is not thread-safe.
std::function<double(const Point&)> disc_sizes(const ActuatorDisc& disc, const TriMesh& walls, double growth, const RunContext& context);

/// Checks that the triangles of a disc, the first `n_own`, meet other triangles only in shared vertices and edges. \p patch_of returns the patch name of each
/// other triangle, counted from 0; \p apart_from text after "meet" in the message, if contact is allowed at some locations
/// \throws Error(self_intersection) with locations
void require_clear(const ActuatorDisc& disc, std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t n_own,
                   const std::function<const std::string&(std::size_t)>& patch_of, const std::string& apart_from, const RunContext& context);

/// Appends the upstream side of each disc to the outer boundary, after its own triangles. Layers keep clear of these triangles. \p walls walls with layers,
/// which determine the sizes
/// \throws the errors of require_own_names(); Error(self_intersection) with locations where a disc meets a wall, the outer boundary or another disc
TriMesh with_discs(TriMesh outer, const TriMesh& walls, const std::vector<ActuatorDisc>& discs, double growth, const RunContext& context);

/// Appends the downstream sides after all existing triangles and vertices. Vertices inside a disc are doubled; vertices on boundary circles stay single.
/// \pre the upstream sides exist and are identified by the names of their patches
TriMesh with_second_sides(TriMesh outer, const std::vector<ActuatorDisc>& discs);

/// Removes triangles that lie back to back with triangles of a smaller number. Their vertices and patches stay. In a mesh made by with_second_sides() these
/// triangles are the last ones.
TriMesh one_sided(TriMesh outer);

}  // namespace sterna::volmesh
