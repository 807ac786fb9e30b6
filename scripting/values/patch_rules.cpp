#include "scripting/values/patch_rules.h"

#include <algorithm>
#include <iterator>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/typed_number.h"
#include "surfmesh/model/size_rules.h"
#include "volmesh/case/layer_rules.h"
#include "volmesh/envelope/patch_layers.h"

namespace sterna::scripting {
namespace {

/// Reads the options of one entry of `patches`; notes problems.
void read_rule(const ScriptValue& value, std::string_view example, OptionsOfRule options, TableReader& reader, Rule& rule) {
  const std::string where = "patches[\"" + rule.names + "\"]";
  const auto* table = std::get_if<TableHandle>(&value);
  if (!table || (*table)->fields.empty()) {
    reader.add_problem(where + ": expected a table with options of these patches, such as { " + std::string(example) + " }, not " +
                       std::string(table ? "a table without names" : type_text(value)));
    return;
  }
  TableReader entries(**table, where);
  entries.read_options(options(rule));
  try {
    entries.finish();
  } catch (const Error& error) {
    reader.add_problem(where + ": " + error.info().problem);
  }
}

/// Creates the rules of a list of objects that rules_json() wrote.
std::vector<Rule> rules_of_json(const Json& list, std::string_view attempted, OptionsOfRule options) {
  const auto refuse = [&] {
    throw Error(
        {.code = ErrorCode::file_malformed, .attempted = std::string(attempted), .problem = "expected a list of rules with names of patches and options"});
  };
  if (!list.is_array()) refuse();
  std::vector<Rule> rules;
  for (const Json& entry : list) {
    if (!entry.is_object() || !entry.contains("names") || !entry["names"].is_string()) refuse();
    Json values = entry;
    values.erase("names");
    for (const Json& value : values)
      if (!value.is_primitive() || value.is_null()) refuse();
    set_value_from_json(options(rules.emplace_back(Rule{.names = entry["names"].get<std::string>(), .options = {}})), values.dump(), attempted);
  }
  return rules;
}

}  // namespace

std::vector<Rule> read_patch_rules(TableReader& reader, std::string_view example, OptionsOfRule options) {
  const ScriptValue* value = reader.field("patches");
  if (!value) return {};
  const auto* table = std::get_if<TableHandle>(value);
  if (!table || !(*table)->items.empty() || !(*table)->other_keys.empty()) {
    reader.add_problem("patches: expected a table with names of patches as keys, { [\"wing*\"] = { " + std::string(example) + " } }" +
                       (table ? "; the keys are strings" : ", not " + std::string(type_text(*value))));
    return {};
  }
  std::vector<Rule> rules;
  for (const auto& [names, entry] : (*table)->fields) read_rule(entry, example, options, reader, rules.emplace_back(Rule{.names = names, .options = {}}));
  sort_by_pattern(rules);
  return rules;
}

bool is_default(const Option& option) {
  const OptionValue value = option.get();
  if (const double* number = std::get_if<double>(&value); number && is_automatic(*number)) return is_automatic(std::get<double>(option.default_value));
  return value == option.default_value;
}

OptionTable size_rule_options(Rule& rule) { return with_edge_tables(surfmesh::size_rule_options(rule)); }

OptionTable surface_and_layer_options(Rule& rule) {
  OptionTable table = size_rule_options(rule);
  for (Option& option : volmesh::layer_rule_options(rule)) table.push_back(std::move(option));
  return table;
}

std::vector<Rule> rules_of_step(std::vector<Rule> rules, OptionsOfRule options) {
  for (Rule& rule : rules) {
    const OptionTable table = options(rule);
    std::erase_if(rule.options, [&](const auto& entry) { return std::ranges::find(table, entry.first, &Option::name) == table.end(); });
  }
  return rules;
}

void keep_set_rules(std::vector<Rule>& rules) {
  std::erase_if(rules, [](const Rule& rule) { return rule.options.empty(); });
}

void add_layer_rules(const std::vector<Rule>& rules, SurfaceValue& surface) {
  volmesh::apply_patch_kinds(surface.mesh, rules);
  surface.layers.insert(surface.layers.end(), rules.begin(), rules.end());
}

std::string layer_rules_help() {
  Rule rule;
  return "patches = { [\"tunnel*\"] = { ... } }: options of patches with matching names; of two matching patterns the one with more letters applies:\n" +
         options_help(volmesh::layer_rule_options(rule));
}

std::vector<Rule> read_layer_rules(TableReader& reader) { return read_patch_rules(reader, "layers = 20, first_height = 2e-5", volmesh::layer_rule_options); }

std::vector<Rule> layer_rules_of(const std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>>& given, std::vector<Rule>* sizes) {
  std::vector<Rule> rules;
  for (const auto& [names, options] : given) {
    Rule& rule = rules.emplace_back(Rule{.names = names, .options = {}});
    const OptionTable table = sizes ? surface_and_layer_options(rule) : volmesh::layer_rule_options(rule), of_surface = size_rule_options(rule);
    const std::string attempted = "--patch \"" + names + "\"";
    for (const auto& [name, text] : options) {
      if (!sizes && std::ranges::find(table, name, &Option::name) == table.end() && std::ranges::find(of_surface, name, &Option::name) != of_surface.end())
        throw Error({.code = ErrorCode::bad_argument,
                     .attempted = attempted,
                     .problem = name + " is a size of triangles, but the triangles of a triangulation are kept",
                     .hint = "--remesh makes triangles with such sizes"});
      set_option_as_typed(find_option(table, name, attempted), text);
    }
  }
  if (sizes) {
    std::ranges::move(rules_of_step(rules, size_rule_options), std::back_inserter(*sizes));
    sort_by_pattern(*sizes);
    rules = rules_of_step(std::move(rules), volmesh::layer_rule_options);
    keep_set_rules(rules);
  }
  sort_by_pattern(rules);
  return rules;
}

Json rules_json(const std::vector<Rule>& rules) {
  Json list = Json::array();
  for (Rule rule : rules) {
    OptionTable set = surface_and_layer_options(rule);
    std::erase_if(set, is_default);
    Json entry = {{"names", rule.names}};
    entry.update(value_json(set));
    list.push_back(std::move(entry));
  }
  return list;
}

std::vector<Rule> size_rules_of_json(const Json& list) { return rules_of_json(list, "reading the options of a surface mesh", size_rule_options); }

std::vector<Rule> layer_rules_of_json(const Json& list) {
  return rules_of_json(list, "reading the rules for patches of a volume mesh", volmesh::layer_rule_options);
}

}  // namespace sterna::scripting
