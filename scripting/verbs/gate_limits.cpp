#include "scripting/verbs/gate_limits.h"

#include <cmath>
#include <limits>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/schema.h"
#include "scripting/values/typed_number.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_example = "gates = { orthogonality = { hard = 3*deg, target = 15*deg }, face_weight = false }";
constexpr double k_no_limit = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> measure_names() {
  std::vector<std::string> names;
  for (const MeasureInfo& info : measures()) names.emplace_back(info.name);
  return names;
}

std::vector<std::string> limit_names() { return {"hard", "target", "usual", "share"}; }

/// Returns the measure of a gate, such as "G5", if it has only one; else null.
const MeasureInfo* only_measure_of(std::string_view gate) {
  const MeasureInfo* found = nullptr;
  for (const MeasureInfo& info : measures()) {
    if (info.gate != gate) continue;
    if (found) return nullptr;
    found = &info;
  }
  return found;
}

std::string unknown_measure(const std::string& name) {
  std::string of_gate;
  for (const MeasureInfo& info : measures())
    if (info.gate == name) of_gate += (of_gate.empty() ? "" : ", ") + std::string(info.name);
  if (!of_gate.empty()) return "gates." + name + ": " + name + " has several measures; name one of " + of_gate;
  const std::string nearest = nearest_name(name, measure_names());
  return "gates." + name + ": unknown measure" + (nearest.empty() ? "; docs/quality_gates.md lists them" : ", did you mean " + nearest + "?");
}

const MeasureInfo* measure_of(const std::string& name) {
  const MeasureInfo* info = find_measure(name);
  return info ? info : only_measure_of(name);
}

/// Returns the limit with this name; null if there is none.
double* limit_of(GateLimits& limits, std::string_view name) {
  if (name == "hard") return &limits.hard;
  if (name == "target") return &limits.target;
  if (name == "usual") return &limits.usual;
  return name == "share" ? &limits.usual_share : nullptr;
}

/// Returns the limit in the unit of reports: "3 deg".
std::string limit_text(const MeasureInfo& info, double limit) { return number_text(in_report_unit(info, limit), 4) + (info.is_angle ? " deg" : ""); }

/// Returns the problem with the limits of a measure; empty if there is none.
std::string objection_to(const MeasureInfo& info, const GateLimits& limits) {
  if (!(limits.usual_share >= 0.0 && limits.usual_share <= 1.0)) return "share is " + number_text(limits.usual_share) + ", it must be between 0 and 1";
  const double hard = info.is_low_bad ? -limits.hard : limits.hard, target = info.is_low_bad ? -limits.target : limits.target;
  if (target > hard)
    return "target " + limit_text(info, limits.target) + " is less strict than hard " + limit_text(info, limits.hard) + "; for this measure " +
           (info.is_low_bad ? "larger" : "smaller") + " values are better: give both limits (a limit that is not given keeps its default)";
  return {};
}

void read_limits(const MeasureInfo& info, const ScriptTable& table, const std::string& key, TableReader& reader, GateTable& limits) {
  GateLimits changed = limits[info.measure];
  if (!table.items.empty() || !table.other_keys.empty() || table.fields.empty())
    reader.add_problem(key + ": expected a table with hard, target, usual, share, or false");
  for (const auto& [name, value] : table.fields) {
    double* const limit = limit_of(changed, name);
    const auto* off = std::get_if<bool>(&value);
    const auto* number = std::get_if<double>(&value);
    const auto* whole = std::get_if<std::int64_t>(&value);
    if (!limit) {
      const std::string nearest = nearest_name(name, limit_names());
      reader.add_problem(key + "." + name + ": unknown" + (nearest.empty() ? "; known are hard, target, usual, share" : ", did you mean " + nearest + "?"));
    } else if (off && !*off && name != "share") {
      *limit = k_no_limit;
    } else if (number || whole) {
      *limit = number ? *number : static_cast<double>(*whole);
    } else {
      reader.add_problem(key + "." + name + ": expected a number" + (name == "share" ? "" : " or false") + ", not " + std::string(type_text(value)));
    }
  }
  if (const std::string objection = objection_to(info, changed); !objection.empty()) return reader.add_problem(key + ": " + objection);
  limits[info.measure] = changed;
}

}  // namespace

