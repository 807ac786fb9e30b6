// What nearly every file of tests needs, so that none defines it again.
#pragma once

#include <numbers>

#include "geom/base/run_context.h"

namespace sterna::test {

/// Two threads: loops are shared out on every machine; what is computed does not depend on the number.
inline const RunContext k_context({.threads = 2});
inline constexpr double k_pi = std::numbers::pi;
inline constexpr double k_degree = k_pi / 180.0;  ///< in radians

}  // namespace sterna::test
