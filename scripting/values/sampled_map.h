// Converts a deformation that is given as a function of a script to a tricubic spline. The function is called from one thread during sampling; the spline may
// be called from any thread.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"
#include "geom/model/knot_basis.h"
#include "geom/model/space_map.h"

namespace sterna::scripting {

struct SampledMapOptions {
  double tolerance = k_automatic;
  int max_samples = 200000;
};

/// The map p + d(p), where d is a tensor-product cubic spline over a box. Outside of the box the outermost pieces are extrapolated.
class SampledMap final : public SpaceMap {
 public:
  /// Samples `displacement` in `box`. The samples are refined along each axis until the spline is within the tolerance (metres; automatic: 1e-6 of the box's
  /// longest side) at locations between all samples. The function is called from this thread only.
  /// \throws Error(bad_argument) with the location where the function is not finite, or where the tolerance is not reached with max_samples
  SampledMap(const std::function<Vec3(const Point&)>& displacement, const Box& box, const SampledMapOptions& options);
  Point point(const Point& p) const override;
  SpaceMapDerivatives derivatives(const Point& p) const override;
  double error() const { return error_; }      ///< metres: the largest measured error
  double largest() const { return largest_; }  ///< metres: the largest displacement among the samples
  std::size_t n_samples() const;

 private:
  std::vector<KnotBasis> basis_;  ///< along x, y, z
  std::vector<Vec3> poles_;       ///< [(i * n_y + j) * n_z + k]
  double error_ = 0.0;
  double largest_ = 0.0;
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::SampledMapOptions> {
  using O = scripting::SampledMapOptions;
  static constexpr std::string_view stage = "function";
  static constexpr std::array fields = {
      Field<O>{.name = "tolerance",
               .member = &O::tolerance,
               .unit = Unit::metre,
               .min = 1e-15,
               .max = 1e3,
               .help = "largest distance between the function and the spline that approximates it",
               .automatic = "1e-6 of the longest side"},
      Field<O>{.name = "max_samples",
               .member = &O::max_samples,
               .min = 125,
               .max = 1e7,
               .help = "largest number of points at which the function is evaluated; more are an error"},
  };
};

}  // namespace sterna
