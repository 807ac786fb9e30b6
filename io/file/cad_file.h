// CAD files by path; their contents are handled in geom/cad.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/cad/read_cad.h"
#include "geom/cad/write_cad.h"

namespace sterna::io {

/// Returns true if the extension is that of a CAD file: .step .stp .iges .igs .brep .egads, each also with .gz.
bool is_cad_file(const std::filesystem::path& path);

/// Reads a STEP, IGES or BREP file, optionally gzipped. The format is detected from the contents, else from the name.
/// \throws Error file_not_found, file_malformed, unsupported_format, and errors of cad::read_cad_bytes.
CadFile read_cad(const std::filesystem::path& path, const ReadCadOptions& options, const RunContext& context);

/// Writes a model; the format follows from the name. On failure an existing file is unchanged.
/// \throws Error unsupported_format (other extensions, .gz), write_failed, and errors of cad::cad_bytes.
void write_cad(const Model& model, const std::filesystem::path& path, const WriteCadOptions& options, const RunContext& context);

}  // namespace sterna::io
