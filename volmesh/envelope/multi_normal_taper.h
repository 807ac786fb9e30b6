// Gradual opening of multi-normal fans with the distance from the ends of their ridges.
#pragma once

#include <algorithm>

#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Length over which a multi-normal fan opens, in units of the height. Over a shorter length the cells between two fans would be twisted by more than about 45
/// degrees.
inline constexpr double k_taper_share = 2.0;

/// Returns the opening of a multi-normal fan, as a fraction of the angles between its normals.
inline double multi_normal_opening(const OpenedRidges::BaseVertex& multi_normal, double target) {
  return std::min(1.0, multi_normal.to_end / (k_taper_share * target));
}

/// Returns true if a vertex is part of a multi-normal fan that is not fully open. Smoothing keeps its initial direction.
inline bool is_tapered(const LayerBase& base, const Envelope& envelope, VertexId v) {
  const OpenedRidges::BaseVertex* const multi_normal = base.multi_normal_of(v);
  return multi_normal != nullptr && multi_normal_opening(*multi_normal, envelope.target[v]) < 1.0;
}

}  // namespace sterna::volmesh
