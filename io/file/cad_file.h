// CAD files by path; what is in them is geom/cad's work.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/cad/read_cad.h"
#include "geom/cad/write_cad.h"

namespace sterna::io {

/// Whether the name is that of a CAD file: .step .stp .iges .igs .brep .egads, each also with .gz.
bool is_cad_file(const std::filesystem::path& path);

/// Reads a STEP, IGES or BREP file, gzipped or not; the format follows from the contents, else from the name.
/// \throws Error file_not_found, file_malformed, unsupported_format, and what cad::read_cad_bytes throws.
CadFile read_cad(const std::filesystem::path& path, const ReadCadOptions& options, const RunContext& context);

/// Writes a model; the format follows from the name. An existing file stays as it was on failure.
/// \throws Error unsupported_format (a name of none of the three, .gz), write_failed, and what cad::cad_bytes throws.
void write_cad(const Model& model, const std::filesystem::path& path, const WriteCadOptions& options, const RunContext& context);

}  // namespace sterna::io
