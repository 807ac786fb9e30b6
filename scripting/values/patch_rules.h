// Rules for patches by patterns of their names, for any step. They are read from tables of scripts, and converted from and to JSON. A rule is a struct with a
// Schema whose member `names` is the pattern. Options that are not set keep their default.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/schema.h"
#include "scripting/lua/table_reader.h"
#include "scripting/values/option_json.h"
#include "scripting/values/verbs.h"
#include "volmesh/case/patch_rule.h"

namespace sterna::scripting {

/// Creates the rule for a pattern; its options are set before the next rule is created.
using AddRule = std::function<OptionTable(const std::string& names)>;

/// Reads patches = { ["wing*"] = { max_edge = 0.1 } }, with one rule for each entry, in no particular order. Notes problems. `example` shows the possible
/// content of an entry.
void read_patch_rules(TableReader& reader, std::string_view example, const AddRule& add);

/// Returns true if an option has its default value.
bool is_default(const Option& option);
/// Returns the options of one entry of patches = { ["tunnel*"] = { layers = 20 } } of volume_mesh. `rule` must outlive the table.
OptionTable patch_rule_options(volmesh::PatchRule& rule);
/// Returns the options of one entry of `patches` of surface_mesh: sizes of triangles, and layer options for volume_mesh. The arguments must outlive the table.
OptionTable surface_and_layer_options(surfmesh::PatchSurfaceOptions& sizes, volmesh::PatchRule& layers);
/// Removes the rules that set no option.
void keep_set_rules(std::vector<volmesh::PatchRule>& rules);
/// Appends the rules to those of the surface, and gives its patches their kinds.
/// \throws Error(bad_argument) for names that no patch has
void add_layer_rules(const std::vector<volmesh::PatchRule>& rules, SurfaceValue& surface);
/// Returns several lines for help(): the options of entries of `patches` of volume_mesh.
std::string layer_rules_help();
/// Returns the rules of a script for volume_mesh, sorted.
std::vector<volmesh::PatchRule> read_layer_rules(TableReader& reader);
/// Returns the rules of the command line, sorted. \p given has patterns, and options with their values. Options of the surface go to `sizes` if it is not null;
/// otherwise they are unknown options.
/// \throws Error(bad_argument, unknown_option)
std::vector<volmesh::PatchRule> layer_rules_of(const std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>>& given,
                                               std::vector<surfmesh::PatchSurfaceOptions>* sizes = nullptr);

/// Returns an object with `names` and the options that are not at their default.
Json rule_json(const std::string& names, const OptionTable& options);
/// Creates the rules of a list of such objects.
/// \throws Error(file_malformed, bad_argument, unknown_option)
void read_rules_json(const Json& list, std::string_view attempted, const AddRule& add);

/// layer_rules_json returns the rules of volume_mesh, for manifests; the second function reads them.
Json layer_rules_json(const std::vector<volmesh::PatchRule>& rules);
std::vector<volmesh::PatchRule> layer_rules_of_json(const Json& list);

}  // namespace sterna::scripting
