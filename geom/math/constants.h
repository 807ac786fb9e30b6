// Numbers that many files need.
#pragma once

#include <limits>
#include <numbers>

namespace sterna {

inline constexpr double k_degree = std::numbers::pi / 180.0;   ///< rad
inline constexpr double k_degrees = 180.0 / std::numbers::pi;  ///< in a radian
inline constexpr double k_infinity = std::numeric_limits<double>::infinity();
inline constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

inline constexpr double k_equilateral_area = 0.4330127018922193;  ///< of an equilateral triangle over its edge squared
inline constexpr double k_regular_height = 0.81649658092772603;   ///< of a regular tetrahedron over its edge

}  // namespace sterna
