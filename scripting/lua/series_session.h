// What a script's session knows of series: which program its workers are, whether this process is one, and what a running case has read and written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace sterna::scripting {

class ReferenceUse;  // kept_reference.h

/// One case of one series: "polar/3" of --series-case.
struct CaseAddress {
  std::string series;
  std::size_t index = 0;  ///< from 1
};

/// What the command line says.
struct SeriesSettings {
  std::filesystem::path program;                ///< of the workers: this one; empty: series{} is refused
  std::vector<std::string> words;               ///< of a worker's command line behind the script: all that can change what the script does
  std::optional<CaseAddress> worker;            ///< this process runs that case and nothing else
  std::function<void(bool)> stops_itself = {};  ///< told true while a series runs, which ends its workers or jobs itself when it is stopped; may be empty
  int tasks = 0;                                ///< cases at a time, in place of what the script says; 0 = as the script says
  bool retries = false;                         ///< cases that failed in an earlier run, too, run again
};

/// The case that the others of a series start from.
struct ReferenceCase {
  std::filesystem::path folder;
  std::string name;
  bool is_this = false;                    ///< the case that runs here is the reference itself
  std::shared_ptr<ReferenceUse> use = {};  ///< what it keeps, or takes
};

/// State of the running script.
struct SeriesSession {
  SeriesSettings settings;
  std::string script_text;
  std::map<std::string, std::string> modules = {};  ///< name -> source, of all that were required
  std::set<std::string> names = {};                 ///< of the series so far
  std::vector<std::uint64_t> earlier = {};          ///< hashes of the tables that the series so far have returned
  std::optional<ReferenceCase> reference = {};      ///< while a case runs in a series that has one

  std::map<std::string, std::string> inputs = {};  ///< in a worker: every file that was looked for -> hash, or k_absent
  std::set<std::filesystem::path> written = {};    ///< by the case that runs: it may read them back
  bool is_case_running = false;
  bool is_case_over = false;  ///< the worker's work is done: no verb runs any more
  bool is_case_done = false;  ///< and it was a success

  std::size_t n_failed = 0;   ///< cases of all series so far
  std::size_t n_invalid = 0;  ///< cases whose mesh is INVALID
};

/// "hash" of an input that is not there.
inline constexpr const char* k_absent = "absent";

/// Hash of what a name stands for: of a file's bytes, of all files of a mesh that is several; k_absent.
std::string hash_of_input(const std::filesystem::path& path);
/// Notes in a worker that the script looks for this file; nothing elsewhere.
void note_input(SeriesSession& session, const std::filesystem::path& path);

}  // namespace sterna::scripting
