// Helper functions shared by the airfoil files; private to geom/model.
#pragma once

#include <string>
#include <vector>

#include "geom/model/airfoil.h"

namespace sterna::airfoil_parts {

/// Points of a file that are closer than this, relative to the chord, are treated as one point.
inline constexpr double k_same_point = 1e-7;

/// Returns the index of the point with the smallest x; of several the middle one.
std::size_t least_x(const std::vector<Uv>& points);
/// Creates an airfoil without repeated neighbours and determines its leading edge.
Airfoil make(std::string name, const std::vector<Uv>& points);

}  // namespace sterna::airfoil_parts
