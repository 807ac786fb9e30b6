// Helpers that are tetrahedra engines: what errors say of them, where they are.
#pragma once

#include <string>

#include "geom/base/helper_process.h"

namespace sterna::volmesh {

/// For geom/base/helper_process.h: errors tetra_engine_missing and tetra_engine_failed.
HelperTask engine_task();

/// Path of the engine's executable `name`; see sterna::find_helper.
/// \throws Error(tetra_engine_missing) with the places that were looked at.
std::string find_helper(const std::string& name, const std::string& folder);

}  // namespace sterna::volmesh
