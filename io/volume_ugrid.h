// UGRID (AFLR3) volume meshes, formats.md section 8.3.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

/// Reads .lb8.ugrid and .b8.ugrid (32-bit integers, 64-bit reals, little and big endian). Patches are "patch_<id>", in order of appearance; a .mapbc file is not read.
/// Boundary faces, which many programs write inwards, are turned outwards; cells in a wrong winding are flipped; both are counted in the log. What follows the cells
/// (AFLR's records about layers and spacing) is not read.
/// \throws Error file_malformed (byte offset), unsupported_format (other kinds of UGRID), file_not_found.
HybridMesh read_volume_ugrid(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
