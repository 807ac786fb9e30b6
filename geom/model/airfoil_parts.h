// Shared by the files that make airfoils; private to geom/model.
#pragma once

#include <string>
#include <vector>

#include "geom/model/airfoil.h"

namespace sterna::airfoil_parts {

/// Of the chord: points of files that close are one point given twice.
inline constexpr double k_same_point = 1e-7;

/// Number of the point of least x; of several the middle one.
std::size_t least_x(const std::vector<Uv>& points);
/// Without repeated neighbours, with its leading edge.
Airfoil make(std::string name, const std::vector<Uv>& points);

}  // namespace sterna::airfoil_parts
