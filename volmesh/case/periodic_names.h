// Pairs of patches that the user declares to be periodic.
#pragma once

#include <string>

namespace sterna::volmesh {

/// Names of two patches that must be images of each other.
struct PeriodicNames {
  std::string first, second;
  friend bool operator==(const PeriodicNames&, const PeriodicNames&) = default;
};

}  // namespace sterna::volmesh
