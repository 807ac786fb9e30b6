// Everything that a person sees: results on stdout; log lines, errors and the progress line on stderr; a log file if asked for.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>

#include "geom/base/run_context.h"

namespace sterna::scripting {

struct ConsoleSettings {
  bool is_quiet = false;           ///< no log lines below warnings, no progress line
  bool is_verbose = false;         ///< debug lines too
  std::filesystem::path log_file;  ///< every line with its time; empty = none
};

/// Threads may call any member at any time.
class Console {
 public:
  /// \throws Error(write_failed) when the log file cannot be opened.
  explicit Console(const ConsoleSettings& settings);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// A line of result on stdout. The text may hold several lines; a missing line end is added.
  void print(std::string_view text);
  /// A line of log on stderr (and in the log file); warnings start with "warning: ".
  void log(LogLevel level, std::string_view text);
  /// "error: ..." on stderr, whatever the settings.
  void error(std::string_view text);
  /// Renews the progress line: only where stderr is a terminal.
  void progress(const ProgressState& state);
  /// Wipes the progress line.
  void end_progress();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// "1:05 min", "12 s": a duration for people.
std::string duration_text(double seconds);

}  // namespace sterna::scripting
