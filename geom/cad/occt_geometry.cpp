// Parameters are the same on both sides, so parameter curves of a face are valid for both evaluators.
#include "geom/cad/occt_geometry.h"

#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <Geom2d_Circle.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TColgp_Array2OfPnt.hxx>

#include <algorithm>
#include <cmath>

#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/frame.h"
#include "geom/model/nurbs_curve.h"
#include "geom/model/nurbs_surface.h"
#include "geom/model/swept_surfaces.h"

namespace sterna::cad {
namespace {

Point to_point(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }
Vec3 to_vec(const gp_Vec& v) { return {v.X(), v.Y(), v.Z()}; }
Uv to_uv(const gp_Pnt2d& p) { return {p.X(), p.Y()}; }
gp_Pnt to_gp(const Point& p) { return {p.x, p.y, p.z}; }
gp_Pnt2d to_gp(Uv p) { return {p.u, p.v}; }

/// Returns the knots repeated by multiplicity, from distinct knots and multiplicities (arrays from 1).
std::vector<double> flat_knots(const TColStd_Array1OfReal& knots, const TColStd_Array1OfInteger& counts) {
  std::vector<double> flat;
  for (int i = knots.Lower(); i <= knots.Upper(); ++i) flat.insert(flat.end(), static_cast<std::size_t>(counts(i)), knots(i));
  return flat;
}

std::vector<double> weights_unless_equal(std::vector<double> weights) {
  if (std::all_of(weights.begin(), weights.end(), [&](double w) { return w == weights.front(); })) return {};
  return weights;
}

/// Distinct knots and their multiplicities.
struct KnotList {
  TColStd_Array1OfReal knots;
  TColStd_Array1OfInteger counts;
};
KnotList knot_list(const std::vector<double>& flat) {
  std::vector<double> values;
  std::vector<int> counts;
  for (const double knot : flat) {
    if (values.empty() || values.back() != knot) {
      values.push_back(knot);
      counts.push_back(0);
    }
    ++counts.back();
  }
  const int n = static_cast<int>(values.size());
  KnotList list{TColStd_Array1OfReal(1, n), TColStd_Array1OfInteger(1, n)};
  for (int i = 0; i < n; ++i) {
    list.knots(i + 1) = values[static_cast<std::size_t>(i)];
    list.counts(i + 1) = counts[static_cast<std::size_t>(i)];
  }
  return list;
}

template <class Spline, class Array, class P>
Handle(Spline) spline_of(const NurbsCurveForm<P>& form) {
  const int n = static_cast<int>(form.poles.size());
  Array poles(1, n);
  for (int i = 0; i < n; ++i) poles(i + 1) = to_gp(form.poles[static_cast<std::size_t>(i)]);
  const KnotList knots = knot_list(form.knots);
  if (form.weights.empty()) return new Spline(poles, knots.knots, knots.counts, form.degree);
  TColStd_Array1OfReal weights(1, n);
  for (int i = 0; i < n; ++i) weights(i + 1) = form.weights[static_cast<std::size_t>(i)];
  return new Spline(poles, weights, knots.knots, knots.counts, form.degree);
}

/// Converts the pieces of a B-spline or Bezier curve to our form.
template <class P, class Spline, class Convert>
NurbsCurveForm<P> form_of_spline(const Spline& spline, const Convert& convert) {
  NurbsCurveForm<P> form{.degree = spline.Degree(), .knots = flat_knots(spline.Knots(), spline.Multiplicities()), .poles = {}, .weights = {}};
  for (int i = 1; i <= spline.NbPoles(); ++i) {
    form.poles.push_back(convert(spline.Pole(i)));
    form.weights.push_back(spline.Weight(i));
  }
  form.weights = weights_unless_equal(std::move(form.weights));
  return form;
}
template <class P, class Bezier, class Convert>
NurbsCurveForm<P> form_of_bezier(const Bezier& bezier, const Convert& convert) {
  NurbsCurveForm<P> form{.degree = bezier.Degree(), .knots = {}, .poles = {}, .weights = {}};
  const std::size_t n = static_cast<std::size_t>(bezier.NbPoles());
  form.knots.assign(n, 0.0);
  form.knots.resize(2 * n, 1.0);
  for (int i = 1; i <= bezier.NbPoles(); ++i) {
    form.poles.push_back(convert(bezier.Pole(i)));
    form.weights.push_back(bezier.Weight(i));
  }
  form.weights = weights_unless_equal(std::move(form.weights));
  return form;
}
Interval clamped(double from, double to, Interval range) {
  return {Precision::IsInfinite(from) ? range.from : from, Precision::IsInfinite(to) ? range.to : to};
}

/// Our NURBS have fully clamped knots: degree + 1 equal knots at each end. OpenCASCADE allows fewer.
bool is_clamped(const std::vector<double>& knots, int degree) {
  const std::size_t n = static_cast<std::size_t>(degree) + 1;
  return knots.size() >= 2 * n && knots[n - 1] == knots.front() && knots[knots.size() - n] == knots.back();
}

/// A curve of a kind without our own type. Geom classes evaluate without their own caches, so that many threads may call it.
class OcctCurve final : public Curve {
 public:
  OcctCurve(Handle(Geom_Curve) curve, Interval range) : curve_(std::move(curve)), domain_(clamped(curve_->FirstParameter(), curve_->LastParameter(), range)) {}
  const Handle(Geom_Curve) & geom() const { return curve_; }
  Interval domain() const override { return domain_; }
  bool is_periodic() const override { return curve_->IsPeriodic(); }
  Point point(double t) const override { return to_point(curve_->Value(t)); }
  CurveDerivatives derivatives(double t) const override {
    gp_Pnt p;
    gp_Vec d1, d2;
    curve_->D2(t, p, d1, d2);
    return {to_point(p), to_vec(d1), to_vec(d2)};
  }

