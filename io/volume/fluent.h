// Fluent .msh, docs/method/formats_solvers.md, "Fluent": volume meshes, and their walls as surfaces.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/numbering.h"
#include "geom/mesh/surface_soup.h"

namespace sterna::io {

/// Reads text and binary sections (2010, 2012, 2013, 3010, 3012, 3013). Cells are reconstructed from the faces; cell zones are joined. Face zones are patches
/// with the names of sections 45 and 39 and kinds by their type. Walls between two cells become internal faces, reported in the log.
/// \throws Error file_malformed (line, or byte in binary sections), unsupported_format (two dimensions, polyhedra, hanging nodes), file_not_found
HybridMesh read_volume_fluent(const std::filesystem::path& path, const RunContext& context);

/// Reads the faces of all walls (zone type 3), or of all boundary zones if there is no wall. Normals point into the fluid.
SurfaceSoup read_surface_fluent(const std::filesystem::path& path, const RunContext& context);

/// Writes text. Cells are numbered column by column; face normals point into the first cell.
/// \throws Error overflow (2^31 faces), mesh_invalid (faces that do not match), write_failed, cancelled
void write_volume_fluent(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context);

/// Writes the mesh with another cell order (MeshFaces::order_cells); node numbers are unchanged.
void write_numbered_fluent(const HybridMesh& mesh, const std::filesystem::path& path, Numbering numbering, const RunContext& context);

}  // namespace sterna::io
