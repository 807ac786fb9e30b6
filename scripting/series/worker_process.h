// Processes started by a series: workers whose output goes to a file, and commands whose output is read.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geom/base/child_process.h"
#include "geom/base/run_context.h"

namespace sterna::scripting {

/// Starts a worker with stdout and stderr in `output`, which is emptied first. The worker inherits `lock`, unless that is -1, as descriptor
/// k_series_lock_descriptor. `folder`: its working directory, if not empty.
/// \throws Error(file_not_found, internal) if it cannot be started
ChildProcess start_worker(const std::vector<std::string>& words, const std::filesystem::path& output, int lock, const std::filesystem::path& folder = {});

struct CommandResult {
  int status = 0;      ///< exit status; 128 + signal number if a signal ended the process
  std::string output;  ///< stdout
  std::string errors;  ///< stderr
};

/// Runs a command of the PATH and waits for its end.
/// \throws Error(file_not_found) if the command does not exist; cancelled (after killing it)
CommandResult run_command(const std::vector<std::string>& words, const RunContext& context);

}  // namespace sterna::scripting
