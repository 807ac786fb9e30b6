// Running a helper executable: memory blocks handed over as file descriptors, output captured, limits and stop enforced, no zombies.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "geom/base/run_context.h"

namespace sterna::volmesh {

/// Anonymous file in memory that another process can inherit; closed with the object.
class SharedBlock {
 public:
  /// \throws Error(tetra_engine_failed) when the system refuses.
  SharedBlock(const char* name, std::size_t size);
  ~SharedBlock();
  SharedBlock(const SharedBlock&) = delete;
  SharedBlock& operator=(const SharedBlock&) = delete;

  int descriptor() const { return descriptor_; }
  /// Maps the block at its present size, which another process may have changed; nullptr when it is empty. The mapping lives as long as the object.
  std::byte* map();
  /// Puts data at its end, which moves. \throws Error(tetra_engine_failed) when there is no memory for it.
  void append(std::span<const std::byte> data);
  std::size_t size() const { return size_; }  ///< of the mapping

 private:
  int descriptor_ = -1;
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

/// Data that is not there yet: nothing as long as it is not.
using LateData = std::function<std::span<const std::byte>()>;

/// How a helper ended.
struct HelperExit {
  int wait_status = 0;       ///< as of waitpid()
  bool is_time_over = false; ///< killed here because of the time limit
  double seconds = 0.0;      ///< wall time of its life
  std::string output;        ///< the last few kilobytes it wrote to stdout and stderr
  bool is_success() const { return wait_status == 0 && !is_time_over; }
};

/// Starts `path` with the request as descriptor 3 and the reply as 4, waits for its end. Its own process group, so that Ctrl-C reaches it through
/// the context's stop only. \p time_limit in seconds, k_automatic = none.
/// \throws Error tetra_engine_missing when it cannot be started; cancelled (the helper is killed and reaped first).
/// `late`, where it is not empty, is asked again and again for what goes to descriptor 5 later (wire.h); what it throws ends the helper and comes out here.
HelperExit run_helper(const std::string& path, const SharedBlock& request, const SharedBlock& reply, const LateData& late, double time_limit, const RunContext& context);

/// Path of the helper executable `name`: in `folder` if that is not empty, else in the folder of the running executable or the one above.
/// \throws Error(tetra_engine_missing) with the places that were looked at.
std::string find_helper(const std::string& name, const std::string& folder);

}  // namespace sterna::volmesh
