#include "scripting/series/series_run.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "geom/base/error.h"
#include "geom/base/hash.h"
#include "io/output/atomic_file.h"
#include "scripting/lua/script_function.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/series/case_runners.h"
#include "scripting/series/case_worker.h"
#include "scripting/series/folder_lock.h"
#include "scripting/series/series_page.h"
#include "scripting/series/series_report.h"
#include "scripting/terminal/console.h"
#include "scripting/values/value_json.h"

namespace sterna::scripting {
namespace {

namespace fs = std::filesystem;

/// Default number of cores per case. More processes with few cores each gain more than more threads per process.
constexpr int k_cores_per_task = 4;

/// Makes the table available to later series and returns it as a value.
ScriptValue remember(SeriesSession& series, const SeriesPlan& plan, const std::string& result) {
  series.names.insert(plan.name);
  series.earlier.push_back(hash_bytes(result));
  return value_of_json(result);
}

// ---- In a worker ---------------------------------------------------------------------------------------------------------------------------

ScriptValue result_of_earlier(const ScriptCall& call, const SeriesPlan& plan) {
  const fs::path file = plan.folder / "series.json";
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw Error(
        {.code = ErrorCode::file_not_found, .attempted = call.attempted(), .problem = "results of this earlier series are missing in " + file.string()});
  return remember(call.session.series, plan, result_json_of({std::istreambuf_iterator<char>(stream), {}}, file));
}

[[noreturn]] void run_one(const ScriptCall& call, const SeriesPlan& plan) {
  const std::size_t index = call.session.series.settings.worker->index;
  if (index < 1 || index > plan.cases.size())
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = call.attempted(),
                 .problem = "there is no case " + std::to_string(index) + " among its " + std::to_string(plan.cases.size())});
  run_case(call, plan, plan.cases[index - 1]);
  throw Error({.code = ErrorCode::cancelled, .attempted = call.attempted(), .problem = "the case is complete"});
}

// ---- In the main process -------------------------------------------------------------------------------------------------------------------

/// Makes the series handle a stop of the program during its lifetime. The series ends workers and jobs and records their results, which may take longer than
/// other work is allowed to take.
class StopNotice {
 public:
  explicit StopNotice(const std::function<void(bool)>& report) : report_(report) {
    if (report_) report_(true);
  }
  ~StopNotice() {
    if (report_) report_(false);
  }
  StopNotice(const StopNotice&) = delete;
  StopNotice& operator=(const StopNotice&) = delete;

 private:
  const std::function<void(bool)>& report_;
};

/// One series while it runs.
class SeriesRun {
 public:
  SeriesRun(const ScriptCall& call, const SeriesPlan& plan)
      : session_(call.session), plan_(plan), context_(session_.context.part("series " + plan.name, 0.0, 1.0)), lock_(plan.folder, context_) {
    for (const SeriesCase& c : plan.cases) results_.push_back({.of = &c});
  }

  /// \throws Error as run(); for a stop, the message states which results are kept and how to continue
  const std::vector<CaseResult>& run_or_report_kept() {
    try {
      return run();
    } catch (const Error& error) {
      if (error.info().code != ErrorCode::cancelled) throw;
      const auto n_done = std::count_if(results_.begin(), results_.end(), [](const CaseResult& result) { return result.status.state == CaseState::done; });
      ErrorInfo info = error.info();
      info.problem =
          "stopped; " + std::to_string(n_done) + " of " + std::to_string(results_.size()) + " cases are complete and stored in " + plan_.folder.string();
      info.hint = "run the same command to continue";
      throw Error(std::move(info));
    }
  }

 private:
  const std::vector<CaseResult>& run() {
    remove_parts(plan_.folder);
    cancel_left_jobs(plan_.folder, context_);
    std::vector<std::size_t> others;
    for (std::size_t i = 0; i < plan_.cases.size(); ++i)
      if (i != plan_.reference) others.push_back(i);
    if (plan_.reference) run_cases({*plan_.reference});
    if (!plan_.reference || results_[*plan_.reference].status.state == CaseState::done) run_cases(others);
    else give_up(others);
    return results_;
  }

  void run_cases(const std::vector<std::size_t>& indices) {
    std::vector<CaseTask> tasks;
    for (const std::size_t i : indices) {
      const SeriesCase& c = plan_.cases[i];
      CaseTask task{.of = &c, .folder = plan_.folder_of(c), .key = case_key(plan_, c, session_)};
      const CaseStatus status = read_status(task.folder, context_);
      if (!is_current(status, task.folder, task.key) || (status.state == CaseState::failed && is_tried_again(status))) tasks.push_back(std::move(task));
      else finish(c, status, true);
    }
    if (tasks.empty()) return;
    if (plan_.is_slurm) run_on_slurm(tasks, runner(plan_.slurm.tasks, plan_.slurm.threads));
    else run_in_pool(tasks, pool_runner(tasks.size()));
  }

  bool is_tried_again(const CaseStatus& status) const { return plan_.options.retry || session_.series.settings.retries || status.is_of_machine; }

