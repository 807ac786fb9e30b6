#include "scripting/verbs/surface_verbs.h"

#include <array>
#include <functional>

#include "geom/base/glob.h"
#include "scripting/lua/script_function.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/patch_rules.h"
#include "scripting/verbs/source_verbs.h"
#include "volmesh/envelope/patch_layers.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_surface_mesh_usage =
    "surface_mesh{ model, max_edge = 0.4, curvature_angle = 12*deg, growth = 1.2, patches = { [\"Body*\"] = { max_edge = 0.15 } } }";

/// What patches ask for: of their triangles, and of the layers that volume_mesh puts on them.
struct SurfaceRules {
  std::vector<surfmesh::PatchSurfaceOptions> sizes;
  std::vector<volmesh::PatchRule> layers;
};

SurfaceRules read_rules(TableReader& reader) {
  SurfaceRules rules;
  read_patch_rules(reader, "max_edge = 0.1", [&](const std::string& names) {
    rules.sizes.push_back({.names = names});
    rules.layers.push_back({.names = names});
    return surface_and_layer_options(rules.sizes.back(), rules.layers.back());
  });
  keep_set_rules(rules.layers);
  sort_by_pattern(rules.sizes);
  sort_by_pattern(rules.layers);
  return rules;
}

/// size = function(x, y, z) return 0.1 + 0.05*x end
std::function<double(const Point&)> read_size_function(TableReader& reader) {
  const ScriptValue* value = reader.field("size");
  if (value == nullptr) return {};
  const auto* function = std::get_if<FunctionHandle>(value);
  if (function == nullptr) {
    reader.add_problem("size: expected a function of x, y, z that returns the length of edges there in metres, not " + std::string(type_text(*value)) +
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
  const OptionTable schema = with_edge_tables(sterna::options_of(recipe.options));
  TableReader reader(table, call.attempted());
  std::vector<ModelHandle> models;
  const std::vector<ScriptValue>& items = reader.items();
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (ModelHandle model = model_of(items[i], call)) models.push_back(std::move(model));
    else
      reader.add_problem("entry " + std::to_string(i + 1) + ": expected a model (from read_cad, aircraft ...) or a component, not " +
                         std::string(type_text(items[i])) +
                         (std::holds_alternative<SurfaceHandle>(items[i]) ? ", which is made of triangles already: volume_mesh takes it" : ""));
  }
  if (items.empty()) reader.add_problem("needs a model: " + std::string(k_surface_mesh_usage));
  reader.read_options(schema);
  SurfaceRules rules = read_rules(reader);
  recipe.patches = std::move(rules.sizes);
  recipe.sources = read_sources(reader, call);
  const std::function<double(const Point&)> size = read_size_function(reader);
  apply_overrides(call, sterna::options_of(recipe.options));
  reader.finish();
  auto surface = std::make_shared<SurfaceValue>(mesh_models(models, recipe, size, call.session.context.part("surface_mesh", 0.0, 1.0), call.session.reuse()));
  add_layer_rules(rules.layers, *surface);
  return std::shared_ptr<const SurfaceValue>(std::move(surface));
}

std::string surface_mesh_help() {
  surfmesh::SurfaceMeshOptions options;
  surfmesh::PatchSurfaceOptions rule;
  volmesh::PatchRule layers;
  return options_help(sterna::options_of(options)) +
         "patches = { [\"wing*\"] = { ... } }, of faces with such names; of two patterns that match the one with more letters counts:\n" +
         options_help(surface_and_layer_options(rule, layers)) +
         "sources = { line{ {0,0,0}, {8,0,0}, size = 0.02 }, ... }: shorter edges there. size = function(x, y, z) return 0.1 end: edges at most that long\n";
}

constexpr std::array<ScriptVerb, 1> k_surface_verbs = {{
    {"surface_mesh", k_surface_mesh_usage, "Triangles on the faces of models, closed where the models are: the wall that volume_mesh takes.", make_surface_mesh,
     surface_mesh_help, true, "surface"},
}};

}  // namespace

std::span<const ScriptVerb> surface_verbs() { return k_surface_verbs; }

}  // namespace sterna::scripting
