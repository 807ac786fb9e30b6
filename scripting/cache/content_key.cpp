#include "scripting/cache/content_key.h"

#include <algorithm>
#include <cstdio>

#include "scripting/values/component_value.h"
#include "scripting/values/stages.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {
namespace {

std::string value_text(const OptionValue& value) {
  if (const auto* number = std::get_if<double>(&value)) {
    if (is_automatic(*number)) return "automatic";
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", *number);
    return text;
  }
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return std::get<std::string>(value);
}

/// All that is no option of a schema, but for sources, which come behind the envelope. The members are listed so that a new one does not compile until it is in
/// a key.
void add_rest(KeyMaker& maker, const volmesh::MeshCase& options) {
  const auto& [first_heights, patches, farfield_surface, sources, discs, periodic, smooth_angle, parts] = static_cast<const volmesh::MeshFacts&>(options);
  maker.add(patches).add(farfield_surface).add(discs).add(periodic).add(smooth_angle).add(parts);
  maker.add(first_heights != nullptr);
  if (first_heights) maker.add(std::vector<double>(first_heights->values().begin(), first_heights->values().end()));
}

}  // namespace

std::string ContentKey::hex() const {
  constexpr char k_digits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += k_digits[byte >> 4];
    text += k_digits[byte & 15];
  }
  return text;
}

KeyMaker::KeyMaker(std::string_view what) { add(what); }

void KeyMaker::put(const void* bytes, std::size_t n) { hash_.append({static_cast<const std::byte*>(bytes), n}); }

KeyMaker& KeyMaker::add(std::string_view text) {
  detail::write_count(*this, text.size());
  put(text.data(), text.size());
  return *this;
}

KeyMaker& KeyMaker::add(const OptionTable& options) {
  for (const Option& option : options) add(option.stage).add(option.name).add(value_text(option.get()));
  return *this;
}

KeyMaker& KeyMaker::add(const OptionTable& options, std::initializer_list<std::string_view> stages) {
  for (const Option& option : options)
    if (std::find(stages.begin(), stages.end(), option.stage) != stages.end()) add(option.stage).add(option.name).add(value_text(option.get()));
  return *this;
}

ContentKey KeyMaker::key() const { return {hash_.digest()}; }

ContentKey key_of(const OptionTable& options) { return KeyMaker("options").add(options).key(); }

ContentKey key_of(const TriMesh& mesh) { return KeyMaker("triangles").add(mesh).key(); }

ContentKey key_of(const SurfaceRecipe& recipe) {
  SurfaceRecipe named = recipe;
  return KeyMaker("recipe").add(sterna::options_of(named.options)).add(recipe.patches).add(recipe.sources).add(recipe.sources_text).key();
}

std::optional<ContentKey> key_of(const SurfaceValue& surface) {
  if (surface.model_wall && !surface.model_wall_key) return std::nullopt;
  KeyMaker maker("surface");
  const auto& [mesh, report, options, inputs, union_options, recipe, mesh_report, smooth_angle, layers, model_wall, parts, model_wall_key] =
      surface;  // all members: a new one does not compile
  maker.add(mesh).add(report).add(options).add(inputs).add(union_options).add(recipe).add(mesh_report).add(smooth_angle).add(layers).add(parts);
  if (model_wall) maker.add(*model_wall_key);
  return maker.key();
}

ContentKey key_of(const ComponentValue& component) {
  const auto& [kind, shape, intake, exhaust, deflections] = component;  // all members: a new one does not compile
  return KeyMaker("component").add(kind).add(shape).add(intake).add(exhaust).add(deflections).key();
}

ContentKey envelope_options_key(const volmesh::MeshCase& options) {
  volmesh::MeshCase named = options;
  KeyMaker maker("envelope options");
  maker.add(volmesh::options_of(named, volmesh::k_envelope_step));
  if (!options.discs.empty()) maker.add(options.size.size_growth);  // decides their triangles
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
  const volmesh::TetraResult& tets = stage.tets;  // without what was measured of the engine
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
  return maker.add(stage.tetra_failures).add(stage.curving_shares).add(stage.n_split_triangles).key();
}

std::optional<ContentKey> key_of(const EnvelopeValue& envelope) {
  const std::optional<ContentKey> wall = key_of(*envelope.wall);
  if (!wall) return std::nullopt;
  const auto& [wall_handle, options, stage, step, classes, n_sources_in_file] =
      envelope;  // all members: a new one does not compile; classes follow from the rest
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
