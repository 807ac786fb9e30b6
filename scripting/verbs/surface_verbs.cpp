#include "scripting/verbs/surface_verbs.h"

#include <array>
#include <functional>

#include "geom/base/glob.h"
#include "scripting/lua/script_function.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/periodic_pairs.h"
#include "scripting/values/remeshed_surface.h"
#include "scripting/verbs/source_verbs.h"
#include "volmesh/envelope/patch_layers.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_surface_mesh_usage =
    "surface_mesh{ model, max_edge = 0.4, curvature_angle = 12*deg, growth = 1.2, patches = { [\"Body*\"] = { max_edge = 0.15 } } }";

/// Returns the options of a surface mesh without the pairs of periodic sides, which are a list in a script.
OptionTable without_pairs(OptionTable table) {
  std::erase_if(table, [](const Option& option) { return option.name == "periodic"; });
  return table;
}

/// Rules of patches: sizes of their triangles, and layer options for volume_mesh.
struct SurfaceRules {
  std::vector<Rule> sizes;
  std::vector<Rule> layers;
};

SurfaceRules read_rules(TableReader& reader) {
  const std::vector<Rule> given = read_patch_rules(reader, "max_edge = 0.1", surface_and_layer_options);
  SurfaceRules rules{.sizes = rules_of_step(given, size_rule_options), .layers = rules_of_step(given, volmesh::layer_rule_options)};
  keep_set_rules(rules.layers);
  return rules;
}

/// Reads size = function(x, y, z) return 0.1 + 0.05*x end.
std::function<double(const Point&)> read_size_function(TableReader& reader) {
  const ScriptValue* value = reader.field("size");
  if (value == nullptr) return {};
  const auto* function = std::get_if<FunctionHandle>(value);
  if (function == nullptr) {
    reader.add_problem("size: expected a function of x, y, z that returns the local edge length in metres, not " + std::string(type_text(*value)) +
                       "; max_edge is a number");
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
  const OptionTable schema = without_pairs(with_edge_tables(sterna::options_of(recipe.options)));
  TableReader reader(table, call.attempted());
  std::vector<ModelHandle> models;
  const std::vector<ScriptValue>& items = reader.items();
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (ModelHandle model = model_of(items[i], call)) models.push_back(std::move(model));
    else
      reader.add_problem("entry " + std::to_string(i + 1) + ": expected a model (from read_cad, aircraft ...) or a component, not " +
                         std::string(type_text(items[i])) +
                         (std::holds_alternative<SurfaceHandle>(items[i]) ? ", which has triangles already: pass it to volume_mesh" : ""));
  }
  if (items.empty()) reader.add_problem("needs a model: " + std::string(k_surface_mesh_usage));
  reader.read_options(schema);
  SurfaceRules rules = read_rules(reader);
  recipe.patches = std::move(rules.sizes);
  recipe.sources = read_sources(reader, call);
  recipe.options.periodic = read_periodic(reader);
  const std::function<double(const Point&)> size = read_size_function(reader);
  apply_overrides(call, sterna::options_of(recipe.options));
  reader.finish();
  auto surface = std::make_shared<SurfaceValue>(mesh_models(models, recipe, size, call.session.context.part("surface_mesh", 0.0, 1.0), call.session.reuse()));
  add_layer_rules(rules.layers, *surface);
  return std::shared_ptr<const SurfaceValue>(std::move(surface));
}

std::string surface_mesh_help() {
  surfmesh::SurfaceMeshOptions options;
  Rule rule;
  return options_help(without_pairs(sterna::options_of(options))) +
         "patches = { [\"wing*\"] = { ... } }: options of faces with matching names; of two matching patterns the one with more letters applies:\n" +
         options_help(surface_and_layer_options(rule)) +
         "sources = { line{ {0,0,0}, {8,0,0}, size = 0.02 }, ... }: regions of short edges. size = function(x, y, z) return 0.1 end: largest edge length by "
         "location. periodic = { { \"left\", \"right\" }, ... }: pairs of flat faces, each the translated image of the other; their borders get identical "
         "nodes, and volume_mesh makes them periodic\n";
}

constexpr std::string_view k_remesh_usage =
    "remesh{ wall, curvature_angle = 12*deg, max_edge = 0.4, growth = 1.2, patches = { [\"Body*\"] = { max_edge = 0.15 } } }";

