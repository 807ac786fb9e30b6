// VTU files of volume meshes, docs/method/formats.md, "VTU and VTP".
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

/// Writes binary appended data that VTK, ParaView and meshio read: x.vtu packed by zlib, x.lz4.vtu by LZ4 (not for meshio), x.raw.vtu not packed. The cells are
/// prisms, pyramids, hexahedra and tetrahedra (VTK winding), followed by the boundary triangles and quads. The cell data "marker" is the number of the patch
/// from 1, and 0 for volume cells. The cell data "layer" is 1 for a cell at the wall and increases outwards; it is 0 for cells and faces outside the layers.
/// The field data contain the marker of each patch, named "patch:<kind>:<name>". Ids are Int32 if they fit, else Int64. Takes less than 100 MB of memory in
/// addition to the mesh.
/// \throws Error mesh_invalid (a face without patch), write_failed, cancelled.
void write_volume_vtu(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// Writes additional float64 data of each volume cell (cell_quality.h): "scaled_jacobian", "volume", "min_dihedral" and "max_dihedral" in degrees; NaN for
/// boundary faces, and for angles of cells other than tetrahedra. Needs 32 bytes per cell.
/// \throws Error as write_volume_vtu
void write_quality_vtu(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// Reads VTU files of one or more pieces: ascii, base64 and raw appended arrays, plain, zlib or LZ4, 32- and 64-bit headers, little endian. Volume cells are
/// stored in the explicit arrays, triangles and quads become boundary faces. The patch of a face is its value in the first integer cell array of marker,
/// boundary, CellEntityIds, gmsh:physical, ids; without such an array there is one patch. Names and kinds follow from the field data that write_volume_vtu
/// writes, else "patch_<number>". Cells with the wrong winding are flipped, boundary faces turned outwards, points and lines dropped; all three are counted in
/// the log.
/// \throws Error file_malformed, unsupported_format (LZMA, big endian, other cells), file_not_found.
HybridMesh read_volume_vtu(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
