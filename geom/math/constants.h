// Numerical constants used in many files.
#pragma once

#include <limits>
#include <numbers>

namespace sterna {

inline constexpr double k_degree = std::numbers::pi / 180.0;   ///< rad
inline constexpr double k_degrees = 180.0 / std::numbers::pi;  ///< degrees per radian
inline constexpr double k_infinity = std::numeric_limits<double>::infinity();
inline constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

inline constexpr double k_equilateral_area = 0.4330127018922193;  ///< area of an equilateral triangle divided by its edge length squared
inline constexpr double k_regular_height = 0.81649658092772603;   ///< height of a regular tetrahedron divided by its edge length

}  // namespace sterna
