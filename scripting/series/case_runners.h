// Where the cases of a series run: in processes on this machine, or on a cluster. Each runner starts workers, waits, and says of every case when it is over.
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

/// A case that is to run.
struct CaseTask {
  const SeriesCase* of = nullptr;
  std::filesystem::path folder;
  std::string key;
};

struct RunnerContext {
  const SeriesPlan& plan;
  std::vector<std::string> worker;  ///< the command line of a worker, to which --series-case NAME/INDEX and --threads N are added
  int lock = -1;                    ///< descriptor of the series' lock
  int tasks = 1, threads = 1;       ///< cases at a time (0: no limit), threads of each
  std::function<void(const CaseTask&, const CaseStatus&)> on_end;  ///< called once for each case, with its final status
  const RunContext& run;
};

std::vector<std::string> words_of(const RunnerContext& runner, const CaseTask& task);

/// Runs the cases in processes of this machine.
/// \throws Error(cancelled) after the workers were stopped, or killed if they take longer than that
void run_in_pool(std::span<const CaseTask> tasks, const RunnerContext& runner);

/// Runs the cases as an array of jobs of Slurm; the folder must be visible on all machines under the same path.
/// \throws Error(cancelled) after the jobs were cancelled; Error(file_not_found), Error(internal) where sbatch is not there or refuses
void run_on_slurm(std::span<const CaseTask> tasks, const RunnerContext& runner);
/// Cancels what a run that was killed has left in the queue, and waits for its end.
void cancel_left_jobs(const std::filesystem::path& folder, const RunContext& context);

/// Before a worker is started: makes the folder, and takes its validity from a status that an earlier run has left, so that nobody takes it for this run's.
void prepare(const CaseTask& task, const RunContext& context);
/// What the folder of a case says once its worker is gone for good: a status that is not final, or of another key, becomes `otherwise`, which is written there;
/// a final one of another key that was not there at prepare() is another build's, which is told.
CaseStatus settle(const CaseTask& task, const CaseStatus& otherwise, const RunContext& context);

}  // namespace sterna::scripting
