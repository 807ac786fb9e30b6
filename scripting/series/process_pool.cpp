// A pool of workers on this machine.
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <list>
#include <optional>
#include <thread>

#include "geom/base/error.h"
#include "scripting/series/case_runners.h"
#include "scripting/series/worker_process.h"

namespace sterna::scripting {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds k_pause{5};         ///< between two checks of the workers
constexpr std::chrono::milliseconds k_stop_grace{800};  ///< grace period of a worker after a stop request; Ctrl-C must take effect within a second
constexpr std::size_t k_quoted = 2000;                  ///< bytes of a log for a message

/// Suffix that is added to the key of an old status, so that the status is not mistaken for this run's.
constexpr const char* k_of_earlier_run = " of an earlier run";

struct Running {
  const CaseTask* task;
  ChildProcess process;
  long kills_before;  ///< number of earlier kills by the system due to lack of memory
};

/// Returns the number of processes killed by the system for lack of memory since boot; -1 if unknown.
long memory_kills() {
  std::ifstream counters("/proc/vmstat");
  std::string name;
  for (long value = 0; counters >> name >> value;)
    if (name == "oom_kill") return value;
  return -1;
}

std::string end_of_log(const std::filesystem::path& folder) {
  std::ifstream file(folder / k_log_file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t error = text.rfind("error: ");
  if (error != std::string::npos) text.erase(0, error + 7);
  if (text.size() > k_quoted) text.erase(0, text.size() - k_quoted);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

/// Returns the status of a case whose worker has not written one.
CaseStatus death_of(const Running& running, int wait_status) {
  CaseStatus status{.state = CaseState::killed, .key = running.task->key};
  if (WIFSIGNALED(wait_status)) {
    status.message = signal_text(WTERMSIG(wait_status));
    if (WTERMSIG(wait_status) == SIGKILL && memory_kills() > running.kills_before)
      status.message += "; the system ran out of memory during the run: use fewer tasks";
    return status;
  }
  status.state = CaseState::failed;
  status.code = to_string(ErrorCode::script_failed);
  status.is_of_machine = true;  // the worker could not even write the status of the case
  const std::string log = end_of_log(running.task->folder);
  status.message = log.empty() ? "the worker ended without a message, status " + std::to_string(WEXITSTATUS(wait_status)) : log;
  return status;
}

void stop_all(std::list<Running>& running, const RunContext& context) {
  for (const Running& one : running) one.process.stop();
  const Clock::time_point end = Clock::now() + k_stop_grace;
  while (!running.empty()) {
    for (auto it = running.begin(); it != running.end();) {
      if (Clock::now() >= end) it->process.kill();
      const std::optional<int> ended = it->process.ended();
      if (ended) settle(*it->task, {.state = CaseState::killed, .key = it->task->key, .message = "stopped on request"}, context);
      it = ended ? running.erase(it) : std::next(it);
    }
    std::this_thread::sleep_for(k_pause);
  }
}

}  // namespace

std::vector<std::string> words_of(const RunnerContext& runner, const CaseTask& task) {
  std::vector<std::string> words = runner.worker;
  for (const std::string& word :
       {std::string("--series-case"), runner.plan.name + "/" + std::to_string(task.of->index), std::string("--threads"), std::to_string(runner.threads)})
    words.push_back(word);
  return words;
}

void prepare(const CaseTask& task, const RunContext& context) {
  std::filesystem::create_directories(task.folder);
  CaseStatus before = read_status(task.folder, context);
  if (before.key.empty() || before.key.ends_with(k_of_earlier_run)) return;
  before.key += k_of_earlier_run;
  write_status(before, task.folder);
}

CaseStatus settle(const CaseTask& task, const CaseStatus& otherwise, const RunContext& context) {
  const CaseStatus status = read_status(task.folder, context);
  if (status.key == task.key && (status.is_final() || status.state == CaseState::killed)) return status;
  CaseStatus settled = otherwise;
  // Build and script are part of the key. A worker with another key therefore belonged to another build or script.
  if (status.is_final() && !status.key.empty() && !status.key.ends_with(k_of_earlier_run)) {
    settled.state = CaseState::killed;
    settled.message = "the case was run by another build of sterna, or with a script that was changed during the run: run the series again";
  }
  settled.found = status.found;
  write_status(settled, task.folder);
  return settled;
}

void run_in_pool(std::span<const CaseTask> tasks, const RunnerContext& runner) {
  std::list<Running> running;
  std::size_t next = 0;
  while (next < tasks.size() || !running.empty()) {
    if (runner.run.stop_token().stop_requested()) {
      stop_all(running, runner.run);
      runner.run.check_stop();
    }
    while (next < tasks.size() && running.size() < static_cast<std::size_t>(runner.tasks)) {
      const CaseTask& task = tasks[next++];
      prepare(task, runner.run);
      running.push_back({&task, start_worker(words_of(runner, task), task.folder / k_log_file, runner.lock), memory_kills()});
    }
    for (auto it = running.begin(); it != running.end();) {
      const std::optional<int> ended = it->process.ended();
      if (ended) runner.on_end(*it->task, settle(*it->task, death_of(*it, *ended), runner.run));
      it = ended ? running.erase(it) : std::next(it);
    }
    std::this_thread::sleep_for(k_pause);
  }
}

}  // namespace sterna::scripting
