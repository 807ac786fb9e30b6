// UGRID (AFLR3) volume meshes, docs/method/formats_solvers.md, "UGRID".
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

/// Permutation for pyramids: ugrid_node[i] = cgns_node[order[i]]. The quad is 0 1 4 3, the apex 2. The permutation is its own inverse.
inline constexpr std::array<std::uint8_t, 8> k_ugrid_pyramid = {0, 3, 4, 1, 2};

/// Reads text (.ugrid) and binary files (b8, lb8, b8l, lb8l, b4, lb4). Names and kinds of patches come from the .mapbc file beside the mesh, else "patch_<id>",
/// in order of appearance. Boundary faces, which many programs write inwards, are turned outwards; cells with the wrong winding are flipped; both are counted
/// in the log. Data after the cells (AFLR's records about layers and spacing) are not read.
/// \throws Error file_malformed (line or byte offset), unsupported_format (files with Fortran records), file_not_found.
HybridMesh read_volume_ugrid(const std::filesystem::path& path, const RunContext& context);

/// Writes the variant given by the name, and FUN3D's .mapbc beside it (wing.mapbc for wing.lb8.ugrid). Boundary faces point inwards, patches are numbered from
/// 1 as in the mesh. The file is streamed, which takes less than 100 MB of memory in addition to the mesh. Text has the shortest decimals that read back to the
/// same double; b4 and lb4 round to single precision.
/// \throws Error overflow (a count beyond 2^31-1 with 32-bit integers), mesh_invalid, write_failed, cancelled, unsupported_format.
void write_volume_ugrid(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// Returns why QUALITY gates measured on the mesh do not hold for a file of this name (rounding_text); empty if they do, as for all files of double precision.
std::string ugrid_rounding(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// Returns the path of the .mapbc file that the reader uses for a mesh; empty if there is none.
std::filesystem::path ugrid_kinds_path(const std::filesystem::path& path);

}  // namespace sterna::io
