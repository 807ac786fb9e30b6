#include "volmesh/case/farfield_options.h"

#include <array>
#include <cstdio>
#include <sstream>

#include "geom/base/error.h"
#include "geom/base/number_with_unit.h"

namespace sterna::volmesh {
namespace {

constexpr std::array k_kinds = {PatchKind::wall,    PatchKind::slip,     PatchKind::symmetry, PatchKind::inflow,
                                PatchKind::outflow, PatchKind::farfield, PatchKind::interface};
constexpr const char* k_sides_attempt = "farfield_sides";

[[noreturn]] void refuse(const std::string& entry, const std::string& problem) {
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = k_sides_attempt,
               .problem = "\"" + entry + "\": " + problem,
               .hint = "such as \"x_min=inflow x_max=outflow,name:exit,edge:0.5\""});
}

SideRule parse_side(const std::string& entry) {
  const std::size_t equals = entry.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == entry.size()) refuse(entry, "is not SIDE=KIND,name:NAME,edge:LENGTH");
  SideRule rule{.side = entry.substr(0, equals), .name = {}};
  std::istringstream parts(entry.substr(equals + 1));
  for (std::string part; std::getline(parts, part, ',');) {
    if (part.starts_with("name:") && part.size() > 5) {
      rule.name = part.substr(5);
    } else if (part.starts_with("edge:")) {
      rule.edge = parse_number_with_unit(part.substr(5), Unit::metre, BareAngle::degrees);
      if (!(rule.edge > 0.0)) refuse(entry, "the edge length must be above zero");
    } else {
      rule.kind = patch_kind_of(part, std::string(k_sides_attempt) + ": \"" + entry + "\"");
      rule.has_kind = true;
    }
  }
  return rule;
}

std::string exact_number_text(double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
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
    rules.push_back(parse_side(entry));
    for (std::size_t i = 0; i + 1 < rules.size(); ++i)
      if (rules[i].side == rules.back().side) refuse(entry, "the side is given twice");
  }
  return rules;
}

std::string sides_text(const std::vector<SideRule>& rules) {
  std::string text;
  for (const SideRule& rule : rules) {
    text += (text.empty() ? "" : " ") + rule.side + "=";
    std::string values = rule.has_kind ? std::string(to_string(rule.kind)) : "";
    if (!rule.name.empty()) values += (values.empty() ? "name:" : ",name:") + rule.name;
    if (!is_automatic(rule.edge)) values += (values.empty() ? "edge:" : ",edge:") + exact_number_text(rule.edge);
    text += values;
  }
  return text;
}

}  // namespace sterna::volmesh
