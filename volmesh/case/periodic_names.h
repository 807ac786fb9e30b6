// Pairs of patches that the user wants to be periodic.
#pragma once

#include <string>

namespace sterna::volmesh {

/// Names of two patches that are to be each other's image.
struct PeriodicNames {
  std::string first, second;
  friend bool operator==(const PeriodicNames&, const PeriodicNames&) = default;
};

}  // namespace sterna::volmesh
