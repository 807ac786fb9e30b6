// SU2's native text mesh, docs/method/formats.md, "SU2".
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::io {

/// Writes NDIME, NPOIN, NELEM (prisms, pyramids, hexahedra, tetrahedra; VTK winding) and one marker per patch that has faces. Coordinates are the shortest
/// decimals that read back to the same double. Characters that SU2 does not accept (blanks, commas, brackets) are replaced in patch names, with a warning.
/// A mesh of columns and its explicit_cells() give the same file. The file is streamed, which takes less than 100 MB of memory in addition to the mesh.
/// \throws Error overflow (a count beyond SU2's 2^31-1), mesh_invalid (a coordinate is not finite, a face without patch), write_failed, cancelled.
void write_volume_su2(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// Reads a 3D mesh with all variants of docs/method/formats.md, "SU2 variants": either order of NPOIN and NELEM, blanks around '=', trailing indices, comment
/// and blank lines, CRLF, old SEND_RECEIVE markers (dropped), several zones (joined; markers of the same name become one patch). Cells with the wrong winding
/// are flipped and boundary faces turned outwards; both are counted in the log. A marker's kind follows from its name as in CEASIOMpy: farfield, symmetry, else
/// wall.
/// \throws Error file_malformed (line number and expectation), unsupported_format (a plane mesh), file_not_found.
HybridMesh read_volume_su2(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
