// Surfaces that faces lie on. Immutable and shared; every member may be called from many threads.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geom/model/nurbs_form.h"

namespace sterna {

struct ParameterBox {
  Interval u;
  Interval v;
  friend constexpr bool operator==(const ParameterBox&, const ParameterBox&) = default;
};

struct SurfaceDerivatives {
  Point point;
  Vec3 du;
  Vec3 dv;
  Vec3 duu;
  Vec3 duv;
  Vec3 dvv;
};

/// Surface S(u, v) in metres. Its normal is du x dv (a face may be reversed relative to it). Evaluators accept any (u, v) of the domain and of any period.
/// Slightly outside the domain they extend the border pieces and never throw. Infinite surfaces (plane, cylinder) are limited to the box given on construction.
class Surface {
 public:
  virtual ~Surface() = default;
  virtual ParameterBox domain() const = 0;
  virtual bool is_periodic_u() const { return false; }  ///< S(u + domain().u.length(), v) == S(u, v)
  virtual bool is_periodic_v() const { return false; }
  virtual Point point(Uv at) const = 0;
  /// Returns the point and all derivatives up to second order.
  virtual SurfaceDerivatives derivatives(Uv at) const = 0;
  /// Computes points[i] = point(at[i]), faster than one by one if the surface supports it.
  /// \pre equal sizes
  virtual void points(std::span<const Uv> at, std::span<Point> points) const;
  /// Returns the parameters inside the domain, ascending, along which the surface is less than twice continuously differentiable.
  virtual std::vector<double> breaks_u() const { return {}; }
  virtual std::vector<double> breaks_v() const { return {}; }
  /// Returns the same surface with the same parameters as NURBS; empty if there is no exact form.
  virtual std::optional<NurbsSurfaceForm> exact_nurbs() const { return std::nullopt; }
  /// Returns the kind of surface: "plane", "bicubic spline", "NURBS 3 x 5".
  virtual std::string kind() const = 0;
};
using SurfacePtr = std::shared_ptr<const Surface>;

}  // namespace sterna
