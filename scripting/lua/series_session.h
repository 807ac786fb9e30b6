// Data on series in a script's session: the program of the workers, the case of this process if it is a worker, and the files that a running case has read and
// written.
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
  std::size_t index = 0;  ///< number from 1
};

/// Settings of the command line.
struct SeriesSettings {
  std::filesystem::path program;                ///< program of the workers: this one; empty: series{} is refused
  std::vector<std::string> words;               ///< arguments of a worker after the script; they include all options that can change the results of the script
  std::optional<CaseAddress> worker;            ///< this process runs only that case
  std::function<void(bool)> stops_itself = {};  ///< called with true while a series runs, because the series ends its workers or jobs itself on a stop request;
                                                ///< may be empty
  int tasks = 0;                                ///< cases at a time, overrides the script; 0 = as given in the script
  bool retries = false;                         ///< cases that failed in an earlier run are run again, too
};

/// The case that the other cases of a series start from.
struct ReferenceCase {
  std::filesystem::path folder;
  std::string name;
  bool is_this = false;                    ///< true if the running case is the reference itself
  std::shared_ptr<ReferenceUse> use = {};  ///< data that the case stores, or takes from the reference
};

/// State of the running script.
struct SeriesSession {
  SeriesSettings settings;
  std::string script_text;
  std::map<std::string, std::string> modules = {};  ///< name -> source, of all required modules
  std::set<std::string> names = {};                 ///< names of the series so far
  std::vector<std::uint64_t> earlier = {};          ///< hashes of the tables returned by the series so far
  std::optional<ReferenceCase> reference = {};      ///< the reference, while a case runs in a series that has one

  std::map<std::string, std::string> inputs = {};  ///< in a worker: hash of every file that was searched, or k_absent
  std::set<std::filesystem::path> written = {};    ///< files of the running case, which may read them back
  bool is_case_running = false;
  bool is_case_over = false;  ///< the worker has finished its case: no further verb runs
  bool is_case_done = false;  ///< the case was a success

  std::size_t n_failed = 0;   ///< number of failed cases of all series so far
  std::size_t n_invalid = 0;  ///< number of cases whose mesh is INVALID
};

/// Value in place of the hash of a missing input.
inline constexpr const char* k_absent = "absent";

/// Returns the hash of a path: of a file's bytes, or of all files of a mesh that consists of several; k_absent if the path is missing.
std::string hash_of_input(const std::filesystem::path& path);
/// Notes in a worker that the script searches this file; does nothing elsewhere.
void note_input(SeriesSession& session, const std::filesystem::path& path);

}  // namespace sterna::scripting
