// The end of a series: one table for people, spreadsheets and programs.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "scripting/series/case_status.h"
#include "scripting/series/series_plan.h"

namespace sterna::scripting {

struct CaseResult {
  const SeriesCase* of = nullptr;
  CaseStatus status;
  bool is_kept = false;             ///< taken from an earlier run
  double seconds = 0.0;             ///< of its own run, whenever that was
  std::vector<std::string> reused;  ///< stages from the cache, in that run
};

/// What measure.json in its folder says; nothing where there is none.
void read_measure(const std::filesystem::path& folder, CaseResult& result);

/// The state of each gate that the case's quality.json has: "pass", "warn", "fail", the worst of its measures; nothing where there is no such file.
std::map<std::string, std::string> gate_states(const std::filesystem::path& folder);

/// "VALID, 383 760 cells, quality pass" or why there is none.
std::string outcome_text(const CaseStatus& status);

/// Columns case, verdict, cells, worst quality, time, reused.
std::string table_text(const SeriesPlan& plan, std::span<const CaseResult> results);
/// The same with a column for each parameter.
std::string table_csv(const SeriesPlan& plan, std::span<const CaseResult> results);
/// Schema sterna-series-1; all that depends on time, place and cache is in the entry "measure".
std::string table_json(const SeriesPlan& plan, std::span<const CaseResult> results);
/// Without "measure": what series{} returns.
std::string result_json(const SeriesPlan& plan, std::span<const CaseResult> results);
/// The same of a series.json.
/// \throws Error(file_malformed)
std::string result_json_of(const std::string& series_json, const std::filesystem::path& file);

}  // namespace sterna::scripting
