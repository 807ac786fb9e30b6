// Edge length required by the surface's curvature, sampled once per face on a grid in (u, v) and limited in growth.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geom/model/surface.h"

namespace sterna::surfmesh {

/// Returns the larger absolute principal curvature, 1/m; zero where the surface has no normal (poles).
double largest_curvature(const SurfaceDerivatives& d);

/// Limits of the sizes derived from curvature.
struct CurvatureLimits {
  double angle = 0.2;                                            ///< rad: an edge spans at most this angle
  double chord_error = std::numeric_limits<double>::infinity();  ///< m: largest distance of triangles from the surface
  double min_edge = 0.0;                                         ///< m: lower limit of the sizes that follow from `angle`,
  double most_turn = std::numeric_limits<double>::infinity();    ///< rad: unless an edge of that length would span more than this angle;
  double least_edge = 0.0;                                       ///< m: in that case this is the lower limit
  double error_edge = 0.0;                                       ///< m: lower limit of the sizes that follow from the chord error
  double growth = 0.3;                                           ///< largest change of length per distance; infinite: no limit between samples
  /// Combines the limits of the two faces beside an edge: takes the smaller value of each member except growth.
  void take_less(const CurvatureLimits& other);
  /// Returns the size in metres for a curvature; infinite for zero curvature.
  double size_of(double curvature) const;
};

class CurvatureSizes {
 public:
  /// Samples the curvature in `box`, at least k_samples_per_piece times between breaks. With `loops` (closed polygons in (u, v)) only samples inside them (by
  /// parity) count: trimmed regions are ignored. Sizes are infinite until limit() is called.
  CurvatureSizes(const Surface& surface, const ParameterBox& box, std::span<const std::vector<Uv>> loops = {});
  /// Converts curvatures into sizes.
  /// \pre limit() has not been called before
  void limit(const CurvatureLimits& limits);
  /// Returns the size in metres, bilinear between samples; infinite on a plane.
  double operator()(Uv at) const;
  /// Calls visit(point, size) for every sample inside the loops.
  template <class Visit>
  void for_each_inside(const Visit& visit) const {
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (is_inside_[i] != 0) visit(points_[i], size_[i]);
  }
  /// Calls visit(size, area) for every sample inside the loops, with its share of area(), m^2.
  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) sum += cell_[i];
    if (!(sum > 0.0)) return visit(*std::min_element(size_.begin(), size_.end()), area_);
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (cell_[i] > 0.0) visit(size_[i], cell_[i] * area_ / sum);
  }
  /// Returns the area inside the loops in m^2. It is exact on planes, and a few per cent off on other surfaces, where it is computed from the samples, if the
  /// border is not the box.
  double area() const { return area_; }
  /// Mean lengths of du and dv over the samples, metres per parameter unit.
  double mean_speed_u() const { return mean_speed_u_; }
  double mean_speed_v() const { return mean_speed_v_; }

 private:
  std::vector<double> u_, v_;
  std::vector<double> curvature_;  ///< curvature_[i * v_.size() + j], 1/m; zero outside the loops; empty once sizes are limited
  std::vector<double> size_;
  std::vector<Point> points_;
  std::vector<double> cell_;  ///< m^2, area around each sample; zero outside the loops
  std::vector<std::uint8_t> is_inside_;
  double area_ = 0.0;
  double mean_speed_u_ = 0.0;
  double mean_speed_v_ = 0.0;
};

}  // namespace sterna::surfmesh
