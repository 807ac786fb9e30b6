#include "scripting/series/series_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "geom/base/error.h"
#include "scripting/terminal/console.h"
#include "scripting/values/summary.h"
#include "scripting/values/value_json.h"

namespace sterna::scripting {
namespace {

using Json = nlohmann::ordered_json;

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::string verdict_of(const CaseStatus& status) {
  if (status.state == CaseState::done) return status.mesh.verdict.empty() ? "no mesh" : status.mesh.verdict;
  return std::string(to_string(status.state));
}

std::string quality_of(const CaseStatus& status) {
  if (status.state != CaseState::done) return first_line(status.message);
  return status.mesh.quality + (status.mesh.worst.empty() ? "" : ", " + status.mesh.worst);
}

std::string reused_of(const CaseResult& result) {
  std::string text = result.is_kept ? "the case" : "";
  const auto add = [&](const std::string& entry) { text += (text.empty() ? "" : ", ") + entry; };
  // Cached stages of one kind are counted: "3 surface_mesh". Stages that involve a reference are listed as reported, without reasons and locations: "envelope
  // of wing: made from scratch".
  std::map<std::string, int> kinds;
  for (const std::string& stage : result.reused)
    if (stage.find(": ") == std::string::npos) ++kinds[stage.substr(0, stage.find(' '))];
  for (const auto& [kind, n] : kinds) add((n > 1 ? std::to_string(n) + " " : "") + kind);
  for (const std::string& stage : result.reused)
    if (const std::size_t colon = stage.find(": "); colon != std::string::npos) add(stage.substr(0, stage.find(": ", colon + 1)));
  return text;
}

Json case_json(const SeriesPlan& plan, const CaseResult& result) {
  const CaseStatus& status = result.status;
  Json json = {
      {"name", result.of->name}, {"index", result.of->index}, {"parameters", Json::parse(to_json(std::make_shared<const ScriptTable>(result.of->parameters)))}};
  json["folder"] = plan.folder_of(*result.of).generic_string();
  json["status"] = to_string(status.state);
  if (status.state == CaseState::done) {
    if (!status.mesh.verdict.empty()) {
      json["verdict"] = status.mesh.verdict;
      json["cells"] = status.mesh.cells;
      json["quality"] = status.mesh.quality;
      json["worst"] = status.mesh.worst;
    }
    if (status.result != "null") json["result"] = Json::parse(status.result);
  } else {
    json["error"] = {{"code", status.code}, {"message", status.message}};
  }
  json["outputs"] = Json::array();
  for (const auto& [name, hash] : status.outputs) json["outputs"].push_back(name);
  return json;
}

Json results_json(const SeriesPlan& plan, std::span<const CaseResult> results) {
  std::array<std::size_t, 3> counts{};
  Json json = {{"schema", "sterna-series-1"}, {"program", "sterna " STERNA_VERSION}, {"name", plan.name}, {"cases", Json::array()}};
  for (const CaseResult& result : results) {
    json["cases"].push_back(case_json(plan, result));
    ++counts[result.status.state == CaseState::done ? 0 : result.status.state == CaseState::failed ? 1 : 2];
  }
  json["done"] = counts[0];
  json["failed"] = counts[1];
  json["killed"] = counts[2];
  return json;
}

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// Returns the whole text on one line, without the prefix common to all errors of the series.
std::string error_text(const CaseStatus& status) {
  if (status.state == CaseState::done) return {};
  std::string text = status.message;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos;) {
    const std::size_t end = text.find_first_not_of(" \n\t", at);
    text.replace(at, (end == std::string::npos ? text.size() : end) - at, end == std::string::npos ? "" : "; ");
  }
  return text;
}

std::string plain_text(const ScriptTable& parameters, const std::string& name) {
  const auto it = parameters.fields.find(name);
  if (it == parameters.fields.end()) return {};
  const auto* text = std::get_if<std::string>(&it->second);
  return text ? *text : to_json(it->second);
}

}  // namespace

void read_measure(const std::filesystem::path& folder, CaseResult& result) {
  std::ifstream file(folder / k_measure_file, std::ios::binary);
  const Json json = Json::parse(file, nullptr, false);
  if (!json.is_object()) return;  // the case was killed before the measurement
  result.seconds = json.value("seconds", 0.0);
  result.reused = json.value("reused", std::vector<std::string>{});
}

std::map<std::string, std::string> gate_states(const std::filesystem::path& folder) {
  std::ifstream file(folder / "quality.json", std::ios::binary);
  const Json check = Json::parse(file, nullptr, false);
  std::map<std::string, std::string> gates;
  if (!check.is_object() || !check.contains("measures")) return gates;
  const std::map<std::string, int> ranks = {{"pass", 0}, {"warn", 1}, {"fail", 2}};
  for (const Json& measure : check["measures"]) {
    const std::string state = measure.value("state", "");
    if (!ranks.contains(state)) continue;
    std::string& known = gates[measure.value("gate", "")];
    if (known.empty() || ranks.at(known) < ranks.at(state)) known = state;
  }
  return gates;
}

