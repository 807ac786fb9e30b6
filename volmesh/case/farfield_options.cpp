#include "volmesh/case/farfield_options.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/number_with_unit.h"

namespace sterna::volmesh {
namespace {

constexpr std::array k_kinds = {PatchKind::wall,    PatchKind::slip,     PatchKind::symmetry, PatchKind::inflow,
                                PatchKind::outflow, PatchKind::farfield, PatchKind::interface};
constexpr const char* k_sides_attempt = "farfield_sides";

[[noreturn]] void refuse(const std::string& problem) {
  throw Error(
      {.code = ErrorCode::bad_argument, .attempted = k_sides_attempt, .problem = problem, .hint = "such as \"x_min=inflow x_max=outflow,name:exit,edge:0.5\""});
}

SideRule parse_side(const std::string& entry) {
  const std::size_t equals = entry.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == entry.size()) refuse("it is not SIDE=KIND,name:NAME,edge:LENGTH");
  SideRule rule{.side = entry.substr(0, equals), .name = {}};
  std::istringstream parts(entry.substr(equals + 1));
  for (std::string part; std::getline(parts, part, ',');) {
    if (part.starts_with("name:") && part.size() > 5) {
      rule.name = part.substr(5);
    } else if (part.starts_with("edge:")) {
      rule.edge = parse_number_with_unit(part.substr(5), Unit::metre, BareAngle::degrees);
      if (!(rule.edge > 0.0)) refuse("the edge length must be above zero");
    } else {
      rule.kind = patch_kind_of(part, k_sides_attempt);
      rule.has_kind = true;
    }
  }
  return rule;
}

/// Adds an entry to the rules.
void add_side(const std::string& entry, std::vector<SideRule>& rules) {
  SideRule rule = parse_side(entry);
  if (std::ranges::find(rules, rule.side, &SideRule::side) != rules.end()) refuse("the side is given twice");
  rules.push_back(std::move(rule));
}

}  // namespace

PatchKind patch_kind_of(const std::string& name, const std::string& attempted) {
  std::string names;
  for (const PatchKind kind : k_kinds) {
    if (to_string(kind) == name) return kind;
    names += (names.empty() ? "" : ", ") + std::string(to_string(kind));
  }
  throw Error(
      {.code = ErrorCode::bad_argument, .attempted = attempted, .problem = "\"" + name + "\" is not a patch kind", .hint = "the patch kinds are " + names});
}

std::vector<SideRule> parse_sides(const std::string& text) {
  std::vector<SideRule> rules;
  std::istringstream words(text);
  for (std::string entry; words >> entry;) {
    try {
      add_side(entry, rules);
    } catch (const Error& error) {
      ErrorInfo info = error.info();
      info.attempted = k_sides_attempt;
      info.problem = "\"" + entry + "\": " + info.problem;
      throw Error(std::move(info));
    }
  }
  return rules;
}

std::string sides_text(const std::vector<SideRule>& rules) {
  std::string text;
  for (const SideRule& rule : rules) {
    text += (text.empty() ? "" : " ") + rule.side + "=";
    std::string values = rule.has_kind ? std::string(to_string(rule.kind)) : "";
    if (!rule.name.empty()) values += (values.empty() ? "name:" : ",name:") + rule.name;
    if (!is_automatic(rule.edge)) values += (values.empty() ? "edge:" : ",edge:") + exact_text(rule.edge);
    text += values;
  }
  return text;
}

}  // namespace sterna::volmesh
