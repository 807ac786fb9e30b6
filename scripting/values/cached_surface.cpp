#include "scripting/values/cached_surface.h"

#include <memory>
#include <string>
#include <utility>

#include "scripting/cache/stage_cache.h"
#include "scripting/values/start_from_reference.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/summary.h"
#include "scripting/values/value_keys.h"

namespace sterna::scripting {
namespace {

constexpr const char* k_stage = "surface_mesh";
constexpr std::size_t k_listed_parts = 4;

/// Returns the key of all inputs of the surface; nothing if the inputs of a model are unknown.
std::optional<ContentKey> surface_key_of(const std::vector<ModelHandle>& models, const SurfaceRecipe& requested, bool has_function, const RunContext& context) {
  KeyMaker maker(k_stage);
  for (const ModelHandle& model : models) {
    if (!model->provenance.key()) return std::nullopt;
    maker.add(*model->provenance.key());
  }
  return maker.add(scripting::key_of(requested)).add(has_function).add(context.seed()).key();
}

/// Returns the key of a part; nothing if its inputs are unknown, or sizes depend on its location.
std::optional<ContentKey> surface_key_of(const PartTask& task, const RunContext& context) {
  if (!task.model_key || task.has_local_sizes) return std::nullopt;
  surfmesh::SurfaceMeshOptions options = task.options;
  KeyMaker maker("surface of a part");
  maker.add(*task.model_key).add(sterna::options_of(options)).add(task.patches).add(context.seed());
  for (const Component& component : task.model.components) maker.add(component.name).add(component.kind);
  for (const ModelEdge& edge : task.model.edges) maker.add(edge.name);
  for (const ModelFace& face : task.model.faces) maker.add(face.name).add(face.role).add(face.kind);
  for (const ModelSolid& solid : task.model.solids) maker.add(solid.name);
  return maker.key();
}

/// Writes a surface of surface_mesh. The model is not written, only the positions on it.
void write_parts(ByteSink& sink, const SurfaceValue& surface) {
  write_value(sink, surface);
  write_value(sink, surface.true_surface.wall->locations());
}

/// Reads the surface. Its inputs are those of the models, because files of the same content may have other names.
SurfaceValue read_parts(ByteSource& source, const std::vector<ModelHandle>& models, const std::function<Model()>& all) {
  SurfaceValue surface;
  surfmesh::WallLocations locations;
  read_value(source, surface);
  read_value(source, locations);
  surface.true_surface.wall = std::make_shared<const surfmesh::ModelWall>(all, std::move(locations), surface.mesh.triangles);
  surface.inputs.clear();
  for (const ModelHandle& model : models) surface.inputs.insert(surface.inputs.end(), model->inputs.begin(), model->inputs.end());
  return surface;
}

}  // namespace

std::string names_of(const std::vector<ModelHandle>& models) {
  std::string text;
  std::size_t n = 0;
  for (const ModelHandle& model : models)
    for (const Component& component : model->model.components)
      if (++n <= k_listed_parts) text += (text.empty() ? "of " : ", ") + component.name;
  return n <= k_listed_parts ? text : text + " and " + std::to_string(n - k_listed_parts) + " more";
}

PartMesher cached_part_mesher(const Reuse& reuse) {
  const PartMesher ordinary = [reuse](const PartTask& task, const RunContext& context) {
    const std::optional<ContentKey> key = reuse.cache ? surface_key_of(task, context) : std::nullopt;
    const std::string what =
        task.model.components.size() == 0 ? std::string("of a part") : "of " + task.model.components.raw().front().name + " in its own frame";
    return cached<surfmesh::SurfaceMesh>(reuse, k_stage, what, key, context, [&] { return mesh_part(task, context); });
  };
  return starting_mesher(reuse, ordinary, [](const PartTask& task, const RunContext& context) { return surface_key_of(task, context); });
}

SurfaceValue cached_surface(const std::vector<ModelHandle>& models, const SurfaceRecipe& requested, const SizeFunction& size,
                            const std::function<SurfaceValue(const SizeFunction&)>& make, const std::function<Model()>& all, const Reuse& reuse,
                            const RunContext& context) {
  ReferenceUse* reference = reuse.reference;
  if (reference) reference->begin_surface();
  std::optional<ContentKey> key =
      reuse.cache ? beside_reference(surface_key_of(models, requested, static_cast<bool>(size), context), reuse, context) : std::nullopt;
  if (key && reference && !reference->is_this())
    key = KeyMaker("call").add(*key).add(reference->surface()).key();  // results depend on the call number, because parts prefer to start from the same call
  if (!reuse.cache || !key)
    return cached<SurfaceValue>(
        reuse, k_stage, {}, std::nullopt, context, [&] { return make(size); }, write_parts, std::function<SurfaceValue(ByteSource&)>());
  const std::string what = names_of(models);
  const ReferenceUse::Mark mark = reference ? reference->mark() : ReferenceUse::Mark();
  std::optional<ReferenceUse::Beside> found;
  const auto write = [&](ByteSink& sink, const SurfaceValue& surface) {
    write_parts(sink, surface);
    if (reference) write_beside(sink, reference->since(mark));
  };
  const auto read = [&](ByteSource& source) {
    SurfaceValue surface = read_parts(source, models, all);
    if (reference) found = read_beside(source);
    return surface;
  };
  const auto make_here = [&](const SizeFunction& requested_size) {
    found.reset();  // the entry was not valid after all
    return make(requested_size);
  };
  SurfaceValue surface = size ? cached_by_answers<SurfaceValue>(reuse, k_stage, what, key, size, context, make_here, write, read)
                              : cached<SurfaceValue>(
                                    reuse, k_stage, what, key, context, [&] { return make_here({}); }, write, std::function<SurfaceValue(ByteSource&)>(read));
  if (found) reference->take(std::move(*found), reuse, context);
  surface.true_surface.key = key;
  return surface;
}

}  // namespace sterna::scripting
