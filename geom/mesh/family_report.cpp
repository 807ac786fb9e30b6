#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "geom/base/print_text.h"

#include "geom/mesh/family.h"

namespace sterna {
namespace {

using Json = nlohmann::ordered_json;

std::string number_or_dash(const std::optional<double>& value) { return value ? print_text("%.4g", *value) : "-"; }

std::string members_text(const std::vector<FamilyMember>& members) {
  std::string text = print_text("  %-28s %10s %9s %11s %7s %11s %7s %7s\n", "member", "nodes", "walls", "wall edge", "layers", "first", "growth", "tets");
  for (const FamilyMember& m : members)
    text +=
        print_text("  %-28s %10lld %9lld %11.5g %7s %11s %7s %7s\n", m.name.c_str(), static_cast<long long>(m.nodes), static_cast<long long>(m.wall_faces),
                   m.wall_edge, m.layers ? std::to_string(*m.layers).c_str() : "-", number_or_dash(m.first_height ? m.first_height : m.measured_first).c_str(),
                   number_or_dash(m.growth ? m.growth : m.measured_growth).c_str(), number_or_dash(m.tet_growth).c_str());
  return text;
}

std::string rule_text(const FamilyRule& rule) {
  const std::string head = print_text("    %-44s ", rule.title.c_str());
  if (rule.state == GateState::not_checked) return head + "not checked: " + rule.reason + "\n";
  std::string text = head + print_text("%-5s %.5g -> %.5g", std::string(to_string(rule.state)).c_str(), rule.coarse, rule.fine);
  if (rule.tolerance > 0.0)
    text += print_text(": %.5g, expected %.5g, off by %.2g (tolerance %.2g)", rule.value, rule.expected, rule.deviation, rule.tolerance);
  if (!rule.reason.empty()) text += ": " + rule.reason;
  return text + "\n";
}

Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <class T>
Json optional_json(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json member_json(const FamilyMember& m) {
  Json json = {{"name", m.name},
               {"nodes", m.nodes},
               {"wall_faces", m.wall_faces},
               {"wall_edge", m.wall_edge},
               {"box", {{"min", {m.box.min.x, m.box.min.y, m.box.min.z}}, {"max", {m.box.max.x, m.box.max.y, m.box.max.z}}}},
               {"layers", optional_json(m.layers)},
               {"first_height", optional_json(m.first_height)},
               {"measured_first", optional_json(m.measured_first)},
               {"growth", optional_json(m.growth)},
               {"measured_growth", optional_json(m.measured_growth)},
               {"constant_layers", optional_json(m.constant_layers)},
               {"tet_growth", optional_json(m.tet_growth)},
               {"refinement", optional_json(m.refinement)}};
  json["patches"] = Json::array();
  for (const auto& [name, kind] : m.patches) json["patches"].push_back({{"name", name}, {"kind", kind}});
  return json;
}

Json rule_json(const FamilyRule& rule) {
  Json json = {{"rule", rule.name}, {"title", rule.title}, {"state", rule.state == GateState::fail ? "fail" : to_string(rule.state)}};
  if (!rule.reason.empty()) json["reason"] = rule.reason;
  if (rule.state == GateState::not_checked) return json;
  json.update({{"coarse", rule.coarse},
               {"fine", rule.fine},
               {"value", json_number(rule.value)},
               {"expected", json_number(rule.expected)},
               {"deviation", json_number(rule.deviation)},
               {"tolerance", rule.tolerance}});
  return json;
}

}  // namespace

std::string to_text(const FamilyReport& report) {
  std::string text =
      "family of " + std::to_string(report.members.size()) + " meshes: " + std::string(to_string(report.state())) + "\n" + members_text(report.members);
  for (const FamilyStep& step : report.steps) {
    text += "  " + step.coarse + " -> " + step.fine + print_text(": factor %.4g by ", step.factor) + step.factor_from +
            print_text("; by nodes %.4g", step.factor_by_nodes);
    if (step.factor_by_edges > 0.0) text += print_text(", by mean wall edges %.4g", step.factor_by_edges);
    text += "\n";
    for (const FamilyRule& rule : step.rules) text += rule_text(rule);
  }
  return text;
}

std::string to_json(const FamilyReport& report) {
  Json json = {{"schema", "sterna-family-1"},
               {"state", report.state() == GateState::fail ? "fail" : to_string(report.state())},
               {"members", Json::array()},
               {"steps", Json::array()}};
  for (const FamilyMember& member : report.members) json["members"].push_back(member_json(member));
  for (const FamilyStep& step : report.steps) {
    Json entry = {{"coarse", step.coarse},
                  {"fine", step.fine},
                  {"factor", step.factor},
                  {"factor_from", step.factor_from},
                  {"factor_by_nodes", step.factor_by_nodes},
                  {"factor_by_edges", step.factor_by_edges > 0.0 ? Json(step.factor_by_edges) : Json(nullptr)},
                  {"rules", Json::array()}};
    for (const FamilyRule& rule : step.rules) entry["rules"].push_back(rule_json(rule));
    json["steps"].push_back(std::move(entry));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace sterna