 private:
  Handle(Geom_Curve) curve_;
  Interval domain_;
};

class OcctParameterCurve final : public ParameterCurve {
 public:
  OcctParameterCurve(Handle(Geom2d_Curve) curve, Interval range)
      : curve_(std::move(curve)), domain_(clamped(curve_->FirstParameter(), curve_->LastParameter(), range)) {}
  const Handle(Geom2d_Curve) & geom() const { return curve_; }
  Interval domain() const override { return domain_; }
  Uv point(double t) const override { return to_uv(curve_->Value(t)); }
  ParameterCurveDerivatives derivatives(double t) const override {
    gp_Pnt2d p;
    gp_Vec2d d;
    curve_->D1(t, p, d);
    return {to_uv(p), {d.X(), d.Y()}};
  }

 private:
  Handle(Geom2d_Curve) curve_;
  Interval domain_;
};

/// Step of the differences used where OpenCASCADE has no derivative (offset surfaces at poles), as a fraction of the domain: third root of the rounding unit,
/// rounded.
constexpr double k_difference_step = 1e-5;

/// Offset surfaces and others without our own type.
class OcctSurface final : public Surface {
 public:
  OcctSurface(Handle(Geom_Surface) surface, const ParameterBox& box) : surface_(std::move(surface)) {
    double u1 = 0.0, u2 = 0.0, v1 = 0.0, v2 = 0.0;
    surface_->Bounds(u1, u2, v1, v2);
    domain_ = {clamped(u1, u2, box.u), clamped(v1, v2, box.v)};
  }
  const Handle(Geom_Surface) & geom() const { return surface_; }
  ParameterBox domain() const override { return domain_; }
  bool is_periodic_u() const override { return surface_->IsUPeriodic(); }
  bool is_periodic_v() const override { return surface_->IsVPeriodic(); }
  Point point(Uv at) const override { return to_point(surface_->Value(at.u, at.v)); }
  SurfaceDerivatives derivatives(Uv at) const override {
    gp_Pnt p;
    gp_Vec du, dv, duu, duv, dvv;
    try {
      surface_->D2(at.u, at.v, p, du, dv, duu, dvv, duv);
    } catch (const Standard_Failure&) {  // Geom_UndefinedDerivative
      return differences(at);
    }
    return {to_point(p), to_vec(du), to_vec(dv), to_vec(duu), to_vec(duv), to_vec(dvv)};
  }
  std::string kind() const override { return surface_->DynamicType()->Name(); }

 private:
  SurfaceDerivatives differences(Uv at) const {
    const double hu = k_difference_step * domain_.u.length(), hv = k_difference_step * domain_.v.length();
    const auto s = [&](int i, int j) { return point({at.u + i * hu, at.v + j * hv}); };
    const Point p = s(0, 0);
    return {p,
            (s(1, 0) - s(-1, 0)) / (2.0 * hu),
            (s(0, 1) - s(0, -1)) / (2.0 * hv),
            (s(1, 0) - 2.0 * p + s(-1, 0)) / (hu * hu),
            (s(1, 1) - s(1, -1) - s(-1, 1) + s(-1, -1)) / (4.0 * hu * hv),
            (s(0, 1) - 2.0 * p + s(0, -1)) / (hv * hv)};
  }

