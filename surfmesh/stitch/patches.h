// Private to surfmesh/stitch: names and numbers of patches.
#pragma once

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "surfmesh/stitch/working_surface.h"

namespace sterna::surfmesh {

/// Returns unique names for all patches of all soups, in order. Allowed are [A-Za-z0-9_.-] and characters beyond ASCII; each run of other characters becomes
/// one '_'. If a name is taken, a number is added. A name that is missing in the file, or that has no allowed character, becomes "wall", or the file's stem if
/// there are several files. Each changed name is reported by a message.
std::vector<std::string> clean_patch_names(const std::vector<SurfaceSoup>& soups, std::vector<std::string>* messages = nullptr);

/// Converts a name such as "My wing (left)" to "My_wing_left". The result may be empty. The result is UTF-8; bytes that are not valid UTF-8 are read as
/// Latin-1.
std::string clean_name(std::string_view name);

/// Returns the mesh. Vertices are numbered by first use. Patches are in the order of the files; patches without facets are dropped.
/// \pre coordinates in metres
TriMesh make_mesh(const WorkingSurface& surface, const std::vector<std::string>& names);

/// Splits each patch into regions that are separated by edges that bend by more than `angle` (rad). The regions of wing become wing_1, wing_2 and so on, in the
/// order of their first triangles.
void split_patches(TriMesh& mesh, double angle, const RunContext& context);

}  // namespace sterna::surfmesh
