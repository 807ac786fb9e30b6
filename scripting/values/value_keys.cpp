#include "scripting/values/value_keys.h"

#include "scripting/lua/component_value.h"
#include "scripting/values/stored_stages.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {
namespace {

/// Adds all data that are no options of a schema, except sources, which are used only after the envelope. All members are listed, so that a new member does not
/// compile until it is in a key.
void add_rest(KeyMaker& maker, const volmesh::MeshCase& options) {
  const auto& [first_heights, patches, farfield_surface, sources, discs, wakes, periodic, smooth_angle, parts] =
      static_cast<const volmesh::MeshFacts&>(options);
  maker.add(patches).add(farfield_surface).add(discs).add(wakes).add(periodic).add(smooth_angle).add(parts);
  maker.add(first_heights != nullptr);
  if (first_heights) maker.add(std::vector<double>(first_heights->values().begin(), first_heights->values().end()));
}

}  // namespace

ContentKey key_of(const TriMesh& mesh) { return KeyMaker("triangles").add(mesh).key(); }

ContentKey key_of(const SurfaceRecipe& recipe) {
  SurfaceRecipe named = recipe;
  return KeyMaker("recipe").add(sterna::options_of(named.options)).add(recipe.patches).add(recipe.sources).add(recipe.sources_text).key();
}

std::optional<ContentKey> key_of(const SurfaceValue& surface) {
  if (surface.model_wall && !surface.model_wall_key) return std::nullopt;
  KeyMaker maker("surface");
  const auto& [mesh, report, options, inputs, union_options, repair_options, wrap_options, remesh_options, recipe, mesh_report, smooth_angle, layers,
               model_wall, parts, model_wall_key, changes, changed] = surface;  // lists all members, so that a new member does not compile until it is handled
  maker.add(mesh)
      .add(report)
      .add(options)
      .add(inputs)
      .add(union_options)
      .add(repair_options)
      .add(wrap_options)
      .add(remesh_options)
      .add(recipe)
      .add(mesh_report)
      .add(smooth_angle)
      .add(layers)
      .add(parts)
      .add(changes)
      .add(changed);
  if (model_wall) maker.add(*model_wall_key);
  return maker.key();
}

ContentKey key_of(const ComponentValue& component) {
  const auto& [kind, shape, intake, exhaust, deflections] = component;  // lists all members, so that a new member does not compile until it is handled
  return KeyMaker("component").add(kind).add(shape).add(intake).add(exhaust).add(deflections).key();
}

ContentKey envelope_options_key(const volmesh::MeshCase& options) {
  volmesh::MeshCase named = options;
  named.limits = {};  // limits decide if the envelope is made, but do not change its result
  KeyMaker maker("envelope options");
  maker.add(volmesh::options_of(named, volmesh::k_envelope_step));
  if (!options.discs.empty()) maker.add(options.size.size_growth);  // the growth of sizes determines the triangles of discs
  add_rest(maker, options);
  return maker.key();
}

ContentKey volume_options_key(const volmesh::MeshCase& options) {
  volmesh::MeshCase named = options;
  KeyMaker maker("volume options");
  maker.add(volmesh::options_of(named)).add(options.sources);
  add_rest(maker, options);
  return maker.key();
}

ContentKey key_of(const volmesh::EnvelopeStage& stage) { return KeyMaker("envelope").add(stage).key(); }

ContentKey key_of(const volmesh::FilledStage& stage) {
  KeyMaker maker("filled");
  const volmesh::TetraResult& tets = stage.tets;  // without the measurements of the engine
  maker.add(stage.split_wall)
      .add(stage.envelope)
      .add(stage.layers)
      .add(tets.new_points)
      .add(tets.tetrahedra)
      .add(tets.splits)
      .add(tets.engine)
      .add(tets.is_two_pass)
      .add(tets.failures)
      .add(tets.is_reproducible);
  return maker.add(stage.tetra_failures).add(stage.curving_shares).add(stage.n_split_triangles).add(stage.slivers).add(stage.is_opened).key();
}

std::optional<ContentKey> key_of(const EnvelopeValue& envelope) {
  const std::optional<ContentKey> wall = key_of(*envelope.wall);
  if (!wall) return std::nullopt;
  const auto& [wall_handle, options, stage, step, classes] =
      envelope;  // lists all members, so that a new member does not compile until it is handled; classes follow from the others
  return KeyMaker("envelope value").add(*wall).add(volume_options_key(options)).add(key_of(stage)).add(to_string(step)).key();
}

std::optional<ContentKey> key_of(const TetrahedraValue& tetrahedra) {
  const std::optional<ContentKey> wall = key_of(*tetrahedra.wall);
  if (!wall) return std::nullopt;
  return KeyMaker("tetrahedra value")
      .add(*wall)
      .add(tetrahedra.n_wall_triangles)
      .add(volume_options_key(tetrahedra.options))
      .add(key_of(tetrahedra.stage))
      .key();
}

ContentKey key_of(const MeshValue& mesh) { return KeyMaker("mesh").add(mesh.mesh).add(mesh.inputs).key(); }

}  // namespace sterna::scripting