  RunnerContext pool_runner(std::size_t n_tasks) {
    const int cores = context_.threads();
    int tasks = plan_.jobs.tasks > 0 ? plan_.jobs.tasks : std::max(1, cores / k_cores_per_task);
    tasks = std::min(tasks, static_cast<int>(std::min<std::size_t>(n_tasks, 1u << 20)));
    return runner(tasks, plan_.jobs.threads > 0 ? plan_.jobs.threads : std::max(1, cores / tasks));
  }

  RunnerContext runner(int tasks, int threads) {
    const SeriesSettings& settings = session_.series.settings;
    std::vector<std::string> worker = {settings.program.string(), "run", session_.script.string()};
    worker.insert(worker.end(), settings.words.begin(), settings.words.end());
    if (!plan_.cache.empty()) worker.insert(worker.end(), {"--cache", plan_.cache.string()});
    return {.plan = plan_,
            .worker = worker,
            .lock = lock_.descriptor(),
            .tasks = settings.tasks > 0 ? settings.tasks : tasks,
            .threads = threads,
            .on_end = [this](const CaseTask& task, const CaseStatus& status) { finish(*task.of, status, false); },
            .run = context_};
  }

  void finish(const SeriesCase& c, const CaseStatus& status, bool is_kept) {
    CaseResult& result = results_[c.index - 1];
    result.status = status;
    result.is_kept = is_kept;
    read_measure(plan_.folder_of(c), result);
    ++n_over_;
    const bool is_done = status.state == CaseState::done;
    context_.log(is_done ? LogLevel::info : LogLevel::warning, plan_.name + " " + std::to_string(n_over_) + "/" + std::to_string(plan_.cases.size()) + ": " +
                                                                   c.name + ": " + outcome_text(status) +
                                                                   (is_kept ? ", from an earlier run" : ", " + duration_text(result.seconds)));
    if (context_.stop_token().stop_requested()) return;  // progress() would throw here; the runner stops the workers more gently
    context_.progress(static_cast<double>(n_over_) / static_cast<double>(plan_.cases.size()));
  }

  /// Marks the cases that start from the reference as failed, after the reference has failed.
  void give_up(const std::vector<std::size_t>& indices) {
    for (const std::size_t i : indices) {
      const SeriesCase& c = plan_.cases[i];
      CaseStatus status{.state = CaseState::failed,
                        .key = {},
                        .code = std::string(to_string(ErrorCode::bad_argument)),
                        .message = "the reference case " + plan_.cases[*plan_.reference].name + " gave no result"};
      finish(c, status, false);
    }
  }

  ScriptSession& session_;
  const SeriesPlan& plan_;
  RunContext context_;
  FolderLock lock_;
  std::vector<CaseResult> results_;
  std::size_t n_over_ = 0;
};

ScriptValue run_all(const ScriptCall& call, const SeriesPlan& plan) {
  SeriesSession& series = call.session.series;
  if (series.settings.program.empty()) reject(call, "series starts processes of the program sterna", "run the script with `sterna run`");
  const StopNotice notice(series.settings.stops_itself);
  SeriesRun run(call, plan);
  const std::vector<CaseResult>& results = run.run_or_report_kept();
  for (const CaseResult& result : results) {
    if (result.status.state != CaseState::done) ++series.n_failed;
    else if (result.status.mesh.verdict == "INVALID") ++series.n_invalid;
  }
  call.session.print(table_text(plan, results));
  io::write_whole(plan.folder / "series.csv", table_csv(plan, results));
  io::write_whole(plan.folder / "series.json", table_json(plan, results));
  if (const std::string page = series_page_html(plan, results); !page.empty()) io::write_whole(plan.folder / "series.html", page);
  else call.session.context.info("series.html was not written: this sterna was built without the page");
  return remember(series, plan, result_json(plan, results));
}

// ---- Check mode of scripts -------------------------------------------------------------------------------------------------------------------

/// Calls the function once, with the first case, and returns a table as if all cases were done. Starts no process and makes no folder.
ScriptValue check_first(const ScriptCall& call, const SeriesPlan& plan) {
  SeriesSession& series = call.session.series;
  CaseStatus as_if{.state = CaseState::done};
  as_if.mesh.cells = 1;
  as_if.mesh.verdict = "VALID";
  as_if.mesh.quality = "pass";
  series.is_case_running = true;
  try {
    as_if.result = to_result(plan.function->call(argument_of(plan.cases.front())));
  } catch (...) {
    series.is_case_running = false;
    throw;
  }
  series.is_case_running = false;
  std::vector<CaseResult> results;
  for (const SeriesCase& c : plan.cases) {
    results.push_back({.of = &c});
    results.back().status = as_if;
  }
  return remember(series, plan, result_json(plan, results));
}

}  // namespace

ScriptValue run_series(const ScriptCall& call, const SeriesPlan& plan) {
  const SeriesSession& series = call.session.series;
  if (series.is_case_running) reject(call, "a case cannot contain another series");
  if (series.names.contains(plan.name)) reject(call, "there is a series \"" + plan.name + "\" already", "give each series another name");
  if (call.session.check) return check_first(call, plan);
  if (!series.settings.worker) return run_all(call, plan);
  if (series.settings.worker->series != plan.name) return result_of_earlier(call, plan);
  run_one(call, plan);
}

}  // namespace sterna::scripting
