// Processes that a series starts: workers whose output goes to a file, and commands whose output is read.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geom/base/run_context.h"

namespace sterna::scripting {

/// A worker; killed and reaped at the latest when the object goes.
class ChildProcess {
 public:
  /// Starts the program in a process group of its own, with stdout and stderr in `output` (emptied first); it inherits `lock`, where that is not -1, as
  /// descriptor k_series_lock_descriptor. `folder`: its current folder, if not empty.
  /// \throws Error(internal) when it cannot be started
  ChildProcess(const std::vector<std::string>& words, const std::filesystem::path& output, int lock, const std::filesystem::path& folder = {});
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;

  /// The wait status once it has ended.
  std::optional<int> ended();
  /// Asks it to stop.
  void stop() const;
  /// Ends it and all it started in its group, now.
  void kill();

 private:
  void reap();
  pid_t pid_ = -1;
  int status_ = 0;
};

struct CommandResult {
  int status = 0;      ///< exit status; 128 + signal
  std::string output;  ///< stdout
  std::string errors;  ///< stderr
};

/// Runs a command of the PATH to its end.
/// \throws Error(file_not_found) where there is none of that name; cancelled (it is killed first)
CommandResult run_command(const std::vector<std::string>& words, const RunContext& context);

}  // namespace sterna::scripting
