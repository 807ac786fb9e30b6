#include "scripting/values/model_archive.h"

#include <functional>
#include <type_traits>
#include <utility>

#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/flattened_curve.h"
#include "geom/model/nurbs_curve.h"
#include "geom/model/nurbs_surface.h"
#include "geom/model/swept_surfaces.h"
#include "geom/model/transformed.h"
#include "scripting/values/stored_types.h"

namespace sterna::scripting {
namespace {

/// State of an object in the archive: absent, written before, or new.
enum class Presence : std::uint8_t { none, known, written };

/// A class of curves or surfaces. The constructor makes an equal object of the values of these functions, in their order.
template <class C, auto... Values>
struct KeptClass {
  static bool write(ByteSink& sink, std::uint8_t number, const auto& object) {
    const auto* const kept = dynamic_cast<const C*>(&object);
    if (!kept) return false;
    write_value(sink, number);
    (write_value(sink, std::invoke(Values, *kept)), ...);
    return true;
  }
  static std::shared_ptr<const C> read(ByteSource& source) {
    std::tuple<std::decay_t<std::invoke_result_t<decltype(Values), const C&>>...> values;
    std::apply([&](auto&... value) { (read_value(source, value), ...); }, values);
    return std::apply([](auto&... value) { return std::make_shared<const C>(std::move(value)...); }, values);
  }
};

/// All classes with a common base. An object is stored as the number of its class and the values of the class.
template <class... Kept>
struct KeptClasses {
  static bool write(ByteSink& sink, const auto& object) {
    std::uint8_t number = 0;
    return (Kept::write(sink, number++, object) || ...);
  }
  template <class Base>
  static void read(ByteSource& source, std::shared_ptr<const Base>& object) {
    std::uint8_t number = 0, next = 0;
    read_value(source, number);
    const auto read_if = [&]<class C>() {
      if (next++ == number) object = C::read(source);
    };
    (read_if.template operator()<Kept>(), ...);
    if (!object) source.refuse();
  }
};

Interval angles_of(const RevolutionSurface& surface) { return surface.domain().u; }
Interval range_of(const ExtrusionSurface& surface) { return surface.domain().v; }

using KeptCurves = KeptClasses<KeptClass<LineCurve, &LineCurve::origin, &LineCurve::direction, &LineCurve::domain>,
                               KeptClass<EllipseCurve, &EllipseCurve::centre, &EllipseCurve::x, &EllipseCurve::y, &EllipseCurve::domain>,
                               KeptClass<CurveView, &CurveView::base, &CurveView::domain, &CurveView::scale, &CurveView::shift>,
                               KeptClass<NurbsCurve, &NurbsCurve::form, &NurbsCurve::is_periodic>,
                               KeptClass<TransformedCurve, &TransformedCurve::base, &TransformedCurve::transform>,
                               KeptClass<FlattenedCurve, &FlattenedCurve::base, &FlattenedCurve::axis, &FlattenedCurve::at>>;

using KeptParameterCurves = KeptClasses<KeptClass<ParameterLine, &ParameterLine::origin, &ParameterLine::direction, &ParameterLine::domain>,
                                        KeptClass<ParameterArc, &ParameterArc::centre, &ParameterArc::x, &ParameterArc::y, &ParameterArc::domain>,
                                        KeptClass<NurbsParameterCurve, &NurbsParameterCurve::form>>;

using KeptSurfaces =
    KeptClasses<KeptClass<PlaneSurface, &PlaneSurface::frame, &PlaneSurface::domain>,
                KeptClass<CylinderSurface, &CylinderSurface::frame, &CylinderSurface::radius, &CylinderSurface::domain>,
                KeptClass<ConeSurface, &ConeSurface::frame, &ConeSurface::radius, &ConeSurface::half_angle, &ConeSurface::domain>,
                KeptClass<SphereSurface, &SphereSurface::frame, &SphereSurface::radius, &SphereSurface::domain>,
                KeptClass<TorusSurface, &TorusSurface::frame, &TorusSurface::major_radius, &TorusSurface::minor_radius, &TorusSurface::domain>,
                KeptClass<NurbsSurface, &NurbsSurface::form, &NurbsSurface::is_periodic_u, &NurbsSurface::is_periodic_v, &NurbsSurface::kind>,
                KeptClass<RevolutionSurface, &RevolutionSurface::profile, &RevolutionSurface::axis_point, &RevolutionSurface::axis, &angles_of>,
                KeptClass<ExtrusionSurface, &ExtrusionSurface::curve, &ExtrusionSurface::direction, &range_of>,
                KeptClass<RuledSurface, &RuledSurface::a, &RuledSurface::b>,
                KeptClass<SurfaceView, &SurfaceView::base, &SurfaceView::domain, &SurfaceView::map_u, &SurfaceView::map_v, &SurfaceView::is_exchanged>,
                KeptClass<TransformedSurface, &TransformedSurface::base, &TransformedSurface::transform>>;

void write_object(ByteSink& sink, const Curve& curve) {
  if (!KeptCurves::write(sink, curve)) throw NotKept{"a curve"};
}
void write_object(ByteSink& sink, const ParameterCurve& curve) {
  if (!KeptParameterCurves::write(sink, curve)) throw NotKept{"a curve in a face"};
}
void write_object(ByteSink& sink, const Surface& surface) {
  if (!KeptSurfaces::write(sink, surface)) throw NotKept{surface.kind()};
}
void write_object(ByteSink& sink, const Model& model) { write_value(sink, model); }

void read_object(ByteSource& source, CurvePtr& curve) { KeptCurves::read(source, curve); }
void read_object(ByteSource& source, ParameterCurvePtr& curve) { KeptParameterCurves::read(source, curve); }
void read_object(ByteSource& source, SurfacePtr& surface) { KeptSurfaces::read(source, surface); }
void read_object(ByteSource& source, std::shared_ptr<const Model>& model) {
  auto made = std::make_shared<Model>();
  read_value(source, *made);
  model = std::move(made);
}

}  // namespace

std::shared_ptr<const CadShape> ModelSource::next_shape(bool has_shape) {
  const std::size_t number = n_models_++;
  return has_shape ? shape_of_next_(number) : nullptr;
}

namespace detail {

// An object gets its number among those of its class when it is completely written, because this is the order of reading.
template <class T>
void SharedArchive<T>::write(ByteSink& sink, const std::shared_ptr<const T>& object) {
  auto& numbers = dynamic_cast<ModelSink&>(sink).numbers<T>();
  if (!object) return write_value(sink, Presence::none);
  if (const auto known = numbers.find(object.get()); known != numbers.end()) {
    write_value(sink, Presence::known);
    return write_value(sink, known->second);
  }
  write_value(sink, Presence::written);
  write_object(sink, *object);
  numbers.emplace(object.get(), numbers.size());
}

template <class T>
void SharedArchive<T>::read(ByteSource& source, std::shared_ptr<const T>& object) {
  auto& objects = dynamic_cast<ModelSource&>(source).objects<T>();
  auto presence = Presence::none;
  read_value(source, presence);
  object = nullptr;
  if (presence == Presence::none) return;
  if (presence == Presence::written) {
    read_object(source, object);
    objects.push_back(object);
    return;
  }
  std::uint64_t number = 0;
  read_value(source, number);
  if (presence != Presence::known || number >= objects.size()) source.refuse();
  object = objects[number];
}

template struct SharedArchive<Curve>;
template struct SharedArchive<ParameterCurve>;
template struct SharedArchive<Surface>;
template struct SharedArchive<Model>;

void Archive<std::shared_ptr<const CadShape>>::write(ByteSink& sink, const std::shared_ptr<const CadShape>& shape) { write_value(sink, shape != nullptr); }

void Archive<std::shared_ptr<const CadShape>>::read(ByteSource& source, std::shared_ptr<const CadShape>& shape) {
  bool has_shape = false;
  read_value(source, has_shape);
  shape = dynamic_cast<ModelSource&>(source).next_shape(has_shape);
}

}  // namespace detail
}  // namespace sterna::scripting