  Handle(Geom_Surface) surface_;
  ParameterBox domain_;
};

NurbsSurfaceForm form_of(const Geom_BSplineSurface& spline) {
  NurbsSurfaceForm form;
  form.degree_u = spline.UDegree();
  form.degree_v = spline.VDegree();
  form.knots_u = flat_knots(spline.UKnots(), spline.UMultiplicities());
  form.knots_v = flat_knots(spline.VKnots(), spline.VMultiplicities());
  form.n_u = static_cast<std::size_t>(spline.NbUPoles());
  form.n_v = static_cast<std::size_t>(spline.NbVPoles());
  for (int i = 1; i <= spline.NbUPoles(); ++i)
    for (int j = 1; j <= spline.NbVPoles(); ++j) {
      form.poles.push_back(to_point(spline.Pole(i, j)));
      form.weights.push_back(spline.Weight(i, j));
    }
  form.weights = weights_unless_equal(std::move(form.weights));
  return form;
}

NurbsSurfaceForm form_of(const Geom_BezierSurface& bezier) {
  NurbsSurfaceForm form;
  form.degree_u = bezier.UDegree();
  form.degree_v = bezier.VDegree();
  form.n_u = static_cast<std::size_t>(bezier.NbUPoles());
  form.n_v = static_cast<std::size_t>(bezier.NbVPoles());
  form.knots_u.assign(form.n_u, 0.0);
  form.knots_u.resize(2 * form.n_u, 1.0);
  form.knots_v.assign(form.n_v, 0.0);
  form.knots_v.resize(2 * form.n_v, 1.0);
  for (int i = 1; i <= bezier.NbUPoles(); ++i)
    for (int j = 1; j <= bezier.NbVPoles(); ++j) {
      form.poles.push_back(to_point(bezier.Pole(i, j)));
      form.weights.push_back(bezier.Weight(i, j));
    }
  form.weights = weights_unless_equal(std::move(form.weights));
  return form;
}

Frame frame_of(const gp_Ax3& axes) {
  const auto v = [](const gp_Dir& d) { return Vec3{d.X(), d.Y(), d.Z()}; };
  return {to_point(axes.Location()), v(axes.XDirection()), v(axes.YDirection()), v(axes.Direction())};
}
gp_Dir to_dir(const Vec3& v) { return {v.x, v.y, v.z}; }
gp_Ax3 axes_of(const Frame& frame) {
  gp_Ax3 axes(to_gp(frame.origin), to_dir(frame.z), to_dir(frame.x));
  if (dot(cross(frame.x, frame.y), frame.z) < 0.0) axes.YReverse();
  return axes;
}

/// Directions and radii that differ by less are treated as equal (rounding).
constexpr double k_equal = 1e-14;

}  // namespace

CurvePtr curve_of(const Handle(Geom_Curve) & curve, Interval range) {
  // A trimmed curve has the parameters of its basis; the edge's range selects the part.
  if (const Handle(Geom_TrimmedCurve) trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve); !trimmed.IsNull()) return curve_of(trimmed->BasisCurve(), range);
  if (const Handle(Geom_Line) line = Handle(Geom_Line)::DownCast(curve); !line.IsNull() && range.length() > 0.0)
    return std::make_shared<LineCurve>(to_point(line->Lin().Location()), to_vec(gp_Vec(line->Lin().Direction())), range);
  const auto ellipse = [&](const gp_Ax2& axes, double major, double minor) {
    return std::make_shared<EllipseCurve>(to_point(axes.Location()), major * to_vec(gp_Vec(axes.XDirection())), minor * to_vec(gp_Vec(axes.YDirection())),
                                          k_full_turn);
  };
  if (const Handle(Geom_Circle) circle = Handle(Geom_Circle)::DownCast(curve); !circle.IsNull())
    return ellipse(circle->Position(), circle->Radius(), circle->Radius());
  if (const Handle(Geom_Ellipse) oval = Handle(Geom_Ellipse)::DownCast(curve); !oval.IsNull())
    return ellipse(oval->Position(), oval->MajorRadius(), oval->MinorRadius());
  if (const Handle(Geom_BezierCurve) bezier = Handle(Geom_BezierCurve)::DownCast(curve); !bezier.IsNull())
    return std::make_shared<NurbsCurve>(form_of_bezier<Point>(*bezier, to_point));
  if (Handle(Geom_BSplineCurve) spline = Handle(Geom_BSplineCurve)::DownCast(curve); !spline.IsNull()) {
    const bool is_periodic = spline->IsPeriodic();
    if (is_periodic) {
      spline = Handle(Geom_BSplineCurve)::DownCast(spline->Copy());
      spline->SetNotPeriodic();
    }
    NurbsCurveForm<Point> form = form_of_spline<Point>(*spline, to_point);
    if (is_clamped(form.knots, form.degree)) return std::make_shared<NurbsCurve>(std::move(form), is_periodic);
  }
  return std::make_shared<OcctCurve>(curve, range);
}

