// What edge length the surface's curvature asks for, sampled once for a face on a grid in (u, v) and limited in growth.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geom/model/surface.h"

namespace sterna::surfmesh {

/// Larger absolute principal curvature, 1/m; zero where the surface has no normal (poles).
double largest_curvature(const SurfaceDerivatives& d);

/// What curvature may ask for.
struct CurvatureLimits {
  double angle = 0.2;                                            ///< rad: an edge spans at most this angle
  double chord_error = std::numeric_limits<double>::infinity();  ///< m: triangles are no farther from the surface
  double min_edge = 0.0;                                         ///< m: the angle asks for no less,
  double most_turn = std::numeric_limits<double>::infinity();    ///< rad: unless such an edge would span more than this,
  double least_edge = 0.0;                                       ///< m: and then for no less than this
  double error_edge = 0.0;                                       ///< m: the chord error asks for no less
  double growth = 0.3;                                           ///< change of the length by distance; infinite: each sample asks for itself
  /// Of two faces beside an edge: the lesser of each but the growth.
  void take_less(const CurvatureLimits& other);
  /// Metres, for a radius of curvature; infinite for none.
  double size_of(double curvature) const;
};

class CurvatureSizes {
 public:
  /// Samples the curvature in `box`, at least k_samples_per_piece times between breaks. With `loops` (closed polygons in (u, v)) only samples inside them
  /// (by parity) ask for something: what is trimmed away does not count. Sizes are infinite until they are limited.
  CurvatureSizes(const Surface& surface, const ParameterBox& box, std::span<const std::vector<Uv>> loops = {});
  /// Turns curvatures into sizes.
  /// \pre the first call
  void limit(const CurvatureLimits& limits);
  /// Metres; infinite on a plane. Bilinear between samples.
  double operator()(Uv at) const;
  /// Calls visit(point, size) for every sample inside.
  template <class Visit>
  void for_each_inside(const Visit& visit) const {
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (is_inside_[i] != 0) visit(points_[i], size_[i]);
  }
  /// Calls visit(size, area) for every sample inside with its share of area(), m^2.
  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) sum += cell_[i];
    if (!(sum > 0.0)) return visit(*std::min_element(size_.begin(), size_.end()), area_);
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (cell_[i] > 0.0) visit(size_[i], cell_[i] * area_ / sum);
  }
  /// Area inside, m^2: exact on planes, elsewhere from the samples, a few per cent off where the border is not the box.
  double area() const { return area_; }
  /// Mean lengths of du and dv over the samples, metres by parameter.
  double mean_speed_u() const { return mean_speed_u_; }
  double mean_speed_v() const { return mean_speed_v_; }

 private:
  std::vector<double> u_, v_;
  std::vector<double> curvature_;  ///< curvature_[i * v_.size() + j], 1/m; zero outside; empty once sizes are limited
  std::vector<double> size_;
  std::vector<Point> points_;
  std::vector<double> cell_;  ///< area around a sample, m^2; zero outside
  std::vector<std::uint8_t> is_inside_;
  double area_ = 0.0;
  double mean_speed_u_ = 0.0;
  double mean_speed_v_ = 0.0;
};

}  // namespace sterna::surfmesh
