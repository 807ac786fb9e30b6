// Legacy VTK files of surfaces (docs/method/formats.md, "Legacy VTK"), and a reader of volume meshes.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::io {

/// Reads versions 1.0 to 5.1, text and binary: POLYDATA and the faces of an UNSTRUCTURED_GRID. Patches are taken from the first integer cell array of marker,
/// boundary, CellEntityIds, gmsh:physical, ids.
/// \throws Error file_not_found, file_malformed (line or byte offset), unsupported_format, cancelled.
SurfaceSoup read_surface_vtk(const std::filesystem::path& path, const RunContext& context);
/// Reads a volume mesh: cells in the explicit arrays, windings repaired.
HybridMesh read_volume_vtk(const std::filesystem::path& path, const RunContext& context);

/// Writes POLYDATA of version 3.0, binary; "marker" = patch number + 1, names and kinds as field data "patch:<kind>:<name>".
/// \throws Error write_failed, overflow (31-bit sizes), cancelled.
void write_surface_vtk(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);
/// Writes the same contents as text in full precision.
void write_surface_vtk_text(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
