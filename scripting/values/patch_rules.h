// Rules for patches by patterns of their names, for any step. They are read from tables of scripts, and converted from and to JSON.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/base/rules.h"
#include "scripting/lua/table_reader.h"
#include "scripting/values/option_json.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Returns the options that a rule may set for a step; the rule must outlive the table: volmesh::layer_rule_options(), or one of the functions below.
using OptionsOfRule = OptionTable (*)(Rule&);

/// Returns the options of one entry of patches = { ["wing*"] = { max_edge = 0.1 } } that set sizes of triangles.
OptionTable size_rule_options(Rule& rule);
/// Returns the options of one entry of `patches` of surface_mesh: sizes of triangles, and layer options for volume_mesh.
OptionTable surface_and_layer_options(Rule& rule);

/// Returns the rules of patches = { ["wing*"] = { max_edge = 0.1 } }, one for each entry, sorted. Notes problems. `example` shows the possible content of an
/// entry.
std::vector<Rule> read_patch_rules(TableReader& reader, std::string_view example, OptionsOfRule options);
/// Returns the rules with their options of one step only.
std::vector<Rule> rules_of_step(std::vector<Rule> rules, OptionsOfRule options);

/// Returns true if an option has its default value.
bool is_default(const Option& option);
/// Removes the rules that set no option.
void keep_set_rules(std::vector<Rule>& rules);
/// Appends the rules to those of the surface, and gives its patches their kinds.
/// \throws Error(bad_argument) for names that no patch has
void add_layer_rules(const std::vector<Rule>& rules, SurfaceValue& surface);
/// Returns several lines for help(): the options of entries of `patches` of volume_mesh.
std::string layer_rules_help();
/// Returns the rules of a script for volume_mesh, sorted.
std::vector<Rule> read_layer_rules(TableReader& reader);
/// Returns the rules of the command line, sorted. \p given has patterns, and options with their values. Options of the surface go to `sizes` if it is not null;
/// otherwise they are unknown options.
/// \throws Error(bad_argument, unknown_option)
std::vector<Rule> layer_rules_of(const std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>>& given,
                                 std::vector<Rule>* sizes = nullptr);

/// Returns a list of objects with `names` and the options that each rule sets, for manifests. The other functions read the list of a step.
/// \throws Error(file_malformed, bad_argument, unknown_option)
Json rules_json(const std::vector<Rule>& rules);
std::vector<Rule> size_rules_of_json(const Json& list);
std::vector<Rule> layer_rules_of_json(const Json& list);

}  // namespace sterna::scripting
