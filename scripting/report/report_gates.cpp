#include "scripting/report/report_gates.h"

namespace sterna::scripting {
namespace {

/// Returns the first limit that a value of a gate violates, in the order hard, usual, target.
Json missed_limit(const Json& measure, double value) {
  const bool is_low_bad = measure["bound"] == "lower";
  for (const char* name : {"hard", "usual", "target"}) {
    const Json& limit = measure["limits"][name];
    if (limit.is_number() && (is_low_bad ? value < limit.get<double>() : value > limit.get<double>())) return limit;
  }
  return nullptr;
}

void add_locations(const Json& measure, Json& locations) {
  int rank = 0;
  for (const Json& location : measure["places"]) {
    const Json& value = location["value"];
    locations.push_back({{"gate", measure["gate"]},
                         {"measure", measure["measure"]},
                         {"title", measure["title"]},
                         {"state", measure["state"]},
                         {"value", value},
                         {"unit", measure["unit"]},
                         {"limit", value.is_number() ? missed_limit(measure, value.get<double>()) : measure["limits"]["hard"]},
                         {"at", location["position"]},
                         {"what", location["what"]},
                         {"rank", ++rank}});
  }
}

/// Adds locations that are forced by the input surface. They are listed separately, after the mesher's own defects.
void add_forced(const Json& measure, Json& locations) {
  int rank = 0;
  for (const Json& location : measure["forced_places"])
    locations.push_back(
        {{"gate", measure["gate"]},
         {"measure", measure["measure"]},
         {"title", measure["title"].get<std::string>() + ", forced by the given surface"},
         {"state", "forced"},
         {"value", location["value"]},
         {"unit", measure["unit"]},
         {"limit", measure["limits"]["hard"]},
         {"at", location["position"]},
         {"what", location["what"].get<std::string>() + ": " + location["why"].get<std::string>() + "; " + location["remedy"].get<std::string>()},
         {"rank", ++rank}});
}

}  // namespace

Json page_check_json(const CheckReport& report) {
  Json page;
  const Json check = Json::parse(to_json(report));
  page["verdict"] = check["verdict"];
  page["quality_verdict"] = check["quality_verdict"];
  page["verdict_line"] = check["verdict_line"];
  page["verdicts"] = check["verdicts"];
  page["places"] = Json::array();
  int rank = 0;
  for (const Json& finding : check["findings"])
    page["places"].push_back({{"gate", finding["gate"]},
                              {"measure", finding["violation"]},
                              {"title", finding["violation"]},
                              {"state", "invalid"},
                              {"value", nullptr},
                              {"unit", ""},
                              {"limit", nullptr},
                              {"at", finding["position"]},
                              {"what", finding["what"]},
                              {"rank", ++rank}});
  page["gates"] = Json::array();
  for (const auto& [gate, entry] : check["gates"].items())
    page["gates"].push_back({{"gate", gate},
                             {"measure", nullptr},
                             {"title", title_of_gate(gate)},
                             {"state", entry["state"]},
                             {"violations", entry.value("violations", Json(nullptr))}});
  page["histograms"] = Json::array();
  for (const char* state : {"fail", "warn", "pass", "not checked"})
    for (const Json& measure : check["measures"])
      if (measure["state"] == state && measure.contains("places")) add_locations(measure, page["places"]);
  for (const Json& measure : check["measures"])
    if (measure.contains("forced_places")) add_forced(measure, page["places"]);
  for (const Json& measure : check["measures"]) {
    Json gate = measure;
    gate.erase("places");
    gate.erase("forced_places");
    gate.erase("histogram");
    page["gates"].push_back(gate);
    if (!measure.contains("histogram") || measure["histogram"].is_null()) continue;
    Json histogram = measure["histogram"];
    for (const char* key : {"measure", "gate", "title", "unit", "limits", "counted", "state"}) histogram[key] = measure[key];
    histogram["low_is_bad"] = measure["bound"] == "lower";
    page["histograms"].push_back(std::move(histogram));
  }
  page["coverage"] = Json::array();
  for (Json patch : check["coverage"]) {
    Json lost = Json::array();
    for (const auto& [reason, share] : patch["lost"].items()) lost.push_back({reason, share});
    patch["lost"] = std::move(lost);
    page["coverage"].push_back(std::move(patch));
  }
  return page;
}

Json page_no_check_json() {
  Json page;
  page["verdict"] = "not checked";
  page["quality_verdict"] = "not checked";
  for (const char* key : {"places", "gates", "histograms", "coverage"}) page[key] = Json::array();
  return page;
}

}  // namespace sterna::scripting
