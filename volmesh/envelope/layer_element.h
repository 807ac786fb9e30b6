// One macro-element in the optimiser: the quantities that keep the element valid, each with a barrier, and their derivatives.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/vec3.h"
#include "volmesh/envelope/corner_shape.h"
#include "volmesh/envelope/symmetric_block.h"

namespace sterna::volmesh {

/// Onset of each barrier. All terms are dimensionless, and 1 for a straight prism.
inline constexpr double k_wall_cosine_onset = 0.2;  ///< for the cosine between growth edge and wall normal
inline constexpr double k_area_onset = 0.2;         ///< for the fraction of the wall's area that the envelope triangle keeps in projection
inline constexpr double k_top_cosine_onset = 0.25;  ///< for the cosine between growth edge and envelope normal
inline constexpr double k_middle_onset = 0.3;       ///< for b_1 + sqrt(b_0 b_2) of the exact wedge test
/// For the ratio of the sine of an envelope corner to its smallest allowed sine, minus one; a straight prism on a sliver triangle has this value.
inline constexpr double k_corner_onset = 1.0;
/// Smallest values of an element's quantities. Barriers begin above them.
struct ElementMargins {
  double area = 0.01;        ///< fraction of the wall's area
  double top = 0.05;         ///< cosine between growth edge and envelope normal
  double top_of_wall = 0.2;  ///< fraction of the cosine between growth edge and wall normal; it applies if that is less than `top`
  double middle = 0.0;       ///< b_1 + sqrt(b_0 b_2)
};
/// Margins of is_macro_valid (validity.cpp).
inline constexpr ElementMargins k_least_margins = {};
/// Margins of elements that satisfy them at the start. With these, prisms of the extruded layer have room for their curved growth lines.
inline constexpr ElementMargins k_wide_margins = {.area = 0.06, .top = 0.15, .top_of_wall = 0.5, .middle = 0.1};

/// Factor on the smallest sine. With it, envelopes that are on the limit in the test of validity.cpp stay inside the limit despite rounding.
inline constexpr double k_corner_slack = 1.0 - 1e-9;
/// The scaled Jacobian is evaluated only below this slack. Elements with more slack have large scaled Jacobians, unless the wall triangle itself is a sliver.
inline constexpr double k_quality_onset = 0.3;

/// Returns -(x/onset - 1)^2 ln(x/onset) for 0 < x < onset (Li et al. 2020), with its first and second derivatives.
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
  bool is_virtual = false;     ///< the wall triangle has almost no area (LayerBase::is_virtual), so quality limits do not apply
  Vec3 n_wall;                 ///< unit normal of the wall triangle
  double wall_area2 = 0.0;     ///< twice the area of the wall triangle
  std::array<Vec3, 2> e, top;  ///< edges 0-1 and 0-2 of the wall and of the envelope
  std::array<Vec3, 3> unit;    ///< unit vectors of the growth edges
  std::array<double, 3> length{};
  // The remaining members are set by measure().
  Vec3 n_top, n_middle;  ///< Bernstein coefficients of the normal over the height; the first coefficient is n_wall * wall_area2
  double top_area2 = 0.0, area = 0.0;
  std::array<double, 3> wall_cosine{}, top_cosine{}, middle{};
  std::array<double, 3> least_sine{}, corner{};  ///< for each corner of the envelope: smallest allowed sine, and ratio of the sine to it, minus one

  void set_growth(std::size_t k, const Vec3& g) {
    length[k] = norm(g);
    unit[k] = g / length[k];
  }
  /// Returns wedge_quality(), computed from the results of measure().
  double scaled_jacobian() const;
  /// Sets least_sine. \pre wall edges and area are set
  void set_corners() {
    const std::array<double, 3> sines = corner_sines(e[0], e[1], wall_area2);
    for (std::size_t k = 0; k < 3; ++k) least_sine[k] = k_corner_slack * least_corner_sine(sines[k]);
  }
  double top_margin(std::size_t k) const { return std::min(margins->top, margins->top_of_wall * wall_cosine[k]); }

  /// Returns the distance from infeasibility in the units of the barrier's terms. Returns -1 if the element is infeasible; some terms are then not set. An
  /// element near its barriers is also infeasible if its scaled Jacobian (wedge_quality) is below `least_quality`.
  double measure(double least_quality = 0.0);
  /// Returns the weighted sum of f_3 and the barrier.
  /// \pre the element is feasible and measured
  double energy(const ElementWeights& weights) const;
  /// Adds the gradient and a positive semi-definite Hessian of energy() with respect to the growth edge of corner 0.
  /// \pre the same as for energy()
  void differentiate_corner_0(const ElementWeights& weights, Vec3& gradient, SymmetricBlock& hessian) const;
};

}  // namespace sterna::volmesh
