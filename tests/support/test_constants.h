// Constants shared by nearly all test files.
#pragma once

#include <numbers>

#include "geom/base/run_context.h"

namespace sterna::test {

/// Two threads: loops are split on every machine; results do not depend on the number of threads.
inline const RunContext k_context({.threads = 2});
inline constexpr double k_pi = std::numbers::pi;
inline constexpr double k_degree = k_pi / 180.0;  ///< in radians

}  // namespace sterna::test
