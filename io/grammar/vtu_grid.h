// Reader of VTK's XML files as arrays: UnstructuredGrid (.vtu) and PolyData (.vtp), any encoding (docs/method/formats.md, "VTU and VTP").
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "io/grammar/vtk_grid.h"

namespace sterna::io {

/// Decodes the arrays of all pieces.
/// \throws Error file_not_found, file_malformed (byte offset), unsupported_format, cancelled.
VtkGrid read_vtu_grid(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
