#include "scripting/series/series_plan.h"

#include <array>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "geom/base/hash.h"
#include "scripting/series/script_essence.h"
#include "scripting/values/value_json.h"

namespace sterna::scripting {
namespace {

using Json = nlohmann::ordered_json;

std::string hex(std::uint64_t hash) {
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(hash));
  return text.data();
}

Json json_of(const SeriesPlan& plan, const SeriesCase& c, const ScriptSession& session) {
  Json json = {
      {"schema", "sterna-case-1"}, {"program", "sterna " STERNA_VERSION}, {"program_xxh3_128", plan.program_hash}, {"series", plan.name}, {"name", c.name},
      {"index", c.index}};
  json["parameters"] = Json::parse(to_json(std::make_shared<const ScriptTable>(c.parameters)));
  json["script"] = session.script.filename().string();
  json["script_xxh3_64"] = hex(hash_bytes(script_essence(session.series.script_text)));
  json["words"] = session.series.settings.words;
  json["seed"] = session.context.seed();
  if (plan.reference) json["reference"] = plan.cases[*plan.reference].name;
  if (!session.series.earlier.empty())
    for (const std::uint64_t hash : session.series.earlier) json["earlier_series_xxh3_64"].push_back(hex(hash));
  return json;
}

}  // namespace

std::string case_key(const SeriesPlan& plan, const SeriesCase& c, const ScriptSession& session) { return hex(hash_bytes(json_of(plan, c, session).dump())); }

std::string case_json(const SeriesPlan& plan, const SeriesCase& c, const ScriptSession& session) {
  Json json = json_of(plan, c, session);
  json["key"] = case_key(plan, c, session);
  return json.dump(2) + "\n";
}

}  // namespace sterna::scripting
