// Fans of opened ridges open little by little from the ends of their ridges on.
#pragma once

#include <algorithm>

#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Of the height: over such a length a fan opens, or the cells between two fans would be twisted by more than some 45 degrees.
inline constexpr double k_taper_share = 2.0;

/// How far a fan is open, of its normals' angles.
inline double fan_opening(const OpenedRidges::Foot& fan, double target) { return std::min(1.0, fan.to_end / (k_taper_share * target)); }

/// Whether a vertex is part of a fan that is not all open: smoothing leaves its direction as the start has it.
inline bool is_tapered(const LayerBase& base, const Envelope& envelope, VertexId v) {
  const OpenedRidges::Foot* const fan = base.fan_of(v);
  return fan != nullptr && fan_opening(*fan, envelope.target[v]) < 1.0;
}

}  // namespace sterna::volmesh
