// Runs cases as Slurm job arrays. A job runs the same program on the same script and reports through the folder of its case. The queue is queried only for jobs
// that have ended without a report.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <thread>

#include "geom/base/error.h"
#include "io/output/atomic_file.h"
#include "scripting/series/case_runners.h"
#include "scripting/series/worker_process.h"

namespace sterna::scripting {
namespace {

using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

constexpr std::chrono::milliseconds k_look_pause{100};    ///< between two checks of the case folders
constexpr std::chrono::milliseconds k_queue_pause{2000};  ///< between two queries of the queue, which the whole cluster shares
/// Number of successive queries in which a job must be missing before it counts as lost: its last files may still be in transfer through the network file
/// system.
constexpr int k_misses = 2;
/// Maximum number of successive queries without an answer, because controllers restart and networks fail for a while. In total this is more than half an hour,
/// since squeue itself retries for some time. Cases that end meanwhile are detected by their folders.
constexpr int k_deaf_questions = 900;
constexpr std::size_t k_array_size = 1000;             ///< maximum number of jobs of an array; clusters allow 1001 by default
constexpr std::chrono::seconds k_cancel_patience{60};  ///< longest wait for the end of jobs: Slurm kills them 30 s after the stop request
constexpr const char* k_jobs_file = "jobs";            ///< file in the folder slurm/ with the ids of the arrays that may be in the queue

/// Quotes a word for a POSIX shell, in single quotes.
std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

CommandResult run_or_throw(const std::vector<std::string>& words, const RunContext& context) {
  CommandResult result = run_command(words, context);
  if (result.status != 0)
    throw Error({.code = ErrorCode::internal,
                 .attempted = "running " + words.front(),
                 .problem = "exit status " + std::to_string(result.status) + ": " + result.errors,
                 .hint = "look up the options that the cluster requires, and give them as slurm{ options = { ... } }"});
  return result;
}

/// Returns the job script, which contains the list of its cases. Slurm keeps a copy of the script, and a restarted controller may start a job of an earlier run
/// again. If the list were in a file, that job would read the list of the next run and work on another case.
std::string job_script(std::span<const CaseTask> tasks, const RunnerContext& runner) {
  const std::size_t n_tasks = tasks.size();
  std::string text = "#!/bin/sh\n#SBATCH --job-name=" + runner.plan.name + "\n#SBATCH --array=1-" + std::to_string(n_tasks);
  if (runner.tasks > 0) text += "%" + std::to_string(runner.tasks);
  text += "\n#SBATCH --ntasks=1\n#SBATCH --no-requeue\n#SBATCH --output=/dev/null\n#SBATCH --cpus-per-task=" + std::to_string(runner.threads) + "\n";
  text += "cd " + quoted(fs::current_path().string()) + " || exit 1\n";
  text += "case $SLURM_ARRAY_TASK_ID in\n";
  for (std::size_t i = 0; i < n_tasks; ++i)
    text += std::to_string(i + 1) + ") case=" + std::to_string(tasks[i].of->index) + " folder=" + quoted(tasks[i].folder.string()) + " ;;\n";
  text += "*) exit 1 ;;\nesac\n";
  text += "exec";
  for (const std::string& word : runner.worker) text += " " + quoted(word);
  text += " --threads " + std::to_string(runner.threads) + " --series-case " + quoted(runner.plan.name) + "/\"$case\" >>\"$folder/" + k_log_file + "\" 2>&1\n";
  return text;
}

/// Returns the sbatch command. The user's options are passed on the command line, where they need no quoting.
std::vector<std::string> sbatch_command(const fs::path& script, const SeriesPlan& plan) {
  std::vector<std::string> words = {"sbatch", "--parsable"};
  if (!plan.slurm.partition.empty()) words.push_back("--partition=" + plan.slurm.partition);
  if (!plan.slurm.time.empty()) words.push_back("--time=" + plan.slurm.time);
  words.insert(words.end(), plan.sbatch_words.begin(), plan.sbatch_words.end());
  words.push_back(script.string());
  return words;
}

/// Returns the unfinished jobs of an array, by their numbers in it.
std::set<std::size_t> jobs_in_queue(const std::string& array, const RunContext& context) {
  const CommandResult result = run_command({"squeue", "--noheader", "--array", "--jobs=" + array, "--format=%i %T"}, context);
  std::set<std::size_t> jobs;
  if (result.status != 0) {
    if (result.errors.find("Invalid job id") != std::string::npos) return jobs;  // the job has ended and Slurm has forgotten it
    throw Error({.code = ErrorCode::internal,
                 .attempted = "querying the queue for job " + array,
                 .problem = "squeue ends with status " + std::to_string(result.status) + ": " + result.errors,
                 .hint = "the jobs continue: run the script again when squeue --jobs=" + array + " works"});
  }
  std::istringstream lines(result.output);
  for (std::string id, state; lines >> id >> state;)
    if (const std::size_t bar = id.find('_'); bar != std::string::npos && id.find_first_not_of("0123456789", bar + 1) == std::string::npos)
      jobs.insert(std::stoull(id.substr(bar + 1)));
  return jobs;
}

class SlurmArray {
 public:
  SlurmArray(std::span<const CaseTask> tasks, std::size_t number, const RunnerContext& runner)
      : tasks_(tasks), runner_(runner), misses_(tasks.size(), 0), is_over_(tasks.size(), false) {
    const fs::path folder = runner.plan.folder / "slurm", script = folder / ("array-" + std::to_string(number) + ".sh");
    for (const CaseTask& task : tasks) {
      prepare(task, runner.run);
      fs::remove(task.folder / k_log_file);  // jobs append to an existing log
    }
    io::write_whole(script, job_script(tasks, runner));
    id_ = run_or_throw(sbatch_command(script, runner.plan), runner.run).output;
    id_ = id_.substr(0, id_.find_first_of(";\n"));
    io::write_whole(folder / k_jobs_file, id_ + "\n");
    runner.run.info("submitted " + std::to_string(tasks.size()) + " cases of " + runner.plan.name + " as job " + id_);
  }

