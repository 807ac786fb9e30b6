#include "scripting/surface_verbs.h"

#include <array>
#include <functional>

#include "scripting/geometry_tools.h"
#include "scripting/model_surface.h"
#include "scripting/script_function.h"
#include "scripting/source_verbs.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_surface_mesh_usage = "surface_mesh{ model, max_edge = 0.4, curvature_angle = 12*deg, growth = 1.2, patches = { [\"wing*\"] = { max_edge = 0.15 } } }";

/// One entry of `patches`; notes problems.
void add_rule(std::vector<surfmesh::PatchSurfaceOptions>& rules, const std::string& names, const ScriptValue& value, TableReader& reader) {
  const std::string where = "patches[\"" + names + "\"]";
  const auto* table = std::get_if<TableHandle>(&value);
  if (!table || (*table)->fields.empty()) {
    reader.add_problem(where + ": expected a table of what these patches ask for instead, like { max_edge = 0.1 }, not " + std::string(table ? "one without named entries" : type_text(value)));
    return;
  }
  surfmesh::PatchSurfaceOptions rule{.names = names};
  const OptionTable schema = patch_rule_options(rule);
  TableReader entries(**table, where);
  entries.read_options(schema);
  try {
    entries.finish();
  } catch (const Error& error) {
    reader.add_problem(where + ": " + error.info().problem);
    return;
  }
  rules.push_back(std::move(rule));
}

std::vector<surfmesh::PatchSurfaceOptions> read_rules(TableReader& reader) {
  std::vector<surfmesh::PatchSurfaceOptions> rules;
  const ScriptValue* value = reader.field("patches");
  if (!value) return rules;
  const auto* table = std::get_if<TableHandle>(value);
  if (!table || !(*table)->items.empty() || !(*table)->other_keys.empty()) {
    reader.add_problem("patches: expected a table by names of faces, { [\"wing*\"] = { max_edge = 0.1 } }" + (table ? "; its keys are texts" : ", not " + std::string(type_text(*value))));
    return rules;
  }
  for (const auto& [names, entry] : (*table)->fields) add_rule(rules, names, entry, reader);
  sort_rules(rules);
  return rules;
}

/// size = function(x, y, z) return 0.1 + 0.05*x end
std::function<double(const Point&)> read_size_function(TableReader& reader) {
  const ScriptValue* value = reader.field("size");
  if (value == nullptr) return {};
  const auto* function = std::get_if<FunctionHandle>(value);
  if (function == nullptr) {
    reader.add_problem("size: expected a function of x, y, z that returns the length of edges there in metres, not " + std::string(type_text(*value)) + "; max_edge is a number");
    return {};
  }
  return [function = *function](const Point& p) {
    std::array<double, 1> result{};
    function->call(std::array{p.x, p.y, p.z}, result);
    return result[0];
  };
}

ScriptValue make_surface_mesh(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_surface_mesh_usage);
  SurfaceRecipe recipe;
  const OptionTable schema = with_edge_tables(sterna::options_of(recipe.options));
  TableReader reader(table, call.attempted());
  std::vector<ModelHandle> models;
  const std::vector<ScriptValue>& items = reader.items();
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (ModelHandle model = model_of(items[i], call)) models.push_back(std::move(model));
    else
      reader.add_problem("entry " + std::to_string(i + 1) + ": expected a model (from read_cad, aircraft ...) or a component, not " + std::string(type_text(items[i])) +
                         (std::holds_alternative<SurfaceHandle>(items[i]) ? ", which is made of triangles already: volume_mesh takes it" : ""));
  }
  if (items.empty()) reader.add_problem("needs a model: " + std::string(k_surface_mesh_usage));
  reader.read_options(schema);
  recipe.patches = read_rules(reader);
  recipe.sources = read_sources(reader, call);
  const std::function<double(const Point&)> size = read_size_function(reader);
  apply_overrides(call, sterna::options_of(recipe.options));
  reader.finish();
  return std::make_shared<const SurfaceValue>(mesh_models(models, recipe, size, call.session.context.part("surface_mesh", 0.0, 1.0)));
}

std::string surface_mesh_help() {
  surfmesh::SurfaceMeshOptions options;
  surfmesh::PatchSurfaceOptions rule;
  return options_help(sterna::options_of(options)) + "patches = { [\"wing*\"] = { ... } }, of faces with such names; of two patterns that match the one with more letters counts:\n" + options_help(patch_rule_options(rule)) +
         "sources = { line{ {0,0,0}, {8,0,0}, size = 0.02 }, ... }: shorter edges there. size = function(x, y, z) return 0.1 end: edges at most that long\n";
}

constexpr std::array<ScriptVerb, 1> k_verbs = {{
    {"surface_mesh", k_surface_mesh_usage, "Triangles on the faces of models, closed where the models are: the wall that volume_mesh takes.", make_surface_mesh, surface_mesh_help, true},
}};

}  // namespace

std::span<const ScriptVerb> surface_verbs() { return k_verbs; }

}  // namespace sterna::scripting
