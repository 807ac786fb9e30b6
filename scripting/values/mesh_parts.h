// Meshes the surface of a model part by part. Each part is meshed in its own frame and moved to its location, so that a part has the same triangles at every
// attitude.
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

/// All data that determine the mesh of a part.
struct PartTask {
  Model model;  ///< the part in its own frame, with its names
  surfmesh::SurfaceMeshOptions options;
  std::vector<Rule> patches;            ///< rules that match the name of one of its faces
  surfmesh::SpaceSizes sizes;           ///< sizes in the part's own frame
  bool has_local_sizes = false;         ///< sizes are set: they depend on the part's location
  Transform placement;                  ///< placement of the part; affects its mesh only if has_local_sizes
  std::optional<ContentKey> model_key;  ///< key of the inputs of the model, except its names and kinds; nothing: unknown
};

/// Meshes one part.
/// \throws Error of surfmesh::mesh_model
surfmesh::SurfaceMesh mesh_part(const PartTask& task, const RunContext& context);

/// Mesher of a part: mesh_part(), or a function that uses cached parts.
using PartMesher = std::function<surfmesh::SurfaceMesh(const PartTask&, const RunContext&)>;

struct PartsMesh {
  surfmesh::SurfaceMesh mesh;              ///< mesh of value.model
  std::vector<volmesh::PlacedPart> parts;  ///< empty if the whole model was meshed at its location
};

/// Meshes the parts of a model and joins them. A model of one part that was never moved is meshed as it is. Sizes by location (sources, functions) are
/// evaluated at the actual location of the parts. In three cases all parts are meshed together at their locations, which the log reports: with gap_cells for
/// several parts, because gaps between the parts impose sizes; if periodic sides belong to different parts; and if triangles of two parts cross that finer
/// triangles would separate. `sizes` are in space. \p in_place meshes such a model, as one part at its location; empty: mesh_part()
/// \throws Error of surfmesh::mesh_model, join_parts
PartsMesh mesh_parts(const ModelValue& value, const SurfaceRecipe& recipe, const surfmesh::SpaceSizes& sizes, const PartMesher& mesher,
                     const RunContext& context, const PartMesher& in_place = {});

}  // namespace sterna::scripting
