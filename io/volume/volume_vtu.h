// VTU of volume meshes, docs/method/formats.md, "VTU and VTP".
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

/// Writes binary appended data that VTK, ParaView and meshio read: x.vtu packed by zlib, x.lz4.vtu by LZ4 (not for meshio), x.raw.vtu not packed. Cells:
/// prisms, pyramids, hexahedra, tetrahedra (VTK winding), then the boundary triangles and quads. Cell data: "marker" = number of the patch from 1, 0 for volume
/// cells; "layer" = 1 for a cell at the wall and so on outwards, 0 for cells and faces of no layer. Field data: one number per patch, named
/// "patch:<kind>:<name>", the marker. Ids are Int32 where they fit, else Int64. Memory below 100 MB beside the mesh.
/// \throws Error mesh_invalid (a face without patch), write_failed, cancelled.
void write_volume_vtu(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// The same with more cell data, float64, of each volume cell (cell_quality.h): "scaled_jacobian", "volume", "min_dihedral" and "max_dihedral" in degrees; NaN
/// for boundary faces, and for angles of cells that are no tetrahedra. Needs 32 bytes a cell.
/// \throws Error as write_volume_vtu
void write_quality_vtu(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// Reads VTU files of one or more pieces: ascii, base64 and raw appended arrays, plain, zlib or LZ4, 32- and 64-bit headers, little endian. Volume cells land
/// in the explicit arrays, triangles and quads become boundary faces; their patch is the first integer cell array of marker, boundary, CellEntityIds,
/// gmsh:physical, ids (none: one patch). Names and kinds follow from the field data that write_volume_vtu writes, else "patch_<number>". Cells in a wrong
/// winding are flipped, boundary faces turned outwards, points and lines dropped; all three are counted in the log.
/// \throws Error file_malformed, unsupported_format (LZMA, big endian, other cells), file_not_found.
HybridMesh read_volume_vtu(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
