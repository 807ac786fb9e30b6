// What edge length the surface's curvature asks for, sampled once for a face on a grid in (u, v) and limited in growth.
#pragma once

#include <vector>

#include "geom/model/surface.h"

namespace sterna::surfmesh {

/// Larger absolute principal curvature, 1/m; zero where the surface has no normal (poles).
double largest_curvature(const SurfaceDerivatives& d);

class CurvatureSizes {
 public:
  /// Samples `box` of the surface, at least k_samples_per_piece times between its breaks. Edges span at most `angle` (rad); never below `min_edge`;
  /// the length changes by `growth` times the distance at most.
  CurvatureSizes(const Surface& surface, const ParameterBox& box, double angle, double min_edge, double growth);
  /// Metres; infinite on a plane. Bilinear between samples.
  double operator()(Uv at) const;
  /// Mean lengths of du and dv over the samples, metres by parameter.
  double mean_speed_u() const { return mean_speed_u_; }
  double mean_speed_v() const { return mean_speed_v_; }

 private:
  std::vector<double> u_, v_;
  std::vector<double> size_;  ///< size_[i * v_.size() + j]
  double mean_speed_u_ = 0.0;
  double mean_speed_v_ = 0.0;
};

}  // namespace sterna::surfmesh
