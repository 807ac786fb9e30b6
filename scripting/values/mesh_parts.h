// The surface of a model part by part: each meshed in its own frame and moved to its place, so that a part has the same triangles at every attitude.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "geom/base/run_context.h"
#include "scripting/values/models.h"
#include "scripting/values/verbs.h"
#include "surfmesh/model/surface_mesh.h"
#include "volmesh/case/placed_part.h"

namespace sterna::scripting {

/// Everything that the mesh of a part depends on.
struct PartTask {
  Model model;  ///< in its own frame, with its names
  surfmesh::SurfaceMeshOptions options;
  std::vector<surfmesh::PatchSurfaceOptions> patches;  ///< those that a face of it is named like
  surfmesh::SpaceSizes sizes;                          ///< in its own frame
  bool has_sizes_by_place = false;                     ///< sizes say something: they depend on the part's place
  Transform placement;                                 ///< of the part; concerns its mesh only where has_sizes_by_place
  std::optional<ContentKey> model_key;                 ///< of what the model was made of, but for its names and kinds; nothing: not known
};

/// Meshes one part.
/// \throws Error of surfmesh::mesh_model
surfmesh::SurfaceMesh mesh_part(const PartTask& task, const RunContext& context);

/// Who makes the meshes of parts: mesh_part(), or one who knows some already.
using PartMesher = std::function<surfmesh::SurfaceMesh(const PartTask&, const RunContext&)>;

struct PartsMesh {
  surfmesh::SurfaceMesh mesh;              ///< of value.model
  std::vector<volmesh::PlacedPart> parts;  ///< empty where the model was meshed at once in its place
};

/// Meshes the parts of a model and joins them. A model of one part that was never moved is meshed as it is. Sizes by place (sources, functions) are asked where
/// the parts are. All is meshed at once, in its place, which the log tells: with gap_cells for several parts, since gaps between them ask for sizes; and where
/// triangles of two parts cross that finer ones part. `sizes` are in space. \p in_place meshes what is meshed at once, as one part in its place; empty:
/// mesh_part().
/// \throws Error of surfmesh::mesh_model, join_parts
PartsMesh mesh_parts(const ModelValue& value, const SurfaceRecipe& recipe, const surfmesh::SpaceSizes& sizes, const PartMesher& mesher,
                     const RunContext& context, const PartMesher& in_place = {});

}  // namespace sterna::scripting
