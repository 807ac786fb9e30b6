#include "geom/model/airfoil_parts.h"

#include <cmath>
#include <utility>

namespace sterna::airfoil_parts {

std::size_t least_x(const std::vector<Uv>& points) {
  // If several points have the smallest x (a vertical nose), take the middle one.
  std::size_t first = 0, last = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i].u < points[first].u) first = last = i;
    else if (points[i].u == points[first].u) last = i;
  }
  return (first + last) / 2;
}

Airfoil make(std::string name, const std::vector<Uv>& points) {
  Airfoil airfoil;
  airfoil.name = std::move(name);
  for (const Uv p : points)
    if (airfoil.points.empty() || std::hypot(p.u - airfoil.points.back().u, p.v - airfoil.points.back().v) > k_same_point) airfoil.points.push_back(p);
  airfoil.leading_edge = least_x(airfoil.points);
  return airfoil;
}

}  // namespace sterna::airfoil_parts
