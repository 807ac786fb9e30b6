#include "scripting/values/value_keys.h"

#include "scripting/lua/component_value.h"
#include "scripting/values/stored_stages.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

ContentKey key_of(const TriMesh& mesh) { return KeyMaker("triangles").add(mesh).key(); }

ContentKey key_of(const SurfaceRecipe& recipe) { return KeyMaker("recipe").add(recipe).key(); }

std::optional<ContentKey> key_of(const SurfaceValue& surface) {
  if (surface.true_surface.wall && !surface.true_surface.key) return std::nullopt;
  return KeyMaker("surface").add(surface).key();
}

ContentKey key_of(const ComponentValue& component) { return KeyMaker("component").add(component).key(); }

ContentKey envelope_options_key(const volmesh::MeshCase& options) {
  volmesh::MeshCase named = options;
  named.limits = {};      // limits decide if the envelope is made, but do not change its result
  named.sources.clear();  // used only after the envelope
  KeyMaker maker("envelope options");
  maker.add(volmesh::options_of(named, volmesh::k_envelope_step)).add<volmesh::MeshFacts>(named);
  if (!options.discs.empty()) maker.add(options.size.size_growth);  // the growth of sizes determines the triangles of discs
  return maker.key();
}

ContentKey volume_options_key(const volmesh::MeshCase& options) {
  volmesh::MeshCase named = options;
  return KeyMaker("volume options").add(volmesh::options_of(named)).add<volmesh::MeshFacts>(named).key();
}

ContentKey key_of(const volmesh::EnvelopeStage& stage) { return KeyMaker("envelope").add(stage).key(); }
ContentKey key_of(const volmesh::FilledStage& stage) { return KeyMaker("filled").add(stage).key(); }

std::optional<ContentKey> key_of(const EnvelopeValue& envelope) {
  static_assert(member_count<EnvelopeValue>() == 5, "wall, options, stage and step are in the key; the classes follow from them");
  const std::optional<ContentKey> wall = key_of(*envelope.wall);
  if (!wall) return std::nullopt;
  return KeyMaker("envelope value").add(*wall).add(volume_options_key(envelope.options)).add(key_of(envelope.stage)).add(to_string(envelope.step)).key();
}

std::optional<ContentKey> key_of(const TetrahedraValue& tetrahedra) {
  static_assert(member_count<TetrahedraValue>() == 4, "all members are in the key");
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
