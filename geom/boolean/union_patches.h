// Names of the patches of a union.
#pragma once

#include <vector>

#include "geom/boolean/union_meshes.h"

namespace sterna {

/// Returns the patches of each part as named in the result of unite_meshes(), in the order of the parts: a name used by several parts gets the name of the part
/// as a prefix.
std::vector<std::vector<Patch>> result_patches(const std::vector<UnionPart>& parts);

}  // namespace sterna
