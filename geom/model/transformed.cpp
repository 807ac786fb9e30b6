#include "geom/model/transformed.h"

#include <cmath>

#include "geom/base/error.h"
#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/nurbs_curve.h"
#include "geom/model/nurbs_surface.h"
#include "geom/model/swept_surfaces.h"

namespace sterna {
namespace {

void check(const Transform& t) {
  if (!(std::abs(t.determinant()) > 0.0) || !is_finite(t.x) || !is_finite(t.y) || !is_finite(t.z) || !is_finite(t.shift))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "transforming geometry",
                 .problem = "the transformation flattens space (its determinant is 0) or is not finite"});
}

template <class Form>
Form transformed_form(Form form, const Transform& t) {
  for (Point& p : form.poles) p = t.point(p);
  return form;
}

/// \pre t is a similarity
Frame transformed_frame(const Frame& frame, const Transform& t) {
  return {t.point(frame.origin), normalized(t.vector(frame.x)), normalized(t.vector(frame.y)), normalized(t.vector(frame.z))};
}

Interval scaled(Interval range, double s) { return {s * range.from, s * range.to}; }

/// Restores the parameters of a surface if some of them are lengths and were scaled (v of a cylinder). A view removes the factor.
SurfacePtr with_old_parameters(SurfacePtr surface, const ParameterBox& box, double scale_u, double scale_v) {
  if (scale_u == 1.0 && scale_v == 1.0) return surface;
  return std::make_shared<SurfaceView>(std::move(surface), box, SurfaceView::Map{scale_u, 0.0}, SurfaceView::Map{scale_v, 0.0});
}

/// Returns the transformed surface if its type has a frame, under a similarity; empty for other types.
SurfacePtr transformed_analytic(const Surface& surface, const Transform& t) {
  constexpr double k_same_size = 1e-14;  // rounding of a rotation's matrix
  const double s = std::abs(t.scale() - 1.0) <= k_same_size ? 1.0 : t.scale();
  const ParameterBox box = surface.domain();
  if (const auto* plane = dynamic_cast<const PlaneSurface*>(&surface))
    return with_old_parameters(std::make_shared<PlaneSurface>(transformed_frame(plane->frame(), t), ParameterBox{scaled(box.u, s), scaled(box.v, s)}), box, s,
                               s);
  if (const auto* cylinder = dynamic_cast<const CylinderSurface*>(&surface))
    return with_old_parameters(
        std::make_shared<CylinderSurface>(transformed_frame(cylinder->frame(), t), s * cylinder->radius(), ParameterBox{box.u, scaled(box.v, s)}), box, 1.0, s);
  if (const auto* cone = dynamic_cast<const ConeSurface*>(&surface))
    return with_old_parameters(
        std::make_shared<ConeSurface>(transformed_frame(cone->frame(), t), s * cone->radius(), cone->half_angle(), ParameterBox{box.u, scaled(box.v, s)}), box,
        1.0, s);
  if (const auto* sphere = dynamic_cast<const SphereSurface*>(&surface))
    return std::make_shared<SphereSurface>(transformed_frame(sphere->frame(), t), s * sphere->radius(), box);
  if (const auto* torus = dynamic_cast<const TorusSurface*>(&surface))
    return std::make_shared<TorusSurface>(transformed_frame(torus->frame(), t), s * torus->major_radius(), s * torus->minor_radius(), box);
  if (const auto* turned = dynamic_cast<const RevolutionSurface*>(&surface)) {
    const double sense = t.determinant() < 0.0 ? -1.0 : 1.0;  // a mirror reverses the sense of rotation
    return std::make_shared<RevolutionSurface>(transformed(turned->profile(), t), t.point(turned->axis_point()), sense * t.vector(turned->axis()), box.u);
  }
  return nullptr;
}

}  // namespace

CurveDerivatives TransformedCurve::derivatives(double t) const {
  const CurveDerivatives d = base_->derivatives(t);
  return {transform_.point(d.point), transform_.vector(d.first), transform_.vector(d.second)};
}

std::optional<NurbsCurveForm<Point>> TransformedCurve::exact_nurbs() const {
  const auto form = base_->exact_nurbs();
  if (!form) return std::nullopt;
  return transformed_form(*form, transform_);
}

SurfaceDerivatives TransformedSurface::derivatives(Uv at) const {
  const SurfaceDerivatives d = base_->derivatives(at);
  return {transform_.point(d.point), transform_.vector(d.du),  transform_.vector(d.dv),
          transform_.vector(d.duu),  transform_.vector(d.duv), transform_.vector(d.dvv)};
}

void TransformedSurface::points(std::span<const Uv> at, std::span<Point> points) const {
  base_->points(at, points);
  for (Point& p : points) p = transform_.point(p);
}

std::optional<NurbsSurfaceForm> TransformedSurface::exact_nurbs() const {
  const auto form = base_->exact_nurbs();
  if (!form) return std::nullopt;
  return transformed_form(*form, transform_);
}

CurvePtr transformed(const CurvePtr& curve, const Transform& t) {
  check(t);
  if (t == Transform{}) return curve;
  if (const auto* nurbs = dynamic_cast<const NurbsCurve*>(curve.get()))
    return std::make_shared<NurbsCurve>(transformed_form(nurbs->form(), t), nurbs->is_periodic());
  if (const auto* line = dynamic_cast<const LineCurve*>(curve.get()))
    return std::make_shared<LineCurve>(t.point(line->origin()), t.vector(line->direction()), line->domain());
  if (const auto* view = dynamic_cast<const CurveView*>(curve.get()))
    return std::make_shared<CurveView>(transformed(view->base(), t), view->domain(), view->scale(), view->shift());
  if (const auto* wrapped = dynamic_cast<const TransformedCurve*>(curve.get())) return transformed(wrapped->base(), t * wrapped->transform());
  if (const auto* ellipse = dynamic_cast<const EllipseCurve*>(curve.get()); ellipse && t.is_similarity())
    return std::make_shared<EllipseCurve>(t.point(ellipse->centre()), t.vector(ellipse->x()), t.vector(ellipse->y()), ellipse->domain());
  return std::make_shared<TransformedCurve>(curve, t);
}

SurfacePtr transformed(const SurfacePtr& surface, const Transform& t) {
  check(t);
  if (t == Transform{}) return surface;
  const Surface* s = surface.get();
  if (const auto* nurbs = dynamic_cast<const NurbsSurface*>(s))
    return std::make_shared<NurbsSurface>(transformed_form(nurbs->form(), t), nurbs->is_periodic_u(), nurbs->is_periodic_v(), nurbs->kind());
  if (const auto* extrusion = dynamic_cast<const ExtrusionSurface*>(s))
    return std::make_shared<ExtrusionSurface>(transformed(extrusion->curve(), t), t.vector(extrusion->direction()), extrusion->domain().v);
  if (const auto* ruled = dynamic_cast<const RuledSurface*>(s)) return std::make_shared<RuledSurface>(transformed(ruled->a(), t), transformed(ruled->b(), t));
  if (const auto* view = dynamic_cast<const SurfaceView*>(s))
    return std::make_shared<SurfaceView>(transformed(view->base(), t), view->domain(), view->map_u(), view->map_v(), view->is_exchanged());
  if (const auto* wrapped = dynamic_cast<const TransformedSurface*>(s)) return transformed(wrapped->base(), t * wrapped->transform());
  if (t.is_similarity())
    if (SurfacePtr result = transformed_analytic(*s, t)) return result;
  return std::make_shared<TransformedSurface>(surface, t);
}

}  // namespace sterna
