// Nastran bulk data: small, large and free fields (docs/method/formats_surfaces.md, "Nastran").
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads CTRIA3, CQUAD4 and related cards (corners only for second-order elements). The PID is the patch, named by comments of ANSA and HyperMesh. Volume
/// elements are ignored.
/// \throws Error file_not_found, file_malformed (line), unsupported_format (INCLUDE, coordinate systems), cancelled.
SurfaceSoup read_nastran(const std::filesystem::path& path, const RunContext& context);

/// Writes large fields, with a PSHELL and name comments per patch. Coordinates have the 13 or 14 digits that 16 characters hold.
/// \throws Error write_failed, overflow (numbers of eight digits), cancelled.
void write_nastran(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
