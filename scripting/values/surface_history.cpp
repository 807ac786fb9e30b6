#include "scripting/values/surface_history.h"

#include <utility>

#include "scripting/values/patch_rules.h"

namespace sterna::scripting {
namespace {

/// Entry of a list of sources that stands for a function of the script.
Json function_entry() { return {{"kind", "function"}}; }

template <class T>
void add_options_of(OptionTable& table, T* options) {
  if (!options) return;
  for (Option& option : sterna::options_of(*options)) table.push_back(std::move(option));
}

}  // namespace

std::vector<std::string> changes_of(const SurfaceHistory& history) {
  std::vector<std::string> changes;
  for (const SurfaceStep& step : history) changes.insert(changes.end(), step.changes.begin(), step.changes.end());
  return changes;
}

void inherit(SurfaceHistory& history, const SurfaceHistory& from, bool keeps_recipe) {
  for (SurfaceStep step : from) {
    if (!keeps_recipe || !std::holds_alternative<SurfaceRecipe>(step.options)) step.options = {};
    history.push_back(std::move(step));
  }
}

OptionTable history_options(SurfaceHistory& history) {
  OptionTable table;
  add_options_of(table, last_of<UnionOptions>(history));
  add_options_of(table, last_of<surfmesh::RepairOptions>(history));
  add_options_of(table, last_of<surfmesh::WrapOptions>(history));
  add_options_of(table, last_of<surfmesh::RemeshOptions>(history));
  SurfaceRecipe* const recipe = last_of<SurfaceRecipe>(history);
  add_options_of(table, recipe ? &recipe->options : nullptr);
  return table;
}

void add_rules(Json& json, const SurfaceRecipe& recipe) {
  if (!recipe.patches.empty()) json["surface_patches"] = rules_json(recipe.patches);
}

void add_recipe(Json& json, const SurfaceRecipe& recipe) {
  add_rules(json, recipe);
  if (recipe.sources.empty() && !recipe.has_function) return;
  json["surface_sources"] = values_json(recipe.sources);
  if (recipe.has_function) json["surface_sources"].push_back(function_entry());
}

void read_recipe(const Json& json, SurfaceRecipe& recipe) {
  if (json.contains("surface_patches")) recipe.patches = size_rules_of_json(json.at("surface_patches"));
  Json sources = json.value("surface_sources", Json::array());
  if (!sources.empty() && sources.back() == function_entry()) {
    recipe.has_function = true;
    sources.erase(sources.size() - 1);
  }
  recipe.sources = values_of<volmesh::SizeSource>(sources);
}

void add_changes(Json& json, const SurfaceHistory& history) {
  if (const std::vector<std::string> changes = changes_of(history); !changes.empty()) json["changes"] = changes;
  for (const SurfaceStep& step : history)
    if (!step.figures.empty()) json["changed"].push_back(Json::parse(step.figures));
}

SurfaceHistory read_changes(const Json& json) {
  SurfaceHistory history;
  if (json.contains("changes")) history.push_back({.changes = json.at("changes").get<std::vector<std::string>>()});
  for (const Json& figures : json.value("changed", Json::array()))
    if (figures.is_object()) history.push_back({.figures = figures.dump()});
  return history;
}

}  // namespace sterna::scripting
