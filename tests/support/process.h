// Runs a program of the build as its user would.
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
  double seconds_after_interrupt = 0.0;  ///< all of them without one
};

/// Runs `program` in `folder` and waits. With interrupt_after >= 0 it gets SIGINT so many seconds after it began to wait for one.
ProcessResult run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                          double interrupt_after = -1.0);

/// A program that runs while the test goes on; killed and reaped at the latest when the object goes. Its output is dropped.
class StartedProcess {
 public:
  StartedProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments, const std::filesystem::path& folder);
  ~StartedProcess();
  StartedProcess(const StartedProcess&) = delete;
  StartedProcess& operator=(const StartedProcess&) = delete;

  pid_t pid() const { return pid_; }
  bool has_ended();
  void signal(int number) const;
  /// Waits for its end; exit status as in ProcessResult.
  int wait();

 private:
  pid_t pid_ = -1;
  int status_ = 0;
};

/// What a process has started and still runs.
std::vector<pid_t> children_of(pid_t process);

/// build/.../sterna
std::filesystem::path sterna_program();

/// A process that this one has started and that still runs; 0 when there is none.
pid_t first_child();

}  // namespace sterna::test
