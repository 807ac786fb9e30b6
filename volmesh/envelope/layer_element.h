// One macro-element in the optimiser: the quantities that keep the element valid, each with a barrier, and their derivatives.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/vec3.h"
#include "volmesh/envelope/corner_shape.h"
#include "volmesh/envelope/symmetric_block.h"

namespace sterna::volmesh {

/// Onset of each barrier; all terms are dimensionless and 1 for a straight prism.
inline constexpr double k_wall_cosine_onset = 0.2;  ///< cosine between growth edge and wall normal
inline constexpr double k_area_onset = 0.2;         ///< share of the wall's area that the envelope triangle keeps in projection
inline constexpr double k_top_cosine_onset = 0.25;  ///< cosine between growth edge and envelope normal
inline constexpr double k_middle_onset = 0.3;       ///< b_1 + sqrt(b_0 b_2) of the exact wedge test
inline constexpr double k_corner_onset = 1.0;       ///< sine of an envelope corner over its least sine, less one: a straight prism on a sliver triangle is at
                                                    ///< this value
/// Least values of an element's quantities; barriers begin above them.
struct ElementMargins {
  double area = 0.01;        ///< share of the wall's area
  double top = 0.05;         ///< cosine between growth edge and envelope normal
  double top_of_wall = 0.2;  ///< share of the cosine between growth edge and wall normal, if this is less than `top`
  double middle = 0.0;       ///< b_1 + sqrt(b_0 b_2)
};
/// Margins of is_macro_valid (validity.cpp).
inline constexpr ElementMargins k_least_margins = {};
/// Margins of elements that meet them at the start: prisms of the extruded layer then have room for their curved growth lines.
inline constexpr ElementMargins k_wide_margins = {.area = 0.06, .top = 0.15, .top_of_wall = 0.5, .middle = 0.1};

/// Factor on the least sine: envelopes on the limit by the test of validity.cpp stay inside despite rounding.
inline constexpr double k_corner_slack = 1.0 - 1e-9;
/// Slack below which the scaled Jacobian is evaluated: elements with more slack have large scaled Jacobians, unless the wall triangle itself is a sliver.
inline constexpr double k_quality_onset = 0.3;

/// Returns -(x/onset - 1)^2 ln(x/onset) for 0 < x < onset (Li et al. 2020), with first and second derivative.
struct Barrier {
  double value, slope, curvature;
};
inline double barrier_value(double x, double onset) {
  const double q = x / onset - 1.0;
  return -q * q * std::log(x / onset);
}
inline Barrier barrier(double x, double onset) {
  const double q = x / onset;
  const double l = std::log(q), below = q - 1.0;
  return {-below * below * l, -(2.0 * below * l + below * below / q) / onset, (-2.0 * l - 4.0 * below / q + below * below / (q * q)) / (onset * onset)};
}

/// Weights of f_3 and of the barrier for one corner of one element.
struct ElementWeights {
  double top, barrier;
};

struct LayerElement {
  const ElementMargins* margins = &k_least_margins;
  bool is_virtual = false;     ///< its wall triangle has almost no area (LayerBase::is_virtual): exempt from quality limits
  Vec3 n_wall;                 ///< unit
  double wall_area2 = 0.0;     ///< twice the area
  std::array<Vec3, 2> e, top;  ///< edges 0-1 and 0-2 at wall and envelope
  std::array<Vec3, 3> unit;    ///< growth edges
  std::array<double, 3> length{};
  // The remaining members are set by measure().
  Vec3 n_top, n_middle;  ///< Bernstein coefficients of the normal over the height; n_wall * wall_area2 is the first
  double top_area2 = 0.0, area = 0.0;
  std::array<double, 3> wall_cosine{}, top_cosine{}, middle{};
  std::array<double, 3> least_sine{}, corner{};  ///< corners of the envelope: least sine, and sine over the least sine, less one

  void set_growth(std::size_t k, const Vec3& g) {
    length[k] = norm(g);
    unit[k] = g / length[k];
  }
  /// Returns wedge_quality(), from the results of measure().
  double scaled_jacobian() const;
  /// Sets least_sine. \pre wall edges and area are set.
  void set_corners() {
    const std::array<double, 3> sines = corner_sines(e[0], e[1], wall_area2);
    for (std::size_t k = 0; k < 3; ++k) least_sine[k] = k_corner_slack * least_corner_sine(sines[k]);
  }
  double top_margin(std::size_t k) const { return std::min(margins->top, margins->top_of_wall * wall_cosine[k]); }

  /// Returns the distance from infeasibility, in the units of the barrier's terms; -1 where infeasible (then the terms are not all set).
  /// An element near its barriers is also infeasible if its scaled Jacobian (wedge_quality) is below `least_quality`.
  double measure(double least_quality = 0.0);
  /// Returns weighted f_3 and barrier.
  /// \pre feasible and measured.
  double energy(const ElementWeights& weights) const;
  /// Adds gradient and positive semi-definite Hessian of energy() with respect to the growth edge of corner 0.
  /// \pre as energy().
  void differentiate_corner_0(const ElementWeights& weights, Vec3& gradient, SymmetricBlock& hessian) const;
};

}  // namespace sterna::volmesh