ParameterCurvePtr parameter_curve_of(const Handle(Geom2d_Curve) & curve, Interval range) {
  if (const Handle(Geom2d_TrimmedCurve) trimmed = Handle(Geom2d_TrimmedCurve)::DownCast(curve); !trimmed.IsNull())
    return parameter_curve_of(trimmed->BasisCurve(), range);
  const auto direction = [](const gp_Dir2d& d) { return Uv{d.X(), d.Y()}; };
  if (const Handle(Geom2d_Line) line = Handle(Geom2d_Line)::DownCast(curve); !line.IsNull() && range.length() > 0.0)
    return std::make_shared<ParameterLine>(to_uv(line->Location()), direction(line->Direction()), range);
  const auto arc = [&](const gp_Ax22d& axes, double major, double minor) {
    return std::make_shared<ParameterArc>(to_uv(axes.Location()), major * direction(axes.XDirection()), minor * direction(axes.YDirection()), k_full_turn);
  };
  if (const Handle(Geom2d_Circle) circle = Handle(Geom2d_Circle)::DownCast(curve); !circle.IsNull())
    return arc(circle->Position(), circle->Radius(), circle->Radius());
  if (const Handle(Geom2d_Ellipse) oval = Handle(Geom2d_Ellipse)::DownCast(curve); !oval.IsNull())
    return arc(oval->Position(), oval->MajorRadius(), oval->MinorRadius());
  if (const Handle(Geom2d_BezierCurve) bezier = Handle(Geom2d_BezierCurve)::DownCast(curve); !bezier.IsNull())
    return std::make_shared<NurbsParameterCurve>(form_of_bezier<Uv>(*bezier, to_uv));
  if (const Handle(Geom2d_BSplineCurve) spline = Handle(Geom2d_BSplineCurve)::DownCast(curve); !spline.IsNull() && !spline->IsPeriodic()) {
    NurbsCurveForm<Uv> form = form_of_spline<Uv>(*spline, to_uv);
    if (is_clamped(form.knots, form.degree)) return std::make_shared<NurbsParameterCurve>(std::move(form));
  }
  return std::make_shared<OcctParameterCurve>(curve, range);
}

