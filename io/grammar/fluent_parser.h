// Parser of Fluent mesh sections into faces with their cells.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"
#include "geom/mesh/tri_mesh.h"
#include "io/input/file_buffer.h"
#include "io/mesh/face_based_mesh.h"

namespace sterna::io {

struct FluentContent {
  std::vector<Vec3> points;
  FaceBasedMesh faces;             ///< patches numbered in the order in which their zones appear
  Column<PatchId, Patch> patches;  ///< zones of boundary faces
  std::int64_t n_cell_zones = 0;
  std::int64_t n_inner_walls = 0;  ///< faces of boundary zones between two cells, which are treated as inner faces
};

/// Returns the patch kind for a zone type and name.
PatchKind kind_of_fluent_zone(std::int64_t type, std::string_view name);

/// Parses a Fluent mesh.
/// \throws Error file_malformed, unsupported_format
FluentContent parse_fluent(const FileBuffer& buffer, const RunContext& context);

}  // namespace sterna::io
