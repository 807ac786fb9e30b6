#include "volmesh/tetra/engine_process.h"

#include "volmesh/tetra/wire.h"

namespace sterna::volmesh {

static_assert(wire::k_request_fd == k_helper_request_fd && wire::k_reply_fd == k_helper_reply_fd && wire::k_size_fd == k_helper_late_fd &&
              wire::k_size_ready_fd == k_helper_late_ready_fd);

HelperTask engine_task() {
  return {.helper = "the tetrahedra engine",
          .attempted = "passing the boundary to the tetrahedra engine",
          .else_try = ", choose another tetrahedra.engine, or set tetrahedra.helper_folder to the folder of the helper",
          .missing = ErrorCode::tetra_engine_missing,
          .failed = ErrorCode::tetra_engine_failed};
}

std::string find_helper(const std::string& name, const std::string& folder) { return sterna::find_helper(name, folder, engine_task()); }

}  // namespace sterna::volmesh
