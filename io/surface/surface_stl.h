// ASCII and binary STL; the solids of an ASCII file are patches.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the surface in an STL file, plain or gzipped; coordinates as in the file.
/// \throws Error file_not_found, file_malformed (place, what was found, what was expected), unsupported_format, cancelled.
SurfaceSoup read_stl(const std::filesystem::path& path, const RunContext& context);

/// Several patches become a text file of one solid each, by name, every digit kept; one patch becomes a binary file (single precision).
/// \throws Error write_failed, overflow (float range, 32-bit counts), cancelled.
void write_stl(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);
/// One solid, names lost (told in the log).
void write_stl_binary(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);
void write_stl_text(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
