// OpenFOAM polyMesh, formats.md section 8.4.
#pragma once

#include <filesystem>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

/// The polyMesh folder that a name means: the folder itself when it is called polyMesh; of another folder, the case, constant/polyMesh in it; of a file in a
/// case, as the empty case.foam by which ParaView opens it, there or to be made, constant/polyMesh beside it.
std::filesystem::path polymesh_folder(const std::filesystem::path& path);

/// Its five files in the order in which they are read, each with .gz where only the packed one is there.
std::vector<std::filesystem::path> polymesh_files(const std::filesystem::path& path);

/// \throws Error(write_failed) where writing to a new case.foam would replace the mesh that another .foam file in its folder stands for.
void require_foam_output(const std::filesystem::path& path);

/// Reads text and binary files (labels of 32 and 64, scalars of 64 and 32 bits, either byte order), each of them perhaps gzipped. Cells of 4 to 6 faces become
/// tetrahedra, pyramids, prisms, hexahedra. Kinds of patches: wall, symmetry, symmetryPlane by their type; a patch by a group of the name of a kind ("inGroups
/// 1(inflow)"), else farfield.
/// \throws Error file_malformed (line or byte), unsupported_format (polyhedra), file_not_found
HybridMesh read_volume_foam(const std::filesystem::path& path, const RunContext& context);

/// Writes points, faces, owner, neighbour, boundary; x.foam and polyMesh as text, x.bin.foam binary (little endian, labels of 32 bits). Of a new x.foam the
/// empty file for ParaView, too; an existing folder x.foam is a case, as in earlier versions. Cells are numbered column by column, faces are in
/// upper-triangular order. A symmetry patch that lies exactly in a coordinate plane is a symmetryPlane, else symmetry. The old folder stays until the new one
/// is complete.
/// \throws Error overflow (2^31 faces, or nodes of faces in binary), mesh_invalid (faces that do not match), write_failed (also as require_foam_output),
/// cancelled
void write_volume_foam(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
