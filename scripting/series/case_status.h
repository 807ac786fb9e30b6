// Defines status.json in the folder of a case. It holds the state of the case and, after its end, all data that a later run needs to reuse the case. A final
// status does not depend on time, location or number of threads.
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
  none,     ///< the case was never begun, or there is no reliable information
  running,  ///< running in a process, or the process died without a final status
  done,
  failed,  ///< the function raised an error
  killed,  ///< the process was ended from outside
};
std::string_view to_string(CaseState state);

/// Figures of the mesh of a case.
struct MeshFigures {
  std::string verdict;  ///< VALID, INVALID; empty: no mesh
  std::int64_t cells = 0;
  std::string quality;  ///< "FAIL: G9 OF; cell-centred: FAIL at 3 places (12 of 3.2 M cells); node-centred: pass"
  std::string worst;    ///< "skew 63.1 deg": the worst value of the first gate in the worst state
};

struct CaseStatus {
  CaseState state = CaseState::none;
  std::string key;                             ///< case_key()
  std::map<std::string, std::string> inputs;   ///< hash of each file that was searched, by name (hash_of_input)
  std::map<std::string, std::string> outputs;  ///< hash of each file in the folder, by name
  std::vector<std::string> found;              ///< files in the folder before the case that are not its own

  MeshFigures mesh;                      ///< only if done
  std::string result;                    ///< if done: the function's return value as JSON; "null" for values that are not plain
  std::string code;                      ///< if failed: the ErrorCode
  std::string message;                   ///< if failed: the full text; if killed: the cause
  std::vector<ErrorLocation> locations;  ///< locations of the error, if failed
  bool is_of_machine = false;            ///< if failed: memory, disk space or processes were lacking, so another run may succeed

  std::int64_t process = 0;  ///< process id, while running
  std::string host;          ///< host name, while running

  bool is_final() const { return state == CaseState::done || state == CaseState::failed; }
};

inline constexpr const char* k_status_file = "status.json";
inline constexpr const char* k_measure_file = "measure.json";
inline constexpr const char* k_log_file = "log.txt";

/// Reads the status. State none if there is no status, or if it is damaged, which is reported in the log.
CaseStatus read_status(const std::filesystem::path& folder, const RunContext& context);
/// Writes the status completely or not at all.
/// \throws Error(write_failed)
void write_status(const CaseStatus& status, const std::filesystem::path& folder);

/// Returns true if the case has finished with this key, and its inputs and outputs still match the recorded hashes.
bool is_current(const CaseStatus& status, const std::filesystem::path& folder, const std::string& key);

/// Returns the hashes of all files in the folder that are not in `found`, except status, measure and log; links are not followed.
std::map<std::string, std::string> outputs_in(const std::filesystem::path& folder, const std::vector<std::string>& found);

/// Removes the outputs of an earlier run of the case. If that run was killed, removes all files except those that it found in the folder. Returns the files
/// that do not belong to the case.
/// \throws Error(write_failed) if a file cannot be removed
std::vector<std::string> clear_case_folder(const std::filesystem::path& folder, const CaseStatus& before);

/// Removes half-written files that a killed process has left directly in the folder.
/// \pre no process writes there
void remove_parts(const std::filesystem::path& folder);

/// Returns "signal 9 (Killed)".
std::string signal_text(int signal);

}  // namespace sterna::scripting
