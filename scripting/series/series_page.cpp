#include "scripting/series/series_page.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "geom/mesh/gates.h"
#include "io/input/gzip.h"
#include "scripting/report/page_arrays.h"
#include "scripting/report/report_data.h"
#include "scripting/report/report_page.h"
#include "scripting/values/value_json.h"

namespace sterna::scripting {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the first output of the case with this extension, by name; empty: none.
std::string output_named(const CaseStatus& status, std::string_view ending) {
  for (const auto& [name, hash] : status.outputs)
    if (name.ends_with(ending)) return name;
  return {};
}

/// Returns the parameters that have a plain value in every case, by name; "index" is the case number, not a parameter.
std::vector<std::string> parameter_names(const SeriesPlan& plan) {
  std::set<std::string> names;
  for (const SeriesCase& c : plan.cases)
    for (const auto& [name, value] : c.parameters.fields)
      if (name != "name") names.insert(name);
  return {names.begin(), names.end()};
}

/// Adds the worst values, fractions and gate states from a case's quality.json.
void add_quality(const fs::path& folder, Json& entry) {
  const Json check = Json::parse(bytes_of(folder / "quality.json"), nullptr, false);
  if (!check.is_object() || !check.contains("measures")) return;
  for (const auto& [gate, state] : gate_states(folder)) entry["gates"][gate] = state;
  for (const Json& measure : check["measures"])
    if (entry["gates"].contains(measure.value("gate", "")) && measure.value("state", "") != "not checked" && measure.value("state", "") != "report")
      entry["figures"][measure.value("measure", "")] = measure["worst"];
  for (const char* part : {"prisms", "tetrahedra"})
    if (check.contains("cells")) entry["figures"][part] = check["cells"].value(part, Json(nullptr));
  if (check.contains("nodes")) entry["figures"]["nodes"] = check["nodes"];
}

Json figures_json() {
  Json figures = Json::array();
  const auto add = [&](std::string_view name, std::string_view title, std::string_view unit, bool is_log) {
    figures.push_back({{"name", name}, {"title", title}, {"unit", unit}, {"is_log", is_log}});
  };
  add("cells", "cells", "", false);
  add("nodes", "nodes", "", false);
  add("prisms", "prisms", "", false);
  add("tetrahedra", "tetrahedra", "", false);
  add("seconds", "time", "s", false);
  for (const MeasureInfo& info : measures()) add(info.name, std::string(info.title) + ", worst", info.is_angle ? "deg" : "", info.classes.per_octave > 0);
  return figures;
}

/// Returns the data of a case. The report is linked relative to series.html.
Json case_json(const SeriesPlan& plan, const CaseResult& result, const std::vector<std::string>& parameters) {
  const CaseStatus& status = result.status;
  const fs::path folder = plan.folder_of(*result.of);
  const std::string relative = folder.filename().generic_string();
  Json entry = {{"name", result.of->name},
                {"folder", relative},
                {"state", status.state == CaseState::done   ? "done"
                          : status.state == CaseState::none ? "not run"
                                                            : "failed"}};
  entry["verdict"] = status.mesh.verdict.empty() ? Json(nullptr) : Json(status.mesh.verdict);
  entry["quality"] = status.mesh.quality;
  entry["parameters"] = Json::object();
  const Json given = Json::parse(to_json(std::make_shared<const ScriptTable>(result.of->parameters)));
  for (const std::string& name : parameters) entry["parameters"][name] = given.contains(name) ? given[name] : Json(nullptr);
  // A missing mesh gives a gap, not zero.
  entry["figures"] = {{"cells", status.mesh.verdict.empty() ? Json(nullptr) : Json(status.mesh.cells)},
                      {"seconds", result.seconds > 0.0 ? Json(result.seconds) : Json(nullptr)}};
  entry["gates"] = Json::object();
  if (status.state == CaseState::done) add_quality(folder, entry);
  entry["reused"] = result.reused;
  entry["error"] = status.state == CaseState::done ? Json(nullptr) : Json(status.message);
  const std::string page = output_named(status, ".html");
  entry["report"] = page.empty() ? Json(nullptr) : Json(relative + "/" + page);
  entry["picture"] = nullptr;
  return entry;
}

/// Adds the pictures of all cases within the size limit.
void add_pictures(const SeriesPlan& plan, std::span<const CaseResult> results, Json& cases) {
  constexpr std::size_t k_share = 2;  // pictures may fill one k_share-th of the page; base64 adds a third to their size
  std::map<std::size_t, std::string> pictures;
  std::size_t total = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const std::string name = output_named(results[i].status, ".png");
    if (name.empty()) continue;
    pictures[i] = bytes_of(plan.folder_of(*results[i].of) / name);
    total += pictures[i].size();
  }
  while (total > k_most_page_bytes / k_share) {
    const auto largest = std::max_element(pictures.begin(), pictures.end(), [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
    total -= largest->second.size();
    pictures.erase(largest);
  }
  for (const auto& [i, bytes] : pictures) cases[i]["picture"] = "data:image/png;base64," + io::base64(bytes);
}

}  // namespace

std::string series_page_html(const SeriesPlan& plan, std::span<const CaseResult> results) {
  if (report_page().empty()) return {};
  const std::vector<std::string> parameters = parameter_names(plan);
  Json json = {{"schema", "sterna-series-1"}, {"program", "sterna " STERNA_VERSION}, {"title", plan.name},
               {"parameters", parameters},    {"figures", figures_json()},           {"cases", Json::array()}};
  for (const CaseResult& result : results) json["cases"].push_back(case_json(plan, result, parameters));
  add_pictures(plan, results, json["cases"]);
  return page_text(json.dump(-1, ' ', false, Json::error_handler_t::replace), PageArrays{});
}

}  // namespace sterna::scripting
