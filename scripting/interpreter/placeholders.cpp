#include "scripting/interpreter/placeholders.h"

#include "geom/model/shapes.h"
#include "scripting/interpreter/script_objects.h"
#include "scripting/lua/quantity.h"
#include "scripting/lua/script_check.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/models.h"
#include "scripting/values/stored_stages.h"
#include "scripting/verbs/inspect_verbs.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_either = "model or surface";

/// Returns a tetrahedron: the smallest closed surface.
TriMesh smallest_surface() {
  TriMesh mesh;
  mesh.points = {Point{0.0, 0.0, 0.0}, Point{1.0, 0.0, 0.0}, Point{0.0, 1.0, 0.0}, Point{0.0, 0.0, 1.0}};
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back({VertexId(a), VertexId(b), VertexId(c)});
    mesh.triangle_patch.push_back(PatchId(0u));
  };
  add(0, 2, 1);
  add(0, 1, 3);
  add(1, 2, 3);
  add(0, 3, 2);
  mesh.patches.push_back({.name = "wall"});
  return mesh;
}

SurfaceHandle make_surface() {
  SurfaceValue value;
  value.mesh = smallest_surface();
  value.report.is_closed = true;
  value.mesh_report.emplace();
  value.smooth_angle = 0.0;
  return std::make_shared<const SurfaceValue>(std::move(value));
}

EnvelopeHandle make_envelope_of(const SurfaceHandle& wall) {
  EnvelopeValue value{.wall = wall, .options = {}, .stage = {}};
  value.stage.envelope.height.resize(wall->mesh.n_vertices(), 1.0);
  value.stage.envelope.direction.resize(wall->mesh.n_vertices(), Vec3{0.0, 0.0, 1.0});
  return std::make_shared<const EnvelopeValue>(std::move(value));
}

MeshHandle make_mesh() {
  MeshValue value;
  value.mesh.points = {Point{0.0, 0.0, 0.0}, Point{1.0, 0.0, 0.0}, Point{0.0, 1.0, 0.0}, Point{0.0, 0.0, 1.0}};
  value.mesh.tetrahedra.push_back({NodeId(0u), NodeId(1u), NodeId(2u), NodeId(3u)});
  value.mesh.patches.push_back({.name = "wall"});
  value.origin.emplace();
  return std::make_shared<const MeshValue>(std::move(value));
}

ModelHandle make_model() {
  ModelValue value{.without_description = "it is a placeholder for a model"};
  value.model = make_box("model", Point{0.0, 0.0, 0.0}, Point{1.0, 1.0, 1.0});
  return std::make_shared<const ModelValue>(std::move(value));
}

const ScriptValue& kept(ScriptCheck& check, std::string_view kind) {
  if (const auto found = check.placeholders.find(kind); found != check.placeholders.end()) return found->second;
  ScriptValue made;
  if (kind == "surface") made = make_surface();
  if (kind == "envelope") made = make_envelope_of(std::get<SurfaceHandle>(kept(check, "surface")));
  if (kind == "tetrahedra")
    made = std::make_shared<const TetrahedraValue>(TetrahedraValue{.wall = std::get<SurfaceHandle>(kept(check, "surface")), .options = {}, .stage = {}});
  if (kind == "mesh") made = make_mesh();
  if (kind == "model") made = make_model();
  if (kind == "quantity") made = std::make_shared<const QuantityValue>(quantity_of_text("y_plus 1 mach=0.5 altitude=0 length=1"));
  return check.placeholders.emplace(std::string(kind), std::move(made)).first->second;
}

/// Returns true if the first argument is a surface. A verb that accepts surfaces and models returns the type of its argument.
bool is_about_surfaces(const ScriptCall& call) {
  if (call.arguments.empty()) return false;
  const ScriptValue& argument = call.arguments.front();
  const auto* table = std::get_if<TableHandle>(&argument);
  if (table && (*table)->items.empty()) return false;
  const ScriptValue& first = table ? (*table)->items.front() : argument;
  const auto* name = std::get_if<std::string>(&first);
  return std::holds_alternative<SurfaceHandle>(first) || (name && !is_model_file(*name));
}

}  // namespace

ScriptValue make_placeholder(const ScriptCall& call, std::string_view gives) {
  ScriptCheck& check = *call.session.check;
  if (gives == "self") return call.arguments.empty() ? ScriptValue() : call.arguments.front();
  if (gives == k_either) return kept(check, is_about_surfaces(call) ? "surface" : "model");
  if (object_kind(gives)) return kept(check, gives);
  if (gives == "inspection") return inspection_placeholder();
  if (gives != "stages") return OpaqueValue{k_unknown_value};  // the verb returns a source, or a table whose names follow from missing results
  auto table = std::make_shared<ScriptTable>();
  for (const char* kind : {"surface", "envelope", "tetrahedra", "mesh"}) table->fields[kind] = kept(check, kind);
  return table;
}

}  // namespace sterna::scripting
