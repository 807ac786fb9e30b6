#include "volmesh/case/ignored_requests.h"

#include <algorithm>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/base/number_text.h"

namespace sterna::volmesh {
namespace {

const PatchRule k_nothing;

std::string joined(const std::vector<std::string>& texts, const char* between) {
  std::string text;
  for (const std::string& part : texts) text += (text.empty() ? "" : between) + part;
  return text;
}

/// What the rule requests of a layer, as the user writes it; empty where it requests none.
std::vector<std::string> layer_requests(const PatchRule& rule) {
  std::vector<std::string> requests;
  const auto add = [&](const char* name, const std::string& value) { requests.push_back(std::string(name) + " = " + value); };
  const auto add_length = [&](const char* name, double value) {
    if (!is_automatic(value)) add(name, number_text(value));
  };
  if (rule.layers > 0) add("layers", std::to_string(rule.layers));
  add_length("first_height", rule.first_height);
  add_length("max_growth", rule.max_growth);
  add_length("total_height", rule.total_height);
  add_length("max_thickness", rule.max_thickness);
  add_length("blend", rule.blend);
  if (rule.open_ridges == "always") add("open_ridges", "\"always\"");
  if (rule.truncate == "auto" || rule.truncate == "always") add("truncate", '"' + rule.truncate + '"');
  return requests;
}

/// Whether the rule takes the layers of its patches away, whatever others request.
bool ends_layers(const PatchRule& rule) { return rule.layers == 0 || (rule.kind != k_nothing.kind && rule.kind != "wall"); }

/// Whether the rule was made for a placed part, by its length, and not by the user.
bool is_of_part(const PatchRule& rule, std::size_t n_requests, const MeshCase& options) {
  return !options.parts.empty() && n_requests == 1 && !is_automatic(rule.max_thickness);
}

/// A rule and the patches that have names like it.
struct RuleUse {
  std::vector<std::string> without;  ///< names of its patches without layers, each with the reason
  bool is_used = false;              ///< a patch with layers has it
  bool is_replaced = true;           ///< a later rule takes the layers of all others away
  bool is_no_wall = false;           ///< a patch is of another kind than wall
};

RuleUse use_of(std::size_t i, const Column<PatchId, Patch>& patches, const Column<PatchId, std::uint8_t>& has_layer, std::span<const PatchRule> rules) {
  RuleUse use;
  for (const PatchId p : patches.ids()) {
    const Patch& patch = patches[p];
    if (!matches_glob(patch.name, rules[i].names)) continue;
    if (has_layer[p] != 0) {
      use.is_used = true;
      continue;
    }
    const bool is_later = std::any_of(rules.begin() + static_cast<std::ptrdiff_t>(i) + 1, rules.end(),
                                      [&](const PatchRule& later) { return ends_layers(later) && matches_glob(patch.name, later.names); });
    use.is_replaced = use.is_replaced && is_later && !ends_layers(rules[i]);
    const bool is_wall = patch.kind == PatchKind::wall;
    use.is_no_wall = use.is_no_wall || !is_wall;
    use.without.push_back("\"" + patch.name + "\" (" + (is_wall ? "no layers are requested there" : "of kind " + std::string(to_string(patch.kind))) + ")");
  }
  return use;
}

/// Options of all walls that no patch with layers uses.
void warn_of_unused_options(const Column<PatchId, Patch>& patches, const Column<PatchId, std::uint8_t>& has_layer, const MeshCase& options,
                            const RunContext& context) {
  const EnvelopeOptions& all = options.envelope;
  const auto is_used = [&](double PatchRule::*member) {
    for (const PatchId p : patches.ids()) {
      const auto replaces = [&](const PatchRule& rule) { return !is_automatic(rule.*member) && matches_glob(patches[p].name, rule.names); };
      if (has_layer[p] != 0 && std::ranges::none_of(options.patches, replaces)) return true;
    }
    return false;
  };
  const bool has_layers = std::ranges::find(has_layer.raw(), 1) != has_layer.raw().end();
  const std::string why = has_layers ? "the rules of patches give it for each patch with layers; leave one of them out" : "no patch carries layers";
  const auto warn_unless_used = [&](const char* name, double value, double PatchRule::*member) {
    if (!is_automatic(value) && !is_used(member)) context.warn(std::string(name) + " = " + number_text(value) + " of all walls has no effect: " + why);
  };
  if (!options.first_heights) warn_unless_used("first_height", all.first_height, &PatchRule::first_height);
  warn_unless_used("total_height", all.total_height, &PatchRule::total_height);
  warn_unless_used("max_thickness", all.max_thickness, &PatchRule::max_thickness);
}

}  // namespace

void require_used_requests(const Column<PatchId, Patch>& patches, const Column<PatchId, std::uint8_t>& has_layer, const MeshCase& options,
                           const RunContext& context) {
  std::vector<std::string> problems;
  bool is_no_wall = false;
  for (std::size_t i = 0; i < options.patches.size(); ++i) {
    const std::vector<std::string> requests = layer_requests(options.patches[i]);
    if (requests.empty() || is_of_part(options.patches[i], requests.size(), options)) continue;
    const RuleUse use = use_of(i, patches, has_layer, options.patches);
    if (use.is_used || use.without.empty() || use.is_replaced) continue;
    is_no_wall = is_no_wall || use.is_no_wall;
    problems.push_back("patches[\"" + options.patches[i].names + "\"] requests " + joined(requests, ", ") +
                       ", but its patches carry no layers: " + joined(use.without, ", "));
  }
  if (!problems.empty())
    throw_bad_argument("setting the layers of patches", joined(problems, "; "), {},
                       is_no_wall ? "only walls carry layers: add kind = \"wall\" to the rule, or leave its layer options out"
                                  : "give these patches layers = 1 or more, or leave the other layer options out");
  warn_of_unused_options(patches, has_layer, options, context);
}

}  // namespace sterna::volmesh
