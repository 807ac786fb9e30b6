// Reader of legacy VTK files as arrays: versions 1.0 to 5.1, text and binary (docs/method/formats.md, "Legacy VTK").
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "io/grammar/vtk_grid.h"

namespace sterna::io {

/// Reads UNSTRUCTURED_GRID and POLYDATA.
/// \throws Error file_not_found, file_malformed (line, or byte offset in binary blocks), unsupported_format (other data sets), cancelled.
VtkGrid read_vtk_grid(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
