#include "scripting/values/mesh_parts.h"

#include <algorithm>
#include <utility>

#include "geom/base/glob.h"
#include "surfmesh/model/join_parts.h"
#include "surfmesh/model/periodic_borders.h"

namespace sterna::scripting {
namespace {

using surfmesh::SpaceSizes;

bool has_sizes(const SpaceSizes& sizes) { return sizes.regions || sizes.function || !sizes.samples.empty(); }

/// Returns the sizes at the locations to which `placement` takes points of the part's own frame.
SpaceSizes in_frame(const SpaceSizes& sizes, const Transform& placement) {
  if (placement == Transform{}) return sizes;
  SpaceSizes own;
  if (sizes.regions) own.regions = [regions = sizes.regions, placement](const Point& p, double slope) { return regions(placement.point(p), slope); };
  if (sizes.function) own.function = [function = sizes.function, placement](const Point& p) { return function(placement.point(p)); };
  const Transform back = placement.inverse();
  for (const SizePoint& sample : sizes.samples) own.samples.push_back({back.point(sample.point), sample.size});
  return own;
}

/// Returns the rules that apply to a part, and those that apply to no part. mesh_model rejects the latter.
std::vector<Rule> rules_for(const Model& part, const Model& all, const std::vector<Rule>& rules) {
  const auto concerns = [](const Model& model, const Rule& rule) {
    return std::any_of(model.faces.begin(), model.faces.end(), [&](const ModelFace& face) { return matches_glob(face.name, rule.names); });
  };
  std::vector<Rule> result;
  for (const Rule& rule : rules)
    if (concerns(part, rule) || !concerns(all, rule)) result.push_back(rule);
  return result;
}

bool has_face(const Model& model, const std::string& name) {
  return std::any_of(model.faces.begin(), model.faces.end(), [&](const ModelFace& face) { return face.name == name; });
}

/// Returns true if both sides of each pair are faces of the same part, or are in no part. mesh_model rejects the latter.
bool are_pairs_within_parts(const ModelValue& value, const std::vector<ModelPart>& parts, const std::vector<PeriodicNames>& pairs) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Model own = own_model(value, parts, i);
    for (const PeriodicNames& pair : pairs)
      if (has_face(own, pair.first) != has_face(own, pair.second) && has_face(value.model, pair.first) && has_face(value.model, pair.second)) return false;
  }
  return true;
}

/// Returns the pairs of a part, and the pairs that belong to no part.
std::vector<PeriodicNames> pairs_for(const Model& part, const Model& all, std::vector<PeriodicNames> pairs) {
  std::erase_if(pairs, [&](const PeriodicNames& pair) { return has_face(all, pair.first) && has_face(all, pair.second) && !has_face(part, pair.first); });
  return pairs;
}

std::string name_of(const Model& part) { return part.components.size() == 0 ? part.faces.raw().front().name : part.components.raw().front().name; }

PartsMesh mesh_in_place(const ModelValue& value, const SurfaceRecipe& recipe, const SpaceSizes& sizes, const PartMesher& mesher, const RunContext& context) {
  if (mesher) return {mesher({value.model, recipe.options, recipe.patches, sizes, has_sizes(sizes), {}, {}}, context), {}};
  return {surfmesh::mesh_model(value.model, recipe.options, recipe.patches, sizes, context), {}};
}

}  // namespace

surfmesh::SurfaceMesh mesh_part(const PartTask& task, const RunContext& context) {
  return surfmesh::mesh_model(task.model, task.options, task.patches, task.sizes, context);
}

PartsMesh mesh_parts(const ModelValue& value, const SurfaceRecipe& recipe, const SpaceSizes& sizes, const PartMesher& mesher, const RunContext& context,
                     const PartMesher& in_place) {
  const std::vector<ModelPart> parts = parts_of(value);
  if (value.parts.empty()) return mesh_in_place(value, recipe, sizes, in_place, context);
  if (recipe.options.sizes.gap_cells > 0.0 && parts.size() > 1) {
    context.info("gap_cells: gaps between parts set edge lengths, so all parts are meshed together, in position");
    return mesh_in_place(value, recipe, sizes, in_place, context);
  }
  const std::vector<PeriodicNames>& pairs = recipe.options.periodic;
  if (!pairs.empty() && !are_pairs_within_parts(value, parts, pairs)) {
    context.info("periodic sides belong to different parts, so all parts are meshed together, in position");
    return mesh_in_place(value, recipe, sizes, in_place, context);
  }
  std::vector<PartTask> tasks;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    PartTask task{own_model(value, parts, i), recipe.options, {}, in_frame(sizes, parts[i].placement), has_sizes(sizes), parts[i].placement, parts[i].key};
    task.patches = rules_for(task.model, value.model, recipe.patches);
    task.options.periodic = pairs_for(task.model, value.model, pairs);
    tasks.push_back(std::move(task));
  }
  std::vector<surfmesh::SurfaceMesh> meshes;
  for (const PartTask& task : tasks) meshes.push_back(mesher(task, context));
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (!parts[i].is_in_place()) context.info("surface of \"" + name_of(tasks[i].model) + "\": made in its own frame, then moved");
  std::vector<surfmesh::PlacedMesh> placed;
  for (std::size_t i = 0; i < parts.size(); ++i) placed.push_back({&tasks[i].model, &meshes[i], parts[i].placement});
  if (parts.size() == 1 && parts.front().is_in_place()) {
    auto own = std::make_shared<const TriMesh>(meshes.front().mesh);
    const double smooth_angle = meshes.front().report.max_smooth_angle;
    return {std::move(meshes.front()), {{std::move(own), {}, 0, 0, smooth_angle}}};
  }
  std::optional<surfmesh::SurfaceMesh> joined = surfmesh::join_parts(value.model, placed, recipe.options, context);
  if (!joined) {
    context.info("triangles of different parts cross, which finer triangles may avoid: all parts are meshed together, in position");
    return mesh_in_place(value, recipe, sizes, in_place, context);
  }
  PartsMesh result{std::move(*joined), {}};
  std::uint32_t first_triangle = 0, first_vertex = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    auto own = std::make_shared<TriMesh>(std::move(meshes[i].mesh));
    const auto n_triangles = static_cast<std::uint32_t>(own->n_triangles()), n_vertices = static_cast<std::uint32_t>(own->n_vertices());
    result.parts.push_back({std::move(own), parts[i].placement, first_triangle, first_vertex, meshes[i].report.max_smooth_angle});
    first_triangle += n_triangles;
    first_vertex += n_vertices;
  }
  return result;
}

}  // namespace sterna::scripting
