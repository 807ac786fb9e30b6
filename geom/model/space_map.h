// Deformations of space D(p), and curves and surfaces composed with them: S'(u, v) = D(S(u, v)). There is no refit: parameters are the same, and results are
// exact to rounding.
#pragma once

#include <functional>

#include "geom/model/curve.h"
#include "geom/model/surface.h"

namespace sterna {

struct SpaceMapDerivatives {
  Point point;
  Vec3 dx, dy, dz;  ///< columns of the Jacobian
  Vec3 dxx, dxy, dxz, dyy, dyz, dzz;
  Vec3 first(const Vec3& a) const { return a.x * dx + a.y * dy + a.z * dz; }
  Vec3 second(const Vec3& a, const Vec3& b) const {
    return a.x * b.x * dxx + a.y * b.y * dyy + a.z * b.z * dzz + (a.x * b.y + a.y * b.x) * dxy + (a.x * b.z + a.z * b.x) * dxz + (a.y * b.z + a.z * b.y) * dyz;
  }
  /// Returns the determinant of the Jacobian: volume of the image of a unit volume; not positive where the map folds over.
  double determinant() const { return dot(dx, cross(dy, dz)); }
};

/// Immutable; every member may be called from many threads.
class SpaceMap {
 public:
  virtual ~SpaceMap() = default;
  virtual Point point(const Point& p) const = 0;
  virtual SpaceMapDerivatives derivatives(const Point& p) const = 0;
};
using SpaceMapPtr = std::shared_ptr<const SpaceMap>;

/// A map given by a function. Derivatives are central differences of fourth order (mixed derivatives: second order) with `step` metres, which need 25 calls. A
/// good step is about 1e-3 of the length scale over which the function varies; second derivatives are then accurate to about 1e-9 relative to that scale.
class FunctionMap final : public SpaceMap {
 public:
  /// \throws Error(bad_argument) unless step > 0
  FunctionMap(std::function<Point(const Point&)> function, double step);
  /// \throws Error(bad_argument) with the location where the function returns a value that is not finite
  Point point(const Point& p) const override;
  SpaceMapDerivatives derivatives(const Point& p) const override;

 private:
  std::function<Point(const Point&)> function_;
  double step_;
};

class DeformedCurve final : public Curve {
 public:
  DeformedCurve(CurvePtr base, SpaceMapPtr map) : base_(std::move(base)), map_(std::move(map)) {}
  Interval domain() const override { return base_->domain(); }
  bool is_periodic() const override { return base_->is_periodic(); }
  Point point(double t) const override { return map_->point(base_->point(t)); }
  CurveDerivatives derivatives(double t) const override;
  std::vector<double> breaks() const override { return base_->breaks(); }
  const CurvePtr& base() const { return base_; }

 private:
  CurvePtr base_;
  SpaceMapPtr map_;
};

class DeformedSurface final : public Surface {
 public:
  DeformedSurface(SurfacePtr base, SpaceMapPtr map) : base_(std::move(base)), map_(std::move(map)) {}
  ParameterBox domain() const override { return base_->domain(); }
  bool is_periodic_u() const override { return base_->is_periodic_u(); }
  bool is_periodic_v() const override { return base_->is_periodic_v(); }
  Point point(Uv at) const override { return map_->point(base_->point(at)); }
  SurfaceDerivatives derivatives(Uv at) const override;
  void points(std::span<const Uv> at, std::span<Point> points) const override;
  std::vector<double> breaks_u() const override { return base_->breaks_u(); }
  std::vector<double> breaks_v() const override { return base_->breaks_v(); }
  std::string kind() const override { return "deformed " + base_->kind(); }
  const SurfacePtr& base() const { return base_; }

 private:
  SurfacePtr base_;
  SpaceMapPtr map_;
};

}  // namespace sterna
