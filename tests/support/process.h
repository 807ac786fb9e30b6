// Runs a program of the build as a user would.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace sterna::test {

struct ProcessResult {
  int status = -1;     ///< exit status; 128 + signal when a signal ended it
  std::string output;  ///< stdout
  std::string errors;  ///< stderr
  double seconds = 0.0;
  double seconds_after_interrupt = 0.0;  ///< total time if not interrupted
};

/// Runs `program` in `folder` and waits. With interrupt_after >= 0, the program receives SIGINT this many seconds after it starts to catch SIGINT.
ProcessResult run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                          double interrupt_after = -1.0);

/// A program that runs in parallel to the test; killed and reaped at the latest when the object is destroyed. Its output is discarded.
class StartedProcess {
 public:
  StartedProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments, const std::filesystem::path& folder);
  ~StartedProcess();
  StartedProcess(const StartedProcess&) = delete;
  StartedProcess& operator=(const StartedProcess&) = delete;

  pid_t pid() const { return pid_; }
  bool has_ended();
  void signal(int number) const;
  /// Waits for the end of the program; returns the exit status as in ProcessResult.
  int wait();

 private:
  pid_t pid_ = -1;
  int status_ = 0;
};

/// Returns the running child processes of a process.
std::vector<pid_t> children_of(pid_t process);

/// Returns the path build/.../sterna.
std::filesystem::path sterna_program();

/// Returns a running child of this process; 0 if there is none.
pid_t first_child();

}  // namespace sterna::test