bool read_gate_limits(TableReader& reader, GateTable& limits) {
  const ScriptValue* value = reader.field("gates");
  if (!value) return false;
  const auto* table = std::get_if<std::shared_ptr<const ScriptTable>>(value);
  if (!table || !(*table)->items.empty() || !(*table)->other_keys.empty()) {
    reader.add_problem("gates: expected a table with measures as keys, such as " + std::string(k_example));
    return true;
  }
  for (const auto& [name, entry] : (*table)->fields) {
    const MeasureInfo* info = measure_of(name);
    const auto* off = std::get_if<bool>(&entry);
    const auto* given = std::get_if<std::shared_ptr<const ScriptTable>>(&entry);
    if (!info) reader.add_problem(unknown_measure(name));
    else if (off && !*off) limits[info->measure] = {k_no_limit, k_no_limit, k_no_limit, 1.0};
    else if (given) read_limits(*info, **given, "gates." + name, reader, limits);
    else reader.add_problem("gates." + name + ": expected a table such as { hard = 1, target = 2 } or false, not " + std::string(type_text(entry)));
  }
  return true;
}

void set_gate_limits(std::string_view text, GateTable& limits) {
  const auto refuse = [&](std::string problem, std::string hint = {}) {
    throw Error({.code = ErrorCode::bad_argument, .attempted = "--gate \"" + std::string(text) + "\"", .problem = std::move(problem), .hint = std::move(hint)});
  };
  const std::size_t colon = text.find(':');
  const std::string name(text.substr(0, colon));
  const MeasureInfo* info = measure_of(name);
  if (!info) refuse(unknown_measure(name));
  if (colon == std::string_view::npos || colon + 1 == text.size()) refuse("no limit is given", "write " + name + ":hard=1,target=2 or " + name + ":none");
  std::string_view rest = text.substr(colon + 1);
  GateLimits changed = limits[info->measure];
  if (rest == "none") {
    limits[info->measure] = {k_no_limit, k_no_limit, k_no_limit, 1.0};
    return;
  }
  while (!rest.empty()) {
    const std::string_view entry = rest.substr(0, rest.find(','));
    rest.remove_prefix(std::min(rest.size(), entry.size() + 1));
    const std::size_t equals = entry.find('=');
    const std::string_view key = entry.substr(0, equals);
    double* const limit = limit_of(changed, key);
    if (!limit || equals == std::string_view::npos) refuse("\"" + std::string(entry) + "\" is not one of hard=, target=, usual=, share=");
    const std::string_view number = entry.substr(equals + 1);
    try {
      *limit = number == "none" && key != "share" ? k_no_limit : typed_number(number, info->is_angle && key != "share" ? Unit::radian : Unit::none);
    } catch (const Error& error) {
      refuse(std::string(key) + ": " + error.info().problem, error.info().hint);
    }
  }
  if (const std::string objection = objection_to(*info, changed); !objection.empty()) refuse(objection);
  limits[info->measure] = changed;
}

std::string gate_limits_help() {
  std::string text = "gates = { measure = { hard, target, usual, share } or false }: limits of QUALITY gates, instead of these defaults:\n";
  for (const MeasureInfo& info : measures()) {
    text += "  " + std::string(info.name) + " (" + std::string(info.gate) + "): ";
    std::string limits;
    const auto add = [&](const std::string& part) { limits += (limits.empty() ? "" : ", ") + part; };
    if (!std::isnan(info.limits.hard)) add("hard " + limit_text(info, info.limits.hard));
    if (!std::isnan(info.limits.target)) add("target " + limit_text(info, info.limits.target));
    if (!std::isnan(info.limits.usual)) add("usual " + limit_text(info, info.limits.usual) + " for a share of " + number_text(info.limits.usual_share, 4));
    text += (limits.empty() ? "reported, without limits" : limits) + "\n";
  }
  return text;
}

}  // namespace sterna::scripting
