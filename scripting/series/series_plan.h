// What a call of series{} asks for, in full.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/series/series_cases.h"

namespace sterna::scripting {

/// jobs{ 2, threads = 1 }: processes on this machine.
struct JobsOptions {
  int tasks = 0;    ///< cases at a time; 0: one for k_cores_per_task cores
  int threads = 0;  ///< of each; 0: what the run has, shared by the tasks
};

/// slurm{ partition = "cfd", tasks = 64 }
struct SlurmOptions {
  std::string partition;
  int tasks = 0;     ///< cases at a time; 0: as the cluster likes
  int threads = 1;   ///< of each
  std::string time;  ///< limit of a case as sbatch takes it
};

struct SeriesOptions {
  bool retry = false;  ///< run failed cases again; those that failed because of the machine run again in any case
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
  std::string program_hash;     ///< of the workers' executable: another build may give other bytes
  std::filesystem::path cache;  ///< folder; empty: none
  FunctionHandle function;

  std::filesystem::path folder_of(const SeriesCase& c) const { return folder / c.name; }
};

/// Of all that decides what a case does, but for the files that it reads: script (script_essence.h), parameters, name and index, the words of the command line,
/// seed, version and build, the tables of earlier series. 16 hex digits.
std::string case_key(const SeriesPlan& plan, const SeriesCase& c, const ScriptSession& session);

/// case.json: the same for people, and for other programs.
std::string case_json(const SeriesPlan& plan, const SeriesCase& c, const ScriptSession& session);

}  // namespace sterna::scripting