/// Order of gates by number: G3 comes before G10.
struct GateOrder {
  bool operator()(const std::string& a, const std::string& b) const {
    const auto number = [](const std::string& gate) {
      return gate.size() > 1 && gate[0] == 'G' ? std::atoi(gate.c_str() + 1) : std::numeric_limits<int>::max();
    };
    return std::pair(number(a), a) < std::pair(number(b), b);
  }
};

/// Returns the number of warnings in the case's log.
std::int64_t n_warnings(const std::filesystem::path& folder) {
  std::ifstream file(folder / k_log_file);
  std::int64_t n = 0;
  for (std::string line; std::getline(file, line);)
    if (line.find("warning: ") != std::string::npos) ++n;
  return n;
}

std::string outcome_text(const CaseStatus& status) {
  if (status.state != CaseState::done) return std::string(to_string(status.state)) + ": " + first_line(status.message);
  if (status.mesh.verdict.empty()) return "done";
  return status.mesh.verdict + ", " + count_text(status.mesh.cells) + " cells" + (status.mesh.quality.empty() ? "" : ", quality " + status.mesh.quality);
}

std::string table_text(const SeriesPlan& plan, std::span<const CaseResult> results) {
  using Row = std::array<std::string, 6>;
  std::vector<Row> rows = {{"case", "verdict", "cells", "worst quality", "time", "reused"}};
  for (const CaseResult& result : results)
    rows.push_back({result.of->name, verdict_of(result.status), result.status.mesh.cells > 0 ? count_text(result.status.mesh.cells) : "",
                    quality_of(result.status), duration_text(result.seconds), reused_of(result)});
  std::array<std::size_t, 6> widths{};
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  constexpr std::size_t k_widest = 60;
  std::string text = "series " + plan.name + ": " + std::to_string(results.size()) + " cases\n";
  for (const Row& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool is_number = i == 2 || i == 4;
      const std::size_t width = std::min(widths[i], k_widest);
      line += " " + (is_number ? fmt::format("{:>{}}", row[i], width) : fmt::format("{:<{}}", row[i], width)) + " ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string table_csv(const SeriesPlan& plan, std::span<const CaseResult> results) {
  std::set<std::string> parameters;
  for (const SeriesCase& c : plan.cases)
    for (const auto& [name, value] : c.parameters.fields)
      if (name != "name") parameters.insert(name);
  std::string text = "case";
  for (const std::string& name : parameters) text += "," + csv_text(name);
  std::map<std::string, std::map<std::string, std::string>> gates;  // by case, then by gate
  std::set<std::string, GateOrder> gate_names;
  for (const CaseResult& result : results) {
    if (result.status.state != CaseState::done) continue;
    gates[result.of->name] = gate_states(plan.folder_of(*result.of));
    for (const auto& [gate, state] : gates[result.of->name]) gate_names.insert(gate);
  }
  text += ",status,verdict,cells,quality,worst";
  for (const std::string& gate : gate_names) text += "," + csv_text(gate);
  text += ",warnings,seconds,reused,error\n";
  for (const CaseResult& result : results) {
    const CaseStatus& status = result.status;
    text += csv_text(result.of->name);
    for (const std::string& name : parameters) text += "," + csv_text(plain_text(result.of->parameters, name));
    text += "," + std::string(to_string(status.state)) + "," + status.mesh.verdict + "," +
            (status.mesh.verdict.empty() ? "" : std::to_string(status.mesh.cells)) + "," + csv_text(status.mesh.quality) + "," + csv_text(status.mesh.worst);
    for (const std::string& gate : gate_names) {
      const auto& of_case = gates[result.of->name];
      const auto state = of_case.find(gate);
      text += "," + (state == of_case.end() ? std::string() : csv_text(state->second));
    }
    text += "," + std::to_string(n_warnings(plan.folder_of(*result.of)));
    text += "," + fmt::format("{:.3f}", result.seconds) + "," + csv_text(reused_of(result)) + "," + csv_text(error_text(status)) + "\n";
  }
  return text;
}

std::string table_json(const SeriesPlan& plan, std::span<const CaseResult> results) {
  Json json = results_json(plan, results);
  for (const CaseResult& result : results)
    json["measure"][result.of->name] = {{"seconds", result.seconds}, {"kept", result.is_kept}, {"reused", result.reused}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string result_json(const SeriesPlan& plan, std::span<const CaseResult> results) {
  return results_json(plan, results).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string result_json_of(const std::string& series_json, const std::filesystem::path& file) {
  Json json = Json::parse(series_json, nullptr, false);
  if (!json.is_object())
    throw Error({.code = ErrorCode::file_malformed, .attempted = "reading " + file.string(), .problem = "the file is not the table of a series"});
  json.erase("measure");
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace sterna::scripting
