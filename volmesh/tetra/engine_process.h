// Helper processes of tetrahedral engines: their error codes and locations.
#pragma once

#include <string>

#include "geom/base/helper_process.h"

namespace sterna::volmesh {

/// Returns the task for geom/base/helper_process.h, with the errors tetra_engine_missing and tetra_engine_failed.
HelperTask engine_task();

/// Returns the path of the engine's executable `name` (see sterna::find_helper).
/// \throws Error(tetra_engine_missing) with the locations that were searched
std::string find_helper(const std::string& name, const std::string& folder);

}  // namespace sterna::volmesh
