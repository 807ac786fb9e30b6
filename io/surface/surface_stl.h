// ASCII and binary STL; the solids of an ASCII file are patches.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads the surface in an STL file, plain or gzipped; coordinates as in the file.
/// \throws Error file_not_found, file_malformed (location, what was found, what was expected), unsupported_format, cancelled.
SurfaceSoup read_stl(const std::filesystem::path& path, const RunContext& context);

/// Writes a text file with one named solid per patch in full precision if there are several patches, or a binary file (single precision) for one patch.
/// \throws Error write_failed, overflow (float range, 32-bit counts), cancelled.
void write_stl(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);
/// Writes one solid; patch names are lost (reported in the log).
void write_stl_binary(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);
void write_stl_text(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
