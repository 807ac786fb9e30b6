// Run context, the last argument of every public function: stop token, threads, seed, log, nested progress, dump folder. Cheap to copy; copies share one state.
// There are no globals.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

namespace sterna {

class ThreadPool;  // parallel.cpp

enum class LogLevel { debug, info, warning, error };

/// Progress report: the path of stages ("volume_mesh/envelope") and the completed fraction of the whole run, in [0, 1].
struct ProgressState {
  std::string stage;
  double share = 0.0;
};

/// Seconds of a stage; for logs and reports only, never for results.
struct StageTime {
  std::string stage;
  double seconds = 0.0;            ///< wall clock time
  double processor_seconds = 0.0;  ///< CPU time of the whole process during the stage, including helpers that ended in it

  /// Returns the fraction of the available CPU time of `threads` threads that was used, in [0, 1].
  double busy_share(int threads) const {
    const double possible = seconds * threads;
    return processor_seconds < possible ? processor_seconds / possible : 1.0;
  }
};

struct RunSettings {
  int threads = 0;  ///< worker threads; 0 = all hardware threads
  std::uint64_t seed = 1;
  std::stop_token stop;
  std::filesystem::path dump_directory;                 ///< folder for VTU files of failures; empty = none are written
  std::function<void(LogLevel, std::string_view)> log;  ///< empty = no log; called from one thread at a time only
  std::function<void(const ProgressState&)> progress;   ///< empty = none; called at most about ten times a second
  double long_step = 600.0;                             ///< s: a step that takes longer is reported in the log while it runs, then again at twice, four times
                                                        ///< ... this time
};

class RunContext {
 public:
  explicit RunContext(RunSettings settings = {});

  int threads() const;
  std::uint64_t seed() const;
  const std::filesystem::path& dump_directory() const;
  std::stop_token stop_token() const;

  /// \throws Error(cancelled) once a stop was requested. Cheap; call it in every outer loop. It also reports steps that take long.
  void check_stop() const;

  void debug(std::string_view text) const { log(LogLevel::debug, text); }
  void info(std::string_view text) const { log(LogLevel::info, text); }
  void warn(std::string_view text) const { log(LogLevel::warning, text); }
  void log(LogLevel level, std::string_view text) const;

  /// Returns a context of the same run with its own threads and without progress, for work beside other work; `stop` ends that work only. See alongside.h.
  RunContext beside(int threads, std::stop_token stop) const;

  /// Returns a context whose progress fills [from, to] of this context's progress and whose stage name is nested below this context's stage.
  RunContext part(std::string_view stage, double from, double to) const;
  /// Reports that the fraction `share` in [0, 1] of this context's part is complete; also checks for a stop.
  void progress(double share) const;

  /// Adds a time to the record of its stage (log and report only).
  void add_time(const StageTime& time) const;
  /// Returns all recorded stage times, in order of first appearance.
  std::vector<StageTime> times() const;

  struct State;
  State& state() const { return *state_; }

 private:
  friend ThreadPool& pool_of(const RunContext& context);
  void report_if_long() const;
  std::shared_ptr<State> state_;
  std::shared_ptr<ThreadPool> pool_;  ///< threads of the run, shared by all copies; contexts made by beside() have a separate pool
  bool is_beside_ = false;
  std::stop_token beside_stop_;
  std::string stage_;
  std::int64_t begin_ns_ = 0;  ///< start of the outermost stage
  double from_ = 0.0;
  double to_ = 1.0;
};

/// Records the wall time between construction and destruction under the name of a stage.
class StageTimer {
 public:
  StageTimer(const RunContext& context, std::string_view stage);
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  RunContext context_;
  std::string stage_;
  std::int64_t start_ns_;
  double processor_start_;
};

}  // namespace sterna
