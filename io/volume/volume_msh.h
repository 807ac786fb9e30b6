// Gmsh MSH files of volume meshes, docs/method/formats_surfaces.md, "Gmsh MSH".
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

/// Reads versions 2.2 and 4.1, text and binary. Patches are the physical groups of faces ("patch_<number>" without a name); kinds follow from the names. Cells
/// with the wrong winding are flipped, boundary faces turned outwards; points and lines are ignored.
/// \throws Error file_malformed (line or byte), unsupported_format (other versions, second order, partitions)
HybridMesh read_volume_msh(const std::filesystem::path& path, const RunContext& context);

/// Writes version 4.1; x.msh as text, x.bin.msh binary (little endian, 64-bit tags). Each patch is a surface with a physical group of its number. The fluid is
/// a volume with group 10 or, with more than nine patches, the number after the last patch.
/// \throws Error overflow (2^31 patches), mesh_invalid, write_failed, cancelled
void write_volume_msh(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
