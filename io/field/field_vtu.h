// VTU output of a surface with fields, for inspection.
#pragma once

#include <filesystem>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "geom/mesh/tri_mesh_field.h"

namespace sterna::io {

/// Writes triangles with "marker" = patch number + 1 and each field as a 32-bit float array at vertices or cells; names and kinds of patches are field data.
/// \pre each field has as many values as the mesh has vertices or triangles
/// \throws Error write_failed, cancelled
void write_field_vtu(const TriMesh& mesh, const std::vector<TriMeshField>& fields, const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna::io