SurfacePtr surface_of(const Handle(Geom_Surface) & surface, const ParameterBox& box) {
  if (const Handle(Geom_RectangularTrimmedSurface) trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface); !trimmed.IsNull())
    return surface_of(trimmed->BasisSurface(), box);
  if (const Handle(Geom_Plane) plane = Handle(Geom_Plane)::DownCast(surface); !plane.IsNull())
    return std::make_shared<PlaneSurface>(frame_of(plane->Position()), box);
  const ParameterBox turn{k_full_turn, box.v};
  if (const Handle(Geom_CylindricalSurface) round = Handle(Geom_CylindricalSurface)::DownCast(surface); !round.IsNull())
    return std::make_shared<CylinderSurface>(frame_of(round->Position()), round->Radius(), turn);
  if (const Handle(Geom_ConicalSurface) round = Handle(Geom_ConicalSurface)::DownCast(surface); !round.IsNull())
    return std::make_shared<ConeSurface>(frame_of(round->Position()), round->RefRadius(), round->SemiAngle(), turn);
  if (const Handle(Geom_SphericalSurface) round = Handle(Geom_SphericalSurface)::DownCast(surface); !round.IsNull())
    return std::make_shared<SphereSurface>(frame_of(round->Position()), round->Radius());
  if (const Handle(Geom_ToroidalSurface) round = Handle(Geom_ToroidalSurface)::DownCast(surface); !round.IsNull())
    return std::make_shared<TorusSurface>(frame_of(round->Position()), round->MajorRadius(), round->MinorRadius());
  if (const Handle(Geom_SurfaceOfRevolution) swept = Handle(Geom_SurfaceOfRevolution)::DownCast(surface); !swept.IsNull())
    return std::make_shared<RevolutionSurface>(curve_of(swept->BasisCurve(), box.v), to_point(swept->Location()), to_vec(gp_Vec(swept->Direction())),
                                               k_full_turn);
  if (const Handle(Geom_SurfaceOfLinearExtrusion) swept = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(surface); !swept.IsNull())
    return std::make_shared<ExtrusionSurface>(curve_of(swept->BasisCurve(), box.u), to_vec(gp_Vec(swept->Direction())), box.v);
  if (const Handle(Geom_BezierSurface) bezier = Handle(Geom_BezierSurface)::DownCast(surface); !bezier.IsNull())
    return std::make_shared<NurbsSurface>(form_of(*bezier));
  if (Handle(Geom_BSplineSurface) spline = Handle(Geom_BSplineSurface)::DownCast(surface); !spline.IsNull()) {
    const bool is_periodic_u = spline->IsUPeriodic(), is_periodic_v = spline->IsVPeriodic();
    if (is_periodic_u || is_periodic_v) {
      spline = Handle(Geom_BSplineSurface)::DownCast(spline->Copy());
      if (is_periodic_u) spline->SetUNotPeriodic();
      if (is_periodic_v) spline->SetVNotPeriodic();
    }
    NurbsSurfaceForm form = form_of(*spline);
    if (!is_clamped(form.knots_u, form.degree_u) || !is_clamped(form.knots_v, form.degree_v)) {
      spline = Handle(Geom_BSplineSurface)::DownCast(spline->Copy());
      double u1 = 0.0, u2 = 0.0, v1 = 0.0, v2 = 0.0;
      spline->Bounds(u1, u2, v1, v2);
      spline->Segment(u1, u2, v1, v2);  // inserts missing end knots
      form = form_of(*spline);
    }
    if (is_clamped(form.knots_u, form.degree_u) && is_clamped(form.knots_v, form.degree_v))
      return std::make_shared<NurbsSurface>(std::move(form), is_periodic_u, is_periodic_v);
  }
  return std::make_shared<OcctSurface>(surface, box);
}

Handle(Geom_Curve) geom_of(const Curve& curve) {
  if (const auto* wrapped = dynamic_cast<const OcctCurve*>(&curve)) return wrapped->geom();
  if (const auto* line = dynamic_cast<const LineCurve*>(&curve); line && std::abs(norm(line->direction()) - 1.0) <= k_equal)
    return new Geom_Line(to_gp(line->origin()), to_dir(line->direction()));
  if (const auto* ellipse = dynamic_cast<const EllipseCurve*>(&curve)) {
    const double major = norm(ellipse->x()), minor = norm(ellipse->y());
    const gp_Ax2 axes(to_gp(ellipse->centre()), to_dir(cross(ellipse->x(), ellipse->y())), to_dir(ellipse->x()));
    if (std::abs(major - minor) <= k_equal * major) return new Geom_Circle(axes, major);
    if (major > minor) return new Geom_Ellipse(axes, major, minor);
    return {};  // the parameter of OpenCASCADE's ellipse starts at its major axis
  }
  if (const auto form = curve.exact_nurbs()) return spline_of<Geom_BSplineCurve, TColgp_Array1OfPnt>(*form);
  return {};
}

Handle(Geom2d_Curve) geom_of(const ParameterCurve& curve) {
  if (const auto* wrapped = dynamic_cast<const OcctParameterCurve*>(&curve)) return wrapped->geom();
  if (const auto* line = dynamic_cast<const ParameterLine*>(&curve); line && std::abs(std::hypot(line->direction().u, line->direction().v) - 1.0) <= k_equal)
    return new Geom2d_Line(to_gp(line->origin()), gp_Dir2d(line->direction().u, line->direction().v));
  if (const auto* arc = dynamic_cast<const ParameterArc*>(&curve)) {
    const Uv x = arc->x(), y = arc->y();
    const double major = std::hypot(x.u, x.v), minor = std::hypot(y.u, y.v);
    if (std::abs(x.u * y.u + x.v * y.v) > k_equal * major * minor) return {};
    const gp_Ax22d axes(to_gp(arc->centre()), gp_Dir2d(x.u, x.v), gp_Dir2d(y.u, y.v));
    if (std::abs(major - minor) <= k_equal * major) return new Geom2d_Circle(axes, major);
    if (major > minor) return new Geom2d_Ellipse(axes, major, minor);
    return {};
  }
  if (const auto form = curve.exact_nurbs()) return spline_of<Geom2d_BSplineCurve, TColgp_Array1OfPnt2d>(*form);
  return {};
}