/// The request of a table to remesh.
struct RemeshRequest {
  RemeshRecipe recipe;
  SurfaceRules rules;
  std::function<double(const Point&)> size;
};

RemeshRequest read_remesh(TableReader& reader, const ScriptCall& call) {
  RemeshRequest requested;
  reader.read_options(with_edge_tables(sterna::options_of(requested.recipe.options)));
  requested.rules = read_rules(reader);
  requested.recipe.patches = requested.rules.sizes;
  requested.recipe.sources = read_sources(reader, call);
  requested.size = read_size_function(reader);
  apply_overrides(call, sterna::options_of(requested.recipe.options));
  return requested;
}

SurfaceValue remesh_as_requested(const SurfaceValue& wall, const RemeshRequest& requested, const RunContext& context, const Reuse& reuse) {
  SurfaceValue made = remeshed(wall, requested.recipe, requested.size, context, reuse);
  add_layer_rules(requested.rules.layers, made);
  return made;
}

ScriptValue make_remesh(const ScriptCall& call) {
  const bool is_alone = !call.arguments.empty() && std::holds_alternative<SurfaceHandle>(call.arguments.front());
  const ScriptTable table = is_alone ? ScriptTable{.items = {call.arguments.front()}, .fields = {}, .other_keys = {}} : table_argument(call, 0, k_remesh_usage);
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  const SurfaceHandle* wall = items.size() == 1 ? std::get_if<SurfaceHandle>(&items.front()) : nullptr;
  if (wall == nullptr)
    reader.add_problem("takes one surface (from read_surface ...): " + std::string(k_remesh_usage) +
                       "; a model's faces get triangles by surface_mesh{ model }");
  const RemeshRequest requested = read_remesh(reader, call);
  reader.finish();
  return std::make_shared<const SurfaceValue>(remesh_as_requested(**wall, requested, call.session.context.part("remesh", 0.0, 1.0), call.session.reuse()));
}

std::string remesh_help() {
  surfmesh::RemeshOptions options;
  return options_help(sterna::options_of(options)) +
         "patches, sources and size as for surface_mesh. Options of patches: max_edge, min_edge, curvature_angle, chord_error, rows at leading and trailing "
         "edges (leading_edge = { chordwise = 0.004 } is leading_edge_chordwise), and those of volume_mesh\n";
}

constexpr std::array<ScriptVerb, 2> k_surface_verbs = {{
    {"remesh", k_remesh_usage,
     "Remeshes a surface by curvature and sizes, as surface_mesh does for a model. Sliver triangles are removed, sharp edges and patches are kept, a coarse "
     "surface of a smooth body becomes smooth.",
     make_remesh, remesh_help, true, "surface", false, held_options<surfmesh::RemeshOptions>},
    {"surface_mesh", k_surface_mesh_usage,
     "Meshes the faces of models with triangles, closed where the models are closed. The result is the wall for volume_mesh.", make_surface_mesh,
     surface_mesh_help, true, "surface", false, held_options<surfmesh::SurfaceMeshOptions>},
}};

}  // namespace

RemeshEntry read_remesh_entry(TableReader& reader, const ScriptCall& call) {
  const ScriptValue* value = reader.field("remesh");
  if (value == nullptr) return {};
  if (const auto* is_requested = std::get_if<bool>(value)) {
    if (!*is_requested) return {};
    return [recipe = RemeshRecipe{}](const SurfaceValue& wall, const RunContext& context, const Reuse& reuse) {
      return remeshed(wall, recipe, {}, context, reuse);
    };
  }
  const auto* table = std::get_if<TableHandle>(value);
  if (table == nullptr) {
    reader.add_problem("remesh: expected true or a table, remesh = { max_edge = 0.1 }, not " + std::string(type_text(*value)));
    return {};
  }
  const ScriptTable own_table = **table;
  TableReader own(own_table, Attempt(std::string(call.attempted()) + ", remesh", nullptr, false));
  RemeshRequest requested = read_remesh(own, call);
  own.finish();
  return [requested = std::move(requested)](const SurfaceValue& wall, const RunContext& context, const Reuse& reuse) {
    return remesh_as_requested(wall, requested, context, reuse);
  };
}

std::span<const ScriptVerb> surface_verbs() { return k_surface_verbs; }

}  // namespace sterna::scripting
