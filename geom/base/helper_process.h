// Running a helper executable: memory blocks handed over as file descriptors, output captured, limits and stop enforced, no zombies.
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
inline constexpr int k_helper_late_fd = 5;        ///< late data, once they are there
inline constexpr int k_helper_late_ready_fd = 6;  ///< pipe: then their length in bytes comes here, a uint64

/// What a helper is for, as errors say it.
struct HelperTask {
  std::string helper;                       ///< "the tetrahedra engine"
  std::string attempted;                    ///< "handing the boundary to the tetrahedra engine"
  std::string else_try;                     ///< appended to the hint to build it: ", or set ..."; may be empty
  ErrorCode missing = ErrorCode::internal;  ///< it is not there or cannot be started
  ErrorCode failed = ErrorCode::internal;   ///< the system refuses memory or a pipe
};

/// Anonymous file in memory that another process can inherit; closed with the object.
class SharedBlock {
 public:
  /// \throws Error(task.failed) when the system refuses.
  SharedBlock(const char* name, std::size_t size, HelperTask task);
  ~SharedBlock();
  SharedBlock(const SharedBlock&) = delete;
  SharedBlock& operator=(const SharedBlock&) = delete;

  int descriptor() const { return descriptor_; }
  /// Maps the block at its present size, which another process may have changed; nullptr when it is empty. The mapping lives as long as the object.
  std::byte* map();
  /// Puts data at its end, which moves.
  /// \throws Error(task.failed) when there is no memory for it.
  void append(std::span<const std::byte> data);
  std::size_t size() const { return size_; }  ///< of the mapping

 private:
  HelperTask task_;
  int descriptor_ = -1;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Data that is not there yet: nothing as long as it is not.
using LateData = std::function<std::span<const std::byte>()>;

/// How a helper is run.
struct HelperStart {
  HelperTask task;
  std::string path;                    ///< of the executable
  std::vector<std::string> arguments;  ///< beside its name
  LateData late;                       ///< empty = none; asked again and again; what it throws ends the helper and comes out of run_helper
  double time_limit = 0.0;             ///< seconds of wall time; k_automatic = none
};

/// How a helper ended.
struct HelperExit {
  int wait_status = 0;        ///< as of waitpid()
  bool is_time_over = false;  ///< killed here because of the time limit
  double seconds = 0.0;       ///< wall time of its life
  std::string output;         ///< the last few kilobytes it wrote to stdout and stderr
  bool is_success() const { return wait_status == 0 && !is_time_over; }
};

/// Starts the helper with the descriptors `request` and `reply` as its 3 and 4, waits for its end. Its own process group, so that Ctrl-C reaches it through the
/// context's stop only.
/// \pre request and reply are 10 or more, as those of SharedBlock are; see above_helper_descriptors()
/// \throws Error task.missing when it cannot be started, task.failed; cancelled (the helper is killed and reaped first).
HelperExit run_helper(const HelperStart& start, int request, int reply, const RunContext& context);

/// The same file under a number that run_helper takes; the old one is closed.
/// \throws Error(task.failed)
int above_helper_descriptors(int descriptor, const HelperTask& task);

/// Path of the helper executable `name`: in `folder` if that is not empty, else in the folder of the running executable or one of the two above it.
/// \throws Error(task.missing) with the places that were looked at.
std::string find_helper(const std::string& name, const std::string& folder, const HelperTask& task);

/// "; its last words: ..." for an error text; empty when it said nothing.
std::string last_words(const HelperExit& exit);

}  // namespace sterna