/// Returns planes and round surfaces; null for others.
static Handle(Geom_Surface) analytic_of(const Surface& surface) {
  if (const auto* plane = dynamic_cast<const PlaneSurface*>(&surface)) return new Geom_Plane(axes_of(plane->frame()));
  if (const auto* round = dynamic_cast<const CylinderSurface*>(&surface)) return new Geom_CylindricalSurface(axes_of(round->frame()), round->radius());
  if (const auto* round = dynamic_cast<const ConeSurface*>(&surface))
    return new Geom_ConicalSurface(axes_of(round->frame()), round->half_angle(), round->radius());
  if (const auto* round = dynamic_cast<const SphereSurface*>(&surface)) return new Geom_SphericalSurface(axes_of(round->frame()), round->radius());
  if (const auto* round = dynamic_cast<const TorusSurface*>(&surface)) {
    const Frame& f = round->frame();
    if (round->major_radius() >= round->minor_radius()) return new Geom_ToroidalSurface(axes_of(f), round->major_radius(), round->minor_radius());
    // A spindle torus: OpenCASCADE's STEP writer would approximate it as a torus; the revolved circle has the same parameters.
    const gp_Ax2 circle(to_gp(f.origin + round->major_radius() * f.x), to_dir(cross(f.x, f.z)), to_dir(f.x));
    return new Geom_SurfaceOfRevolution(new Geom_Circle(circle, round->minor_radius()), gp_Ax1(to_gp(f.origin), to_dir(cross(f.x, f.y))));
  }
  if (const auto* swept = dynamic_cast<const RevolutionSurface*>(&surface)) {
    const Handle(Geom_Curve) profile = geom_of(*swept->profile());
    if (!profile.IsNull()) return new Geom_SurfaceOfRevolution(profile, gp_Ax1(to_gp(swept->axis_point()), to_dir(swept->axis())));
  }
  if (const auto* swept = dynamic_cast<const ExtrusionSurface*>(&surface); swept && std::abs(norm(swept->direction()) - 1.0) <= k_equal) {
    const Handle(Geom_Curve) base = geom_of(*swept->curve());
    if (!base.IsNull()) return new Geom_SurfaceOfLinearExtrusion(base, to_dir(swept->direction()));
  }
  return {};
}

Handle(Geom_Surface) geom_of(const Surface& surface) {
  if (const auto* wrapped = dynamic_cast<const OcctSurface*>(&surface)) return wrapped->geom();
  if (const Handle(Geom_Surface) analytic = analytic_of(surface); !analytic.IsNull()) return analytic;
  const auto form = surface.exact_nurbs();
  if (!form) return {};
  const int n_u = static_cast<int>(form->n_u), n_v = static_cast<int>(form->n_v);
  TColgp_Array2OfPnt poles(1, n_u, 1, n_v);
  TColStd_Array2OfReal weights(1, n_u, 1, n_v);
  weights.Init(1.0);
  for (int i = 0; i < n_u; ++i)
    for (int j = 0; j < n_v; ++j) {
      const std::size_t k = static_cast<std::size_t>(i) * form->n_v + static_cast<std::size_t>(j);
      poles(i + 1, j + 1) = to_gp(form->poles[k]);
      if (!form->weights.empty()) weights(i + 1, j + 1) = form->weights[k];
    }
  const KnotList u = knot_list(form->knots_u), v = knot_list(form->knots_v);
  if (form->weights.empty()) return new Geom_BSplineSurface(poles, u.knots, v.knots, u.counts, v.counts, form->degree_u, form->degree_v);
  return new Geom_BSplineSurface(poles, weights, u.knots, v.knots, u.counts, v.counts, form->degree_u, form->degree_v);
}

}  // namespace sterna::cad
