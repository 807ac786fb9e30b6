// Volume meshes from and to files.
#pragma once

#include <filesystem>
#include <string_view>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/numbering.h"

namespace sterna::io {

/// What happens to faces of single cells that the file's boundary lacks, and to points that no cell uses. Both are warnings.
enum class Incomplete {
  kept,       ///< they stay, so that check() finds them
  completed,  ///< the faces become the wall "boundary"; the points go
};

/// Reads a volume mesh; format by extension (".gz" accepted) and contents. Cells land in the explicit arrays; wedges and others in the wrong winding are
/// flipped and counted in the log. Nodes and elements are checked for range. A file without any boundary faces gets the faces of single cells as the wall
/// "boundary", with a warning.
/// \throws Error file_not_found, file_malformed (line or offset, expectation), unsupported_format.
HybridMesh read_volume_file(const std::filesystem::path& path, const RunContext& context, Incomplete incomplete = Incomplete::kept);

/// Writes a volume mesh; format by extension, or named. Writes to a temporary name in the same folder, syncs, renames: an existing file stays as it was on
/// failure. Nodes keep their numbers (renumbered() gives others); so do cells, but formats that number cells of all kinds as one (OpenFOAM, Fluent) take
/// `cells`, as MeshFaces::order_cells has it. \throws Error unsupported_format, write_failed, overflow.
void write_volume_file(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context, std::string_view format_name = {},
                       Numbering cells = Numbering::lines);

}  // namespace sterna::io
