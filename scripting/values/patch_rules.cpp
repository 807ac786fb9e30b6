#include "scripting/values/patch_rules.h"

#include <algorithm>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/typed_number.h"
#include "volmesh/envelope/patch_layers.h"

namespace sterna::scripting {
namespace {

/// Reads one entry of `patches`; notes problems.
void read_rule(const std::string& names, const ScriptValue& value, std::string_view example, TableReader& reader, const AddRule& add) {
  const std::string where = "patches[\"" + names + "\"]";
  const auto* table = std::get_if<TableHandle>(&value);
  if (!table || (*table)->fields.empty()) {
    reader.add_problem(where + ": expected a table with options of these patches, such as { " + std::string(example) + " }, not " +
                       std::string(table ? "a table without names" : type_text(value)));
    return;
  }
  const OptionTable schema = add(names);
  TableReader entries(**table, where);
  entries.read_options(schema);
  try {
    entries.finish();
  } catch (const Error& error) {
    reader.add_problem(where + ": " + error.info().problem);
  }
}

}  // namespace

void read_patch_rules(TableReader& reader, std::string_view example, const AddRule& add) {
  const ScriptValue* value = reader.field("patches");
  if (!value) return;
  const auto* table = std::get_if<TableHandle>(value);
  if (!table || !(*table)->items.empty() || !(*table)->other_keys.empty()) {
    reader.add_problem("patches: expected a table with names of patches as keys, { [\"wing*\"] = { " + std::string(example) + " } }" +
                       (table ? "; the keys are strings" : ", not " + std::string(type_text(*value))));
    return;
  }
  for (const auto& [names, entry] : (*table)->fields) read_rule(names, entry, example, reader, add);
}

bool is_default(const Option& option) {
  const OptionValue value = option.get();
  if (const double* number = std::get_if<double>(&value); number && is_automatic(*number)) return is_automatic(std::get<double>(option.default_value));
  return value == option.default_value;
}

OptionTable patch_rule_options(volmesh::PatchRule& rule) {
  OptionTable table = sterna::options_of(rule);
  std::erase_if(table, [](const Option& option) { return option.name == "names"; });  // the key of the entry
  return table;
}

OptionTable surface_and_layer_options(surfmesh::PatchSurfaceOptions& sizes, volmesh::PatchRule& layers) {
  OptionTable table = patch_rule_options(sizes);
  for (Option& option : patch_rule_options(layers)) table.push_back(std::move(option));
  return table;
}

void keep_set_rules(std::vector<volmesh::PatchRule>& rules) {
  std::erase_if(rules, [](volmesh::PatchRule& rule) { return std::ranges::all_of(patch_rule_options(rule), is_default); });
}

void add_layer_rules(const std::vector<volmesh::PatchRule>& rules, SurfaceValue& surface) {
  volmesh::apply_patch_kinds(surface.mesh, rules);
  surface.layers.insert(surface.layers.end(), rules.begin(), rules.end());
}

std::string layer_rules_help() {
  volmesh::PatchRule rule;
  return "patches = { [\"tunnel*\"] = { ... } }: options of patches with matching names; of two matching patterns the one with more letters applies:\n" +
         options_help(patch_rule_options(rule));
}

std::vector<volmesh::PatchRule> read_layer_rules(TableReader& reader) {
  std::vector<volmesh::PatchRule> rules;
  read_patch_rules(reader, "layers = 20, first_height = 2e-5", [&](const std::string& names) {
    rules.push_back({.names = names});
    return patch_rule_options(rules.back());
  });
  sort_by_pattern(rules);
  return rules;
}

std::vector<volmesh::PatchRule> layer_rules_of(const std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>>& given,
                                               std::vector<surfmesh::PatchSurfaceOptions>* sizes) {
  std::vector<volmesh::PatchRule> rules;
  for (const auto& [names, options] : given) {
    rules.push_back({.names = names});
    surfmesh::PatchSurfaceOptions size{.names = names};
    if (sizes) sizes->push_back(size);
    const OptionTable table = sizes ? surface_and_layer_options(sizes->back(), rules.back()) : patch_rule_options(rules.back());
    const std::string attempted = "--patch \"" + names + "\"";
    for (const auto& [name, text] : options) {
      if (const OptionTable of_surface = patch_rule_options(size);
          !sizes && std::ranges::find(table, name, &Option::name) == table.end() && std::ranges::find(of_surface, name, &Option::name) != of_surface.end())
        throw Error({.code = ErrorCode::bad_argument,
                     .attempted = attempted,
                     .problem = name + " is a size of triangles, but the triangles of a triangulation are kept",
                     .hint = "--remesh makes triangles with such sizes"});
      set_option_as_typed(find_option(table, name, attempted), text);
    }
  }
  if (sizes) {
    keep_set_rules(rules);
    sort_by_pattern(*sizes);
  }
  sort_by_pattern(rules);
  return rules;
}

Json rule_json(const std::string& names, const OptionTable& options) {
  OptionTable changed = options;
  std::erase_if(changed, is_default);
  Json entry = {{"names", names}};
  entry.update(Json::parse(value_to_json(changed)));
  return entry;
}

void read_rules_json(const Json& list, std::string_view attempted, const AddRule& add) {
  const auto refuse = [&] {
    throw Error(
        {.code = ErrorCode::file_malformed, .attempted = std::string(attempted), .problem = "expected a list of rules with names of patches and options"});
  };
  if (!list.is_array()) refuse();
  for (const Json& entry : list) {
    if (!entry.is_object() || !entry.contains("names") || !entry["names"].is_string()) refuse();
    Json values = entry;
    values.erase("names");
    for (const Json& value : values)
      if (!value.is_primitive() || value.is_null()) refuse();
    set_value_from_json(add(entry["names"].get<std::string>()), values.dump(), attempted);
  }
}

Json layer_rules_json(const std::vector<volmesh::PatchRule>& rules) {
  Json list = Json::array();
  for (volmesh::PatchRule rule : rules) list.push_back(rule_json(rule.names, patch_rule_options(rule)));
  return list;
}

std::vector<volmesh::PatchRule> layer_rules_of_json(const Json& list) {
  std::vector<volmesh::PatchRule> rules;
  read_rules_json(list, "reading the rules for patches of a volume mesh", [&](const std::string& names) {
    rules.push_back({.names = names});
    return patch_rule_options(rules.back());
  });
  return rules;
}

}  // namespace sterna::scripting
