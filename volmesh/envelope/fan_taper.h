// Gradual opening of multi-normal fans with the distance from the ends of their ridges.
#pragma once

#include <algorithm>

#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Length over which a multi-normal fan opens, in units of the height. Over a shorter length the cells between two fans would be twisted by more than about 45
/// degrees.
inline constexpr double k_taper_share = 2.0;

/// Returns the opening of a multi-normal fan, as a fraction of the angles between its normals.
inline double fan_opening(const OpenedRidges::Foot& fan, double target) { return std::min(1.0, fan.to_end / (k_taper_share * target)); }

/// Returns true if a vertex is part of a multi-normal fan that is not fully open. Smoothing keeps its initial direction.
inline bool is_tapered(const LayerBase& base, const Envelope& envelope, VertexId v) {
  const OpenedRidges::Foot* const fan = base.fan_of(v);
  return fan != nullptr && fan_opening(*fan, envelope.target[v]) < 1.0;
}

}  // namespace sterna::volmesh
