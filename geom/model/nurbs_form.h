// NURBS as data: the exchange format between our surfaces, OpenCASCADE and their files.
#pragma once

#include <cstddef>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna {

/// Point of a surface's parameter plane.
struct Uv {
  double u = 0.0;
  double v = 0.0;
  friend constexpr bool operator==(const Uv&, const Uv&) = default;
};
constexpr Uv operator+(Uv a, Uv b) { return {a.u + b.u, a.v + b.v}; }
constexpr Uv operator-(Uv a, Uv b) { return {a.u - b.u, a.v - b.v}; }
constexpr Uv operator*(double s, Uv a) { return {s * a.u, s * a.v}; }

/// Closed interval of a parameter.
struct Interval {
  double from = 0.0;
  double to = 1.0;
  double length() const { return to - from; }
  bool contains(double t) const { return from <= t && t <= to; }
  friend constexpr bool operator==(const Interval&, const Interval&) = default;
};

/// NURBS curve with clamped, non-periodic knots. There are poles.size() + degree + 1 knots. They ascend, and the first and the last one occur degree + 1 times.
/// The domain is [knots[degree], knots[poles.size()]]. `P` is Point (curve in space) or Uv (curve in a parameter plane).
template <class P>
struct NurbsCurveForm {
  int degree = 1;
  std::vector<double> knots;
  std::vector<P> poles;
  std::vector<double> weights;  ///< empty: polynomial; otherwise one positive weight per pole
};

/// NURBS surface. Poles are in rows: pole(i, j) = poles[i * n_v + j], i along u. The knots of each direction are as in NurbsCurveForm.
struct NurbsSurfaceForm {
  int degree_u = 1;
  int degree_v = 1;
  std::vector<double> knots_u;
  std::vector<double> knots_v;
  std::size_t n_u = 0;
  std::size_t n_v = 0;
  std::vector<Point> poles;
  std::vector<double> weights;  ///< empty: polynomial
};

}  // namespace sterna
