// Actuator discs as triangles, and in the outer boundary.
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

/// Name of the downstream side's patch.
std::string back_name(const ActuatorDisc& disc);

/// Triangles of the disc in rings, shorter towards walls near by: edges as the size field has them there, `edge` at most (default: a twelfth of the radius).
/// One patch of kind interface; normals against the axis. No triangle has all its corners on the rims, no edge inside joins two rims. \p walls: for sizes; \p
/// growth: of the size field
/// \throws Error(bad_argument) for numbers that make no disc
TriMesh triangulate_disc(const ActuatorDisc& disc, const TriMesh& walls, double growth, const RunContext& context);

/// \throws Error(bad_argument) for numbers that make no disc
void require_sane(const ActuatorDisc& disc);
/// \throws Error(bad_argument) when a disc's side has the name of another one or of a patch
void require_own_names(const std::vector<ActuatorDisc>& discs, const Column<PatchId, Patch>& outer, const Column<PatchId, Patch>& walls);

/// Corners of a circle around the disc's centre, in its plane, counter-clockwise about the axis; edges as triangulate_disc() has them on its rims.
std::vector<Point> rim_polygon(const ActuatorDisc& disc, double radius, const TriMesh& walls, double growth, const RunContext& context);
/// The longest edge at a place of the disc, m: `edge`, or less near walls. One thread at a time.
std::function<double(const Point&)> disc_sizes(const ActuatorDisc& disc, const TriMesh& walls, double growth, const RunContext& context);

/// Triangles of a disc, the first `n_own`, and others meet in nothing but what their shared vertices require.
/// \p patch_of: name of the patch of each of the others, counted from 0; \p apart_from: what follows "meet" where meeting is right in places
/// \throws Error(self_intersection) with places
void require_clear(const ActuatorDisc& disc, std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t n_own,
                   const std::function<const std::string&(std::size_t)>& patch_of, const std::string& apart_from, const RunContext& context);

/// The outer boundary with one side of each disc, the upstream one, behind its own triangles: what layers keep clear of.
/// \p walls: those with layers, for sizes
/// \throws as require_own_names(); Error(self_intersection) with places where a disc meets a wall, the outer boundary or another disc
TriMesh with_discs(TriMesh outer, const TriMesh& walls, const std::vector<ActuatorDisc>& discs, double growth, const RunContext& context);

/// The downstream sides too, behind all triangles and vertices that are there: vertices inside of a disc are two then, those on its rims stay one.
/// \pre the upstream sides are there, by the names of their patches
TriMesh with_second_sides(TriMesh outer, const std::vector<ActuatorDisc>& discs);

/// Without the triangles that lie back to back on others of a smaller number; their vertices and patches stay. Of a mesh of with_second_sides() they are the
/// last.
TriMesh one_sided(TriMesh outer);
/// Whether triangles of patches of kind interface lie back to back.
bool has_sheets(const TriMesh& outer);

}  // namespace sterna::volmesh
