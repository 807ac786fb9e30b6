// Runs a helper executable: passes memory blocks as file descriptors, captures the output, enforces limits and stop requests, leaves no zombie processes.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"

namespace sterna {

// Descriptors of a helper's process.
inline constexpr int k_helper_request_fd = 3;
inline constexpr int k_helper_reply_fd = 4;
inline constexpr int k_helper_late_fd = 5;        ///< late data, once available
inline constexpr int k_helper_late_ready_fd = 6;  ///< pipe: receives the length of the late data in bytes, a uint64, when they are available

/// Description of a helper's task for error messages.
struct HelperTask {
  std::string helper;                       ///< "the tetrahedra engine"
  std::string attempted;                    ///< "passing the boundary to the tetrahedra engine"
  std::string else_try;                     ///< alternative remedy, appended to the hint to build the helper: ", or set ..."; may be empty
  ErrorCode missing = ErrorCode::internal;  ///< code of the error if the helper is missing or cannot be started
  ErrorCode failed = ErrorCode::internal;   ///< code of the error if the system refuses memory or a pipe
};

/// Anonymous file in memory that another process can inherit; closed when the object is destroyed.
class SharedBlock {
 public:
  /// \throws Error(task.failed) if the system refuses
  SharedBlock(const char* name, std::size_t size, HelperTask task);
  ~SharedBlock();
  SharedBlock(const SharedBlock&) = delete;
  SharedBlock& operator=(const SharedBlock&) = delete;

  int descriptor() const { return descriptor_; }
  /// Maps the block at its present size, which another process may have changed. Returns nullptr if the block is empty. The mapping is valid as long as the
  /// object exists.
  std::byte* map();
  /// Appends data at the end of the block.
  /// \throws Error(task.failed) if memory is exhausted
  void append(std::span<const std::byte> data);
  std::size_t size() const { return size_; }  ///< size of the mapping

 private:
  HelperTask task_;
  int descriptor_ = -1;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Supplies data that become available later; returns nothing until then.
using LateData = std::function<std::span<const std::byte>()>;

/// Start parameters of a helper.
struct HelperStart {
  HelperTask task;
  std::string path;                    ///< path of the executable
  std::vector<std::string> arguments;  ///< arguments without the program's name
  LateData late;                       ///< called repeatedly unless empty; an exception that it throws ends the helper and is rethrown by run_helper
  double time_limit = 0.0;             ///< seconds of wall time; k_automatic = none
};

/// Result of a helper's run.
struct HelperExit {
  int wait_status = 0;        ///< as of waitpid()
  bool is_time_over = false;  ///< killed by run_helper because the time limit was exceeded
  double seconds = 0.0;       ///< wall time of the helper
  std::string output;         ///< the last few kilobytes of its stdout and stderr
  bool is_success() const { return wait_status == 0 && !is_time_over; }
};

/// Starts the helper with the descriptors `request` and `reply` as its descriptors 3 and 4, and waits for its end. The helper has its own process group, so
/// that Ctrl-C reaches it only through the context's stop.
/// \pre request and reply are 10 or more, as those of SharedBlock are; see above_helper_descriptors()
/// \throws Error(task.missing) if the helper cannot be started, Error(task.failed) if the system refuses memory or a pipe, Error(cancelled) after the helper
/// was killed and reaped
HelperExit run_helper(const HelperStart& start, int request, int reply, const RunContext& context);

/// Duplicates the file to a descriptor number that run_helper accepts and closes the old descriptor.
/// \throws Error(task.failed)
int above_helper_descriptors(int descriptor, const HelperTask& task);

/// Returns the path of the helper executable `name`: in `folder` if that is not empty, else in the folder of the running executable or in one of the two
/// folders above it.
/// \throws Error(task.missing) with the locations searched
std::string find_helper(const std::string& name, const std::string& folder, const HelperTask& task);

/// Returns "; its last words: ..." for an error message; empty if the helper printed nothing.
std::string last_words(const HelperExit& exit);

}  // namespace sterna
