// Rules for patches by patterns of their names, of whatever step: from tables of scripts, from and to JSON. A rule is a struct with a Schema whose member
// `names` is the pattern; what it does not set keeps its default.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/schema.h"
#include "scripting/lua/table_reader.h"
#include "scripting/values/verbs.h"
#include "volmesh/case/patch_rule.h"

namespace sterna::scripting {

/// Makes the rule for a pattern; its options are set before the next one is made.
using AddRule = std::function<OptionTable(const std::string& names)>;

/// patches = { ["wing*"] = { max_edge = 0.1 } }: one rule for each entry, in no particular order. Notes problems. `example` is what an entry may say.
void read_patch_rules(TableReader& reader, std::string_view example, const AddRule& add);

/// Whether an option has the value that it has unless it is set.
bool is_default(const Option& option);
/// What one entry of patches = { ["tunnel*"] = { layers = 20 } } of volume_mesh takes. `rule` must outlive the table.
OptionTable patch_rule_options(volmesh::PatchRule& rule);
/// What one entry of `patches` of surface_mesh takes: sizes of triangles, and what volume_mesh is to put on them. The arguments must outlive the table.
OptionTable surface_and_layer_options(surfmesh::PatchSurfaceOptions& sizes, volmesh::PatchRule& layers);
/// Leaves those that ask for something.
void keep_set_rules(std::vector<volmesh::PatchRule>& rules);
/// Adds the rules behind those that the surface has, and gives its patches their kinds.
/// \throws Error(bad_argument) for names that no patch has
void add_layer_rules(const std::vector<volmesh::PatchRule>& rules, SurfaceValue& surface);
/// Several lines for help(): what entries of `patches` of volume_mesh take.
std::string layer_rules_help();
/// Rules of a script for volume_mesh, sorted.
std::vector<volmesh::PatchRule> read_layer_rules(TableReader& reader);
/// Rules of the command line: pattern, options with their values; sorted. Those of the surface go to `sizes` where it is not null, else they are unknown.
/// \throws Error(bad_argument, unknown_option)
std::vector<volmesh::PatchRule> layer_rules_of(const std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>>& given,
                                               std::vector<surfmesh::PatchSurfaceOptions>* sizes = nullptr);

/// An object with `names` and the options that are not at their default.
std::string rule_json(const std::string& names, const OptionTable& options);
/// Makes the rules of a list of such objects.
/// \throws Error(file_malformed, bad_argument, unknown_option)
void read_rules_json(const std::string& list, std::string_view attempted, const AddRule& add);

/// Of volume_mesh, for manifests; and back.
std::string layer_rules_json(const std::vector<volmesh::PatchRule>& rules);
std::vector<volmesh::PatchRule> layer_rules_of_json(const std::string& text);

}  // namespace sterna::scripting
