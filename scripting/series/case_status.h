// status.json in the folder of a case: how far it is and, once it is over, all that a later run must know to take it as it is. Nothing in a final status
// depends on time, place or the number of threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"

namespace sterna::scripting {

enum class CaseState {
  none,     ///< never begun, or nothing that can be relied on is known
  running,  ///< in a process, or in one that died without a word
  done,
  failed,  ///< its function raised an error
  killed,  ///< its process was ended from outside
};
std::string_view to_string(CaseState state);

/// Of the mesh that a case made.
struct MeshFigures {
  std::string verdict;  ///< VALID, INVALID; empty: no mesh
  std::int64_t cells = 0;
  std::string quality;  ///< "FAIL: G9 OF; cell-centred: FAIL at 3 places (12 of 3.2 M cells); node-centred: pass"
  std::string worst;    ///< "skew 63.1 deg": the worst value of the first gate in the worst state
};

struct CaseStatus {
  CaseState state = CaseState::none;
  std::string key;                             ///< case_key()
  std::map<std::string, std::string> inputs;   ///< file as it was looked for -> hash_of_input
  std::map<std::string, std::string> outputs;  ///< file in the folder -> hash
  std::vector<std::string> found;              ///< files that were in the folder before the case and are not its own

  MeshFigures mesh;                ///< done
  std::string result;              ///< done: what the function returned, as JSON; "null" for what is not plain
  std::string code;                ///< failed: the ErrorCode
  std::string message;             ///< failed: the whole text; killed: by what
  std::vector<ErrorPlace> places;  ///< failed
  bool is_of_machine = false;      ///< failed for want of memory, disk or a process: another run may succeed

  std::int64_t process = 0;  ///< running
  std::string host;          ///< running

  bool is_final() const { return state == CaseState::done || state == CaseState::failed; }
};

inline constexpr const char* k_status_file = "status.json";
inline constexpr const char* k_measure_file = "measure.json";
inline constexpr const char* k_log_file = "log.txt";

/// State none where there is no status, or one that is damaged, which is told in the log.
CaseStatus read_status(const std::filesystem::path& folder, const RunContext& context);
/// Whole or not at all.
/// \throws Error(write_failed)
void write_status(const CaseStatus& status, const std::filesystem::path& folder);

/// Whether the case is over, with this key, and inputs and outputs are still as it recorded them.
bool is_current(const CaseStatus& status, const std::filesystem::path& folder, const std::string& key);

/// Hashes of all files in the folder that are not in `found`, but for status, measure and log; links are not followed.
std::map<std::string, std::string> outputs_in(const std::filesystem::path& folder, const std::vector<std::string>& found);

/// Removes what an earlier run of the case has left: its outputs, and of one that was killed on its way all that it did not find there. Returns the files that
/// are not the case's.
/// \throws Error(write_failed) where something cannot be removed
std::vector<std::string> clear_case_folder(const std::filesystem::path& folder, const CaseStatus& before);

/// Removes half-written files that a killed process has left in the folder itself.
/// \pre nobody writes there
void remove_parts(const std::filesystem::path& folder);

/// "signal 9 (Killed)"
std::string signal_text(int signal);

}  // namespace sterna::scripting