  void wait() {
    Clock::time_point requested = Clock::now();
    while (n_over_ < tasks_.size()) {
      if (runner_.run.stop_token().stop_requested()) cancel();
      take_finished();
      if (Clock::now() - requested >= k_queue_pause && n_over_ < tasks_.size()) {
        settle_lost();
        requested = Clock::now();
      }
      std::this_thread::sleep_for(k_look_pause);
    }
  }

 private:
  [[noreturn]] void cancel() {
    run_command({"scancel", id_}, RunContext({.threads = 1}));  // this run has been stopped, so scancel has its own run context
    runner_.run.check_stop();
    throw Error({.code = ErrorCode::cancelled, .attempted = runner_.plan.name, .problem = "stopped on request"});
  }

  void end(std::size_t i, const CaseStatus& status) {
    is_over_[i] = true;
    ++n_over_;
    runner_.on_end(tasks_[i], status);
  }

  void take_finished() {
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      if (is_over_[i]) continue;
      const CaseStatus status = read_status(tasks_[i].folder, runner_.run);
      if (status.key == tasks_[i].key && (status.is_final() || status.state == CaseState::killed)) end(i, status);
    }
  }

  /// Returns the jobs in the queue; nothing if the queue does not answer.
  std::optional<std::set<std::size_t>> query_queue() {
    try {
      std::set<std::size_t> jobs = jobs_in_queue(id_, runner_.run);
      if (n_deaf_ > 0) runner_.run.info("the queue responds again");
      n_deaf_ = 0;
      return jobs;
    } catch (const Error& error) {
      if (error.info().code == ErrorCode::cancelled || ++n_deaf_ > k_deaf_questions) throw;
      if (n_deaf_ == 1) runner_.run.warn(error.info().attempted + ": " + error.info().problem + "; the series continues and repeats the query");
      return {};
    }
  }

  void settle_lost() {
    const std::optional<std::set<std::size_t>> answer = query_queue();
    if (!answer) return;
    const std::set<std::size_t>& alive = *answer;
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      if (is_over_[i]) continue;
      misses_[i] = alive.contains(i + 1) ? 0 : misses_[i] + 1;
      if (misses_[i] >= k_misses)
        end(i, settle(tasks_[i],
                      {.state = CaseState::killed,
                       .key = tasks_[i].key,
                       .message = "job " + id_ + "_" + std::to_string(i + 1) + " is no longer in the queue and left no result"},
                      runner_.run));
    }
  }

  std::span<const CaseTask> tasks_;
  const RunnerContext& runner_;
  std::vector<int> misses_;
  int n_deaf_ = 0;  ///< successive queries without an answer
  std::vector<bool> is_over_;
  std::size_t n_over_ = 0;
  std::string id_;
};

}  // namespace

void run_on_slurm(std::span<const CaseTask> tasks, const RunnerContext& runner) {
  const fs::path folder = runner.plan.folder / "slurm";
  fs::create_directories(folder);
  std::size_t number = 0;
  for (std::size_t first = 0; first < tasks.size(); first += k_array_size) {
    SlurmArray(tasks.subspan(first, std::min(k_array_size, tasks.size() - first)), ++number, runner).wait();
    fs::remove(folder / k_jobs_file);
  }
}

void cancel_left_jobs(const fs::path& folder, const RunContext& context) {
  const fs::path file = folder / "slurm" / k_jobs_file;
  std::string id;
  if (!(std::ifstream(file) >> id)) return;
  const Clock::time_point begin = Clock::now();
  if (!jobs_in_queue(id, context).empty()) {
    context.warn("job " + id + " of an earlier run of " + folder.string() + " is still in the queue and will be cancelled");
    run_or_throw({"scancel", id}, context);
  }
  while (!jobs_in_queue(id, context).empty()) {
    if (Clock::now() - begin > k_cancel_patience)
      throw Error({.code = ErrorCode::internal,
                   .attempted = "cancelling job " + id + " of an earlier run",
                   .problem = "the job is still in the queue after a minute",
                   .hint = "scancel --signal=KILL " + id});
    std::this_thread::sleep_for(k_queue_pause);
  }
  fs::remove(file);
}

}  // namespace sterna::scripting
