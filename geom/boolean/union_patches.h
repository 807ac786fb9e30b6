// Names of the patches of a union.
#pragma once

#include <vector>

#include "geom/boolean/union_meshes.h"

namespace sterna {

/// Patches of each part as the result of unite_meshes() names them, in the order of the parts: a name that several parts use gets the name of the part in
/// front.
std::vector<std::vector<Patch>> result_patches(const std::vector<UnionPart>& parts);

}  // namespace sterna
