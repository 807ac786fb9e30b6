// The complete plan of a series{} call.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/series/series_cases.h"

namespace sterna::scripting {

/// Options of jobs{ 2, threads = 1 }: processes on this machine.
struct JobsOptions {
  int tasks = 0;    ///< simultaneous cases; 0: one per k_cores_per_task cores
  int threads = 0;  ///< threads per case; 0: the threads of the run are shared by the tasks
};

/// Options of slurm{ partition = "cfd", tasks = 64 }.
struct SlurmOptions {
  std::string partition;
  int tasks = 0;     ///< simultaneous cases; 0: no limit, the cluster decides
  int threads = 1;   ///< threads per case
  std::string time;  ///< time limit of a case in sbatch's format
};

struct SeriesOptions {
  bool retry = false;  ///< run failed cases again; cases that failed because of the machine always run again
};

struct SeriesPlan {
  std::string name;
  std::filesystem::path folder;
  std::vector<SeriesCase> cases;
  std::optional<std::size_t> reference;  ///< index into cases
  bool is_slurm = false;
  JobsOptions jobs;
  SlurmOptions slurm;
  std::vector<std::string> sbatch_words;  ///< "--mem=8G": more options of sbatch
  SeriesOptions options;
  std::string program_hash;     ///< hash of the workers' executable: another build may give different bytes
  std::filesystem::path cache;  ///< folder; empty: none
  FunctionHandle function;

  std::filesystem::path folder_of(const SeriesCase& c) const { return folder / c.name; }
};

/// Returns a hash (16 hex digits) of everything that determines a case, except the files that it reads: script (script_essence.h), parameters, name and index,
/// command line, seed, version and build, and the tables of earlier series.
std::string case_key(const SeriesPlan& plan, const SeriesCase& c, const ScriptSession& session);

/// Returns the text of case.json, which holds the data behind case_key() for human readers and other programs.
std::string case_json(const SeriesPlan& plan, const SeriesCase& c, const ScriptSession& session);

}  // namespace sterna::scripting
