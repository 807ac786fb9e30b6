#include "volmesh/case/layer_rules.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {
namespace {

constexpr std::string_view k_all_walls = "value for all walls";
constexpr std::array k_layer_rule_options = {
    RuleOption{.name = "kind"},
    RuleOption{.name = "layers", .help = "number of prism layers; connected walls get the largest requested number; 0: none; -1: value for all walls"},
    RuleOption{.name = "first_height", .help = "height of the first cell at the wall", .automatic = k_all_walls},
    RuleOption{.name = "max_growth", .help = "largest ratio of heights of consecutive layers", .automatic = k_all_walls},
    RuleOption{
        .name = "total_height", .help = "total height of the layers; max_growth follows, or layers if max_growth is given here", .automatic = k_all_walls},
    RuleOption{.name = "max_thickness", .automatic = k_all_walls},
    RuleOption{.name = "blend", .automatic = "3 times the height of the taller layer, at least 8 edges"},
    RuleOption{.name = "open_ridges",
               .help = "whether layers get several normals along sharp convex edges between such patches; as_all: value of the ridges options",
               .choices = "as_all never always"},
    RuleOption{.name = "truncate",
               .help = "whether growth lines below full height get fewer layers; as_all: value of the prisms options",
               .choices = "as_all never auto always"},
};

/// Returns true if the choices of a rule are "as_all" and those of the option for all patches.
template <class Options>
constexpr bool repeats_choices(std::string_view name) {
  constexpr std::string_view k_all = "as_all ";
  const auto rule = std::ranges::find(k_layer_rule_options, name, &RuleOption::name);
  const auto field = std::ranges::find(Schema<Options>::fields, name, &Field<Options>::name);
  return rule->choices.starts_with(k_all) && rule->choices.substr(k_all.size()) == field->choices;
}
static_assert(repeats_choices<RidgeOptions>("open_ridges") && repeats_choices<PrismOptions>("truncate"));

}  // namespace

OptionTable layer_rule_options(Rule& rule) {
  PatchOptions patch;
  MeshOptions of_all;
  OptionTable known = sterna::options_of(patch);
  std::ranges::move(options_of(of_all), std::back_inserter(known));
  return sterna::options_of(rule, k_layer_rule_options, known);
}

Patch with_kind(Patch patch, std::span<const Rule> rules) {
  if (const Rule* rule = rule_for(patch.name, rules, "kind"))
    patch.kind = patch_kind_of(value_or(*rule, "kind", std::string()), "setting the kinds of patches");
  return patch;
}

}  // namespace sterna::volmesh
