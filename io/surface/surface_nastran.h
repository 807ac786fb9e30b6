// Nastran bulk data: small, large and free fields (docs/method/formats_surfaces.md, "Nastran").
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// CTRIA3, CQUAD4 and their kin (corners of those of second order); PID is the patch, named by comments of ANSA and HyperMesh. Volume elements are passed over.
/// \throws Error file_not_found, file_malformed (line), unsupported_format (INCLUDE, coordinate systems), cancelled.
SurfaceSoup read_nastran(const std::filesystem::path& path, const RunContext& context);

/// Large fields: coordinates to the 13 or 14 digits that 16 characters hold; a PSHELL and named comments for each patch.
/// \throws Error write_failed, overflow (numbers of eight digits), cancelled.
void write_nastran(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
