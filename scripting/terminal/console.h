// Terminal output. Results go to stdout; log lines, errors and the progress line go to stderr, and optionally to a log file.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>

#include "geom/base/run_context.h"

namespace sterna::scripting {

struct ConsoleSettings {
  bool is_quiet = false;           ///< no log lines below warnings, no progress line
  bool is_verbose = false;         ///< includes debug lines
  std::filesystem::path log_file;  ///< file for every line with its time; empty = none
};

/// All members are thread-safe.
class Console {
 public:
  /// \throws Error(write_failed) if the log file cannot be opened.
  explicit Console(const ConsoleSettings& settings);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// Prints a result on stdout. The text may have several lines; a missing line end is added.
  void print(std::string_view text);
  /// Writes a log line to stderr (and to the log file); warnings start with "warning: ".
  void log(LogLevel level, std::string_view text);
  /// Writes "error: ..." to stderr, regardless of the settings.
  void error(std::string_view text);
  /// Updates the progress line, only if stderr is a terminal.
  void progress(const ProgressState& state);
  /// Clears the progress line.
  void end_progress();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns a human-readable duration: "1:05 min", "12 s".
std::string duration_text(double seconds);

}  // namespace sterna::scripting
