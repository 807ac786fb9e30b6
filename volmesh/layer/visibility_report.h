// Visibility of the faces at each wall vertex from a single growth direction.
#pragma once

#include <array>
#include <vector>

#include "geom/base/error.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

inline constexpr std::array<double, 4> k_visibility_limits_deg = {30.0, 45.0, 60.0, 80.0};

/// Visibility angle of a vertex in rad: the angle between the direction with the best worst-case visibility of its faces and the normal of the worst face.
struct VisibilityReport {
  Column<VertexId, double> angle;
  double max_angle = 0.0;
  /// Fraction of the given vertices above each of k_visibility_limits_deg; for multi-normal fans the worst growth line is used.
  std::array<double, 4> share_above{};
  std::vector<ErrorLocation> hardest;  ///< the ten worst vertices above the first of these limits
};

VisibilityReport report_visibility(const LayerBase& base);

}  // namespace sterna::volmesh
