// Summary table of a series for people, spreadsheets and programs.
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
  bool is_kept = false;             ///< reused from an earlier run
  double seconds = 0.0;             ///< duration of the run that made the result; this may be an earlier run
  std::vector<std::string> reused;  ///< stages from the cache, in that run
};

/// Reads measure.json from the folder of a case; does nothing if there is none.
void read_measure(const std::filesystem::path& folder, CaseResult& result);

/// Returns the state of each gate in the case's quality.json: "pass", "warn", "fail", the worst of its measures; empty if there is no such file.
std::map<std::string, std::string> gate_states(const std::filesystem::path& folder);

/// Returns "VALID, 383 760 cells, quality pass", or the reason why there is no mesh.
std::string outcome_text(const CaseStatus& status);

/// Returns a table with the columns case, verdict, cells, worst quality, time, reused.
std::string table_text(const SeriesPlan& plan, std::span<const CaseResult> results);
/// Returns the table as CSV with a column per parameter.
std::string table_csv(const SeriesPlan& plan, std::span<const CaseResult> results);
/// Returns the table as JSON, schema sterna-series-1. All data that depend on time, location and cache are in the entry "measure".
std::string table_json(const SeriesPlan& plan, std::span<const CaseResult> results);
/// Returns table_json() without "measure": the return value of series{}.
std::string result_json(const SeriesPlan& plan, std::span<const CaseResult> results);
/// Returns result_json() from a series.json.
/// \throws Error(file_malformed)
std::string result_json_of(const std::string& series_json, const std::filesystem::path& file);

}  // namespace sterna::scripting
