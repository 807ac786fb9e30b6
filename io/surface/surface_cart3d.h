// Cart3D .tri: triangles with component numbers, text and binary (docs/method/formats_surfaces.md, "Cart3D").
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads text, or Fortran records of either byte order, detected from the contents. Scalars of .triq are ignored.
/// \throws Error file_not_found, file_malformed (line or byte offset), cancelled.
SurfaceSoup read_cart3d(const std::filesystem::path& path, const RunContext& context);

/// Writes text in full precision; component numbers are patch numbers from 1.
/// \throws Error write_failed, cancelled.
void write_cart3d(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);
/// Writes little-endian Fortran records in single precision.
/// \throws Error write_failed, overflow (float range, 31-bit records), cancelled.
void write_cart3d_binary(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
