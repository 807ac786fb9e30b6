// Runners of the cases of a series: processes on this machine, or a cluster. Each runner starts workers, waits, and reports the end of every case.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "scripting/series/case_status.h"
#include "scripting/series/series_plan.h"

namespace sterna::scripting {

/// A case to be run.
struct CaseTask {
  const SeriesCase* of = nullptr;
  std::filesystem::path folder;
  std::string key;
};

struct RunnerContext {
  const SeriesPlan& plan;
  std::vector<std::string> worker;                                 ///< command line of a worker, to which --series-case NAME/INDEX and --threads N are added
  int lock = -1;                                                   ///< descriptor of the lock on the series folder
  int tasks = 1, threads = 1;                                      ///< number of simultaneous cases (0: no limit), number of threads per case
  std::function<void(const CaseTask&, const CaseStatus&)> on_end;  ///< called once for each case, with its final status
  const RunContext& run;
};

std::vector<std::string> words_of(const RunnerContext& runner, const CaseTask& task);

/// Runs the cases in processes on this machine.
/// \throws Error(cancelled) after the workers were stopped, or killed if they did not stop in time
void run_in_pool(std::span<const CaseTask> tasks, const RunnerContext& runner);

/// Runs the cases as an array of Slurm jobs; the folder must be visible on all machines under the same path.
/// \throws Error(cancelled) after the jobs were cancelled; Error(file_not_found), Error(internal) if sbatch is missing or refuses
void run_on_slurm(std::span<const CaseTask> tasks, const RunnerContext& runner);
/// Cancels the jobs that a killed run has left in the queue, and waits for their end.
void cancel_left_jobs(const std::filesystem::path& folder, const RunContext& context);

/// Prepares a case before its worker is started: creates the folder, and invalidates the status of an earlier run, so that it is not mistaken for this run's.
void prepare(const CaseTask& task, const RunContext& context);
/// Returns the status of a case after its worker has ended. A status that is not final, or has another key, is replaced by `otherwise`, which is then written
/// to the folder. A final status that appeared after prepare() and has another key comes from another build, which is reported.
CaseStatus settle(const CaseTask& task, const CaseStatus& otherwise, const RunContext& context);

}  // namespace sterna::scripting
