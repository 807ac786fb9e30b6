// Private to surfmesh/stitch: names and numbers of the patches.
#pragma once

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "surfmesh/stitch/working_surface.h"

namespace sterna::surfmesh {

/// Names for all patches of all soups, in order: [A-Za-z0-9_.-] and characters beyond ASCII (runs of others become one '_'), unique (a number is added). A name
/// that the file does not give, or that has no allowed character, becomes "wall", with several files the file's stem. Each changed name is a message.
std::vector<std::string> clean_patch_names(const std::vector<SurfaceSoup>& soups, std::vector<std::string>* messages = nullptr);

/// "My wing (left)" -> "My_wing_left"; may be empty. The result is UTF-8; bytes that are not are taken for Latin-1.
std::string clean_name(std::string_view name);

/// The mesh: vertices numbered by first use, patches in the order of the files, unused ones dropped.
/// \pre coordinates in metres.
TriMesh make_mesh(const WorkingSurface& surface, const std::vector<std::string>& names);

/// Splits each patch into the regions that edges which bend by more than `angle` (rad) cut off; the regions of wing become wing_1, wing_2 ..., by first
/// triangle.
void split_patches(TriMesh& mesh, double angle, const RunContext& context);

}  // namespace sterna::surfmesh
