#include "scripting/verbs/half_verbs.h"

#include <algorithm>
#include <array>

#include "geom/base/glob.h"
#include "geom/cad/half_model.h"
#include "geom/mesh/half.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/aircraft_model.h"
#include "scripting/values/fluid_model.h"
#include "scripting/values/geometry_changes.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/models.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_half_usage = "half{ model, at = 0.4 }  or  half{ wall, axis = \"y\", at = 0.4, keep = \"+\" }";

std::string half_help() {
  HalfOptions of_surface;
  HalfModelOptions of_model;
  return "for a surface or a file of a surface:\n" + options_help(sterna::options_of(of_surface)) + "for models and components:\n" +
         options_help(sterna::options_of(of_model));
}

/// Returns the table of half{ x } for half(x), for any x.
ScriptTable half_argument(const ScriptCall& call) {
  if (!call.arguments.empty() && std::holds_alternative<SurfaceHandle>(call.arguments.front()))
    return {.items = {call.arguments.front()}, .fields = {}, .other_keys = {}};
  return table_argument(call, 0, k_half_usage);
}

bool is_surface(const ScriptValue& item) {
  const auto* name = std::get_if<std::string>(&item);
  return std::holds_alternative<SurfaceHandle>(item) || (name && !is_model_file(*name));
}

ScriptValue half_of_a_surface(const ScriptCall& call, const ScriptTable& table) {
  HalfOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  if (items.size() != 1) reader.add_problem("takes one surface, not " + std::to_string(items.size()) + ": " + std::string(k_half_usage));
  reader.read_options(schema);
  apply_overrides(call, schema);
  reader.finish();
  const RunContext context = call.session.context.part("half", 0.0, 1.0);
  if (const auto* surface = std::get_if<SurfaceHandle>(&items.front())) return std::make_shared<const SurfaceValue>(half_surface(**surface, options, context));
  surfmesh::StitchOptions reading;
  reading.allow_open = true;
  const std::array files = {find_input(call, std::get<std::string>(items.front()))};
  return std::make_shared<const SurfaceValue>(half_surface(read_wall(files, reading, context), options, context));
}

ScriptValue make_half(const ScriptCall& call) {
  const ScriptTable table = half_argument(call);
  if (std::ranges::any_of(table.items, is_surface)) return half_of_a_surface(call, table);
  HalfModelOptions options;
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  std::vector<ModelHandle> models;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (ModelHandle model = model_of(items[i], call)) models.push_back(std::move(model));
    else reader.add_problem("entry " + std::to_string(i + 1) + ": expected a model, a component or a surface, not " + std::string(type_text(items[i])));
  }
  if (items.empty()) reader.add_problem("needs a model or a surface: " + std::string(k_half_usage));
  reader.read_options(sterna::options_of(options));
  reader.finish();
  return std::make_shared<const ModelValue>(half_of_model(assemble(models, call.session.context), options, call.session.context.part("half", 0.0, 1.0)));
}

constexpr std::array<ScriptVerb, 1> k_half_verbs = {{
    {"half", k_half_usage,
     "Cuts a model or a surface at its plane of symmetry and returns one half: open there, with its boundary exactly in the plane. Half models are returned "
     "unchanged.",
     make_half, half_help, true, "model or surface", true, held_options<HalfOptions>},
}};

}  // namespace

std::span<const ScriptVerb> half_verbs() { return k_half_verbs; }

SurfaceValue half_surface(const SurfaceValue& surface, const HalfOptions& options, const RunContext& context) {
  SurfaceValue half = surface;
  replace_mesh(half, half_of(surface.mesh, options, context));
  half.report.is_closed = false;
  std::erase_if(half.layers, [&](const Rule& rule) {  // removes rules of patches that are on the other side only
    return std::none_of(half.mesh.patches.begin(), half.mesh.patches.end(), [&](const Patch& patch) { return matches_glob(patch.name, rule.names); });
  });
  note_half(half, surface.mesh, options, context);
  return half;
}

}  // namespace sterna::scripting
