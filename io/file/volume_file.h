// Reading and writing of volume mesh files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/numbering.h"

namespace sterna::io {

/// Treatment of cell faces that are missing from the file's boundary, and of points that no cell uses. Both give warnings.
enum class Incomplete {
  kept,       ///< both are kept, so that check() finds them
  completed,  ///< the faces become the wall "boundary"; the points are removed
};

/// Reads a volume mesh; the format follows from the extension (".gz" accepted) and the contents. Cells are stored in the explicit arrays. Cells with the wrong
/// winding are flipped and counted in the log; inverted cells (orientation.h) give a warning. Node and element numbers are range-checked. If a file has no
/// boundary faces, the unmatched faces of cells become the wall "boundary", with a warning.
/// \throws Error file_not_found, file_malformed (line or offset, expectation), unsupported_format.
HybridMesh read_volume_file(const std::filesystem::path& path, const RunContext& context, Incomplete incomplete = Incomplete::kept);

/// Writes a volume mesh; the format follows from the extension, or is named. The file is written under a temporary name in the same folder, synced and renamed:
/// on failure an existing file is unchanged. Nodes keep their numbers (renumbered() changes them), and so do cells, except in formats with one numbering for
/// cells of all kinds (OpenFOAM, Fluent). These apply `cells` as in MeshFaces::order_cells.
/// \throws Error unsupported_format, write_failed, overflow.
void write_volume_file(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context, std::string_view format_name = {},
                       Numbering cells = Numbering::lines);

/// Returns why QUALITY gates measured on the mesh do not hold for this file: the rounding of its coordinates, with value and location. Returns an empty string
/// if they hold. Arguments as for write_volume_file.
std::string rounding_of_volume_file(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context, std::string_view format_name = {});

}  // namespace sterna::io
