// VTKHDF files of volume meshes, docs/method/formats.md, "VTKHDF".
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

/// Writes an UnstructuredGrid of version 1.0, which VTK 9.1 and ParaView 5.10 read, with 64-bit ids, in one partition. The cells are prisms, pyramids,
/// hexahedra and tetrahedra (VTK winding), followed by boundary triangles and quads. The cell data "marker" is the number of the patch from 1, and 0 for volume
/// cells. The cell data "layer" is 1 for a cell at the wall and increases outwards; it is 0 for cells and faces outside the layers. The field data contain the
/// marker of each patch, named "patch:<kind>:<name>". '/' in such a name becomes '_', with a warning, and an attribute stores the full name. The file is
/// streamed, which takes less than 100 MB of memory in addition to the mesh.
/// \throws Error mesh_invalid, write_failed, cancelled.
void write_volume_vtkhdf(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// Reads an UnstructuredGrid of any version and number of partitions. The patch of a face is its value in the first integer cell array of marker, boundary,
/// CellEntityIds, gmsh:physical, ids; without such an array there is one patch. Names and kinds come from the field data that write_volume_vtkhdf writes, else
/// "patch_<number>". Cells with the wrong winding are flipped, faces turned outwards, points and lines left out; all are counted in the log.
/// \throws Error file_malformed, unsupported_format (other types, other cells), file_not_found.
HybridMesh read_volume_vtkhdf(const std::filesystem::path& path, const RunContext& context);
/// Reads the boundary faces; coordinates may be nan or infinite.
HybridMesh read_boundary_vtkhdf(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
