// Moved, rotated, scaled and mirrored curves and surfaces; parameters are unchanged, so parameter curves stay valid.
#pragma once

#include "geom/model/curve.h"
#include "geom/model/frame.h"
#include "geom/model/surface.h"

namespace sterna {

/// Returns T(C(t)). Poles and frames are transformed where the type allows it: NURBS and lines by any map, circles by similarities. Other curves are wrapped. A
/// mirror reverses the normal du x dv of a surface relative to its image, so faces change `is_reversed`.
/// \throws Error(bad_argument) if T is singular
CurvePtr transformed(const CurvePtr& curve, const Transform& transform);
SurfacePtr transformed(const SurfacePtr& surface, const Transform& transform);

/// The curve T(C(t)), for any curve.
class TransformedCurve final : public Curve {
 public:
  TransformedCurve(CurvePtr base, const Transform& transform) : base_(std::move(base)), transform_(transform) {}
  Interval domain() const override { return base_->domain(); }
  bool is_periodic() const override { return base_->is_periodic(); }
  Point point(double t) const override { return transform_.point(base_->point(t)); }
  CurveDerivatives derivatives(double t) const override;
  std::vector<double> breaks() const override { return base_->breaks(); }
  std::optional<NurbsCurveForm<Point>> exact_nurbs() const override;
  const CurvePtr& base() const { return base_; }
  const Transform& transform() const { return transform_; }

 private:
  CurvePtr base_;
  Transform transform_;
};

/// The surface T(S(u, v)), for any surface.
class TransformedSurface final : public Surface {
 public:
  TransformedSurface(SurfacePtr base, const Transform& transform) : base_(std::move(base)), transform_(transform) {}
  ParameterBox domain() const override { return base_->domain(); }
  bool is_periodic_u() const override { return base_->is_periodic_u(); }
  bool is_periodic_v() const override { return base_->is_periodic_v(); }
  Point point(Uv at) const override { return transform_.point(base_->point(at)); }
  SurfaceDerivatives derivatives(Uv at) const override;
  void points(std::span<const Uv> at, std::span<Point> points) const override;
  std::vector<double> breaks_u() const override { return base_->breaks_u(); }
  std::vector<double> breaks_v() const override { return base_->breaks_v(); }
  std::optional<NurbsSurfaceForm> exact_nurbs() const override;
  std::string kind() const override { return base_->kind(); }
  const SurfacePtr& base() const { return base_; }
  const Transform& transform() const { return transform_; }

 private:
  SurfacePtr base_;
  Transform transform_;
};

}  // namespace sterna
