// FOI Edge meshes, docs/method/formats_solvers.md, "Edge": .bmsh (binary, version 1 and 2), .amsh (text, read), with boundary conditions in .aboc or .bboc.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

/// Reads both binary versions (also little-endian ones) and text, with or without the node "region". Patch names come from the mesh, kinds from the .aboc or
/// .bboc file of the same name beside it, else from the patch names.
/// \throws Error file_malformed (byte offset or line), unsupported_format, file_not_found
HybridMesh read_volume_edge(const std::filesystem::path& path, const RunContext& context);

/// Writes x.bmsh in version 1, x.v2.bmsh in version 2 (64-bit sizes), and the conditions as text beside it (x.aboc). Boundary faces point into the fluid, as in
/// the mesh generator from which Edge users migrate. In version 1 an element group has at most 2 GiB; larger groups are split.
/// \throws Error overflow (version 1: coordinates of more than 89 million nodes; 2^31 nodes), mesh_invalid, write_failed, cancelled
void write_volume_edge(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
