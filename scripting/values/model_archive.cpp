#include "scripting/values/model_archive.h"

#include <optional>

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
enum class CurveKind : std::uint8_t { line, ellipse, view, nurbs, transformed, flattened };
enum class ParameterCurveKind : std::uint8_t { line, arc, nurbs };
enum class SurfaceKind : std::uint8_t { plane, cylinder, cone, sphere, torus, nurbs, revolution, extrusion, ruled, view, transformed };

template <class... T>
void write_all(ByteSink& sink, const T&... values) {
  (write_value(sink, values), ...);
}
template <class T>
T take(ByteSource& source) {
  T value{};
  read_value(source, value);
  return value;
}
}  // namespace

// ---- Writing -------------------------------------------------------------------------------------------------------------------------------

template <class T>
bool ModelWriter::is_known(const std::shared_ptr<const T>& object) {
  const auto location = object ? known_.find(object.get()) : known_.end();
  write_value(sink_, !object ? Presence::none : location != known_.end() ? Presence::known : Presence::written);
  if (location != known_.end()) write_value(sink_, location->second);
  return !object || location != known_.end();
}

// An object gets its number among those of its class when it is completely written, because this is the order of reading.
void ModelWriter::curve(const CurvePtr& curve) {
  if (is_known(curve)) return;
  content(*curve);
  known_.emplace(curve.get(), n_curves_++);
}
void ModelWriter::parameter_curve(const ParameterCurvePtr& curve) {
  if (is_known(curve)) return;
  content(*curve);
  known_.emplace(curve.get(), n_parameter_curves_++);
}
void ModelWriter::surface(const SurfacePtr& surface) {
  if (is_known(surface)) return;
  content(*surface);
  known_.emplace(surface.get(), n_surfaces_++);
}
void ModelWriter::shared(const std::shared_ptr<const Model>& model) {
  if (is_known(model)) return;
  this->model(*model);
  known_.emplace(model.get(), n_models_++);
}

void ModelWriter::content(const Curve& of) {
  if (const auto* line = dynamic_cast<const LineCurve*>(&of)) write_all(sink_, CurveKind::line, line->origin(), line->direction(), line->domain());
  else if (const auto* ellipse = dynamic_cast<const EllipseCurve*>(&of))
    write_all(sink_, CurveKind::ellipse, ellipse->centre(), ellipse->x(), ellipse->y(), ellipse->domain());
  else if (const auto* view = dynamic_cast<const CurveView*>(&of)) {
    write_all(sink_, CurveKind::view, view->domain(), view->scale(), view->shift());
    curve(view->base());
  } else if (const auto* nurbs = dynamic_cast<const NurbsCurve*>(&of)) write_all(sink_, CurveKind::nurbs, nurbs->form(), nurbs->is_periodic());
  else if (const auto* moved = dynamic_cast<const TransformedCurve*>(&of)) {
    write_all(sink_, CurveKind::transformed, moved->transform());
    curve(moved->base());
  } else if (const auto* flat = dynamic_cast<const FlattenedCurve*>(&of)) {
    write_all(sink_, CurveKind::flattened, static_cast<std::uint64_t>(flat->axis()), flat->at());
    curve(flat->base());
  } else throw NotKept{"a curve"};
}

void ModelWriter::content(const ParameterCurve& of) {
  if (const auto* line = dynamic_cast<const ParameterLine*>(&of)) write_all(sink_, ParameterCurveKind::line, line->origin(), line->direction(), line->domain());
  else if (const auto* arc = dynamic_cast<const ParameterArc*>(&of))
    write_all(sink_, ParameterCurveKind::arc, arc->centre(), arc->x(), arc->y(), arc->domain());
  else if (const auto* nurbs = dynamic_cast<const NurbsParameterCurve*>(&of)) write_all(sink_, ParameterCurveKind::nurbs, nurbs->form());
  else throw NotKept{"a curve in a face"};
}

void ModelWriter::content(const Surface& of) {
  if (const auto* plane = dynamic_cast<const PlaneSurface*>(&of)) write_all(sink_, SurfaceKind::plane, plane->frame(), plane->domain());
  else if (const auto* cylinder = dynamic_cast<const CylinderSurface*>(&of))
    write_all(sink_, SurfaceKind::cylinder, cylinder->frame(), cylinder->radius(), cylinder->domain());
  else if (const auto* cone = dynamic_cast<const ConeSurface*>(&of))
    write_all(sink_, SurfaceKind::cone, cone->frame(), cone->radius(), cone->half_angle(), cone->domain());
  else if (const auto* sphere = dynamic_cast<const SphereSurface*>(&of))
    write_all(sink_, SurfaceKind::sphere, sphere->frame(), sphere->radius(), sphere->domain());
  else if (const auto* torus = dynamic_cast<const TorusSurface*>(&of))
    write_all(sink_, SurfaceKind::torus, torus->frame(), torus->major_radius(), torus->minor_radius(), torus->domain());
  else if (const auto* nurbs = dynamic_cast<const NurbsSurface*>(&of))
    write_all(sink_, SurfaceKind::nurbs, nurbs->form(), nurbs->is_periodic_u(), nurbs->is_periodic_v(), nurbs->kind());
  else if (const auto* round = dynamic_cast<const RevolutionSurface*>(&of)) {
    write_all(sink_, SurfaceKind::revolution, round->axis_point(), round->axis(), round->domain().u);
    curve(round->profile());
  } else if (const auto* straight = dynamic_cast<const ExtrusionSurface*>(&of)) {
    write_all(sink_, SurfaceKind::extrusion, straight->direction(), straight->domain().v);
    curve(straight->curve());
  } else if (const auto* ruled = dynamic_cast<const RuledSurface*>(&of)) {
    write_value(sink_, SurfaceKind::ruled);
    curve(ruled->a());
    curve(ruled->b());
  } else if (const auto* view = dynamic_cast<const SurfaceView*>(&of)) {
    write_all(sink_, SurfaceKind::view, view->domain(), view->map_u(), view->map_v(), view->is_exchanged());
    surface(view->base());
  } else if (const auto* moved = dynamic_cast<const TransformedSurface*>(&of)) {
    write_all(sink_, SurfaceKind::transformed, moved->transform());
    surface(moved->base());
  } else throw NotKept{of.kind()};
}

void ModelWriter::model(const Model& model) {
  const auto& [components, corners, edges, faces, solids, source_unit, shape] = model;  // lists all members, so that a new one does not compile until handled
  write_all(sink_, components, corners, solids, source_unit, shape != nullptr);
  write_value(sink_, static_cast<std::uint64_t>(edges.size()));
  for (const ModelEdge& edge : edges) {
    const auto& [on, range, start, end, tolerance, name] = edge;
    curve(on);
    write_all(sink_, range, start, end, tolerance, name);
  }
  write_value(sink_, static_cast<std::uint64_t>(faces.size()));
  for (const ModelFace& face : faces) {
    const auto& [on, borders, is_reversed, component, role, name, colour, layer, tolerance, kind] = face;
    surface(on);
    write_all(sink_, is_reversed, component, role, name, colour, layer, tolerance, kind);
    write_value(sink_, static_cast<std::uint64_t>(borders.size()));
    for (const Border& border : borders) {
      write_value(sink_, static_cast<std::uint64_t>(border.size()));
      for (const EdgeUse& use : border) {
        const auto& [edge, is_against, parameter] = use;
        write_all(sink_, edge, is_against);
        parameter_curve(parameter);
      }
    }
  }
}

// ---- Reading -------------------------------------------------------------------------------------------------------------------------------

template <class T, class Read>
std::shared_ptr<const T> ModelReader::object(std::vector<std::shared_ptr<const T>>& known, const Read& read) {
  const auto presence = take<Presence>(source_);
  if (presence == Presence::none) return nullptr;
  if (presence == Presence::known) {
    const auto number = take<std::uint64_t>(source_);
    if (number >= known.size()) source_.refuse();
    return known[number];
  }
  if (presence != Presence::written) source_.refuse();
  std::shared_ptr<const T> made = read();
  known.push_back(made);
  return made;
}

CurvePtr ModelReader::curve() {
  return object(curves_, [&] { return new_curve(); });
}
ParameterCurvePtr ModelReader::parameter_curve() {
  return object(parameter_curves_, [&] { return new_parameter_curve(); });
}
SurfacePtr ModelReader::surface() {
  return object(surfaces_, [&] { return new_surface(); });
}
std::shared_ptr<const Model> ModelReader::shared() {
  return object(models_, [&] { return std::make_shared<const Model>(model()); });
}

CurvePtr ModelReader::new_curve() {
  switch (take<CurveKind>(source_)) {
    case CurveKind::line: {
      const auto origin = take<Point>(source_), direction = take<Vec3>(source_);
      return std::make_shared<LineCurve>(origin, direction, take<Interval>(source_));
    }
    case CurveKind::ellipse: {
      const auto centre = take<Point>(source_), x = take<Vec3>(source_), y = take<Vec3>(source_);
      return std::make_shared<EllipseCurve>(centre, x, y, take<Interval>(source_));
    }
    case CurveKind::view: {
      const auto domain = take<Interval>(source_);
      const auto scale = take<double>(source_), shift = take<double>(source_);
      return std::make_shared<CurveView>(curve(), domain, scale, shift);
    }
    case CurveKind::nurbs: {
      auto form = take<NurbsCurveForm<Point>>(source_);
      return std::make_shared<NurbsCurve>(std::move(form), take<bool>(source_));
    }
    case CurveKind::transformed: {
      const auto transform = take<Transform>(source_);
      return std::make_shared<TransformedCurve>(curve(), transform);
    }
    case CurveKind::flattened: {
      const auto axis = take<std::uint64_t>(source_);
      const auto at = take<double>(source_);
      return std::make_shared<FlattenedCurve>(curve(), axis, at);
    }
  }
  source_.refuse();
}

ParameterCurvePtr ModelReader::new_parameter_curve() {
  switch (take<ParameterCurveKind>(source_)) {
    case ParameterCurveKind::line: {
      const auto origin = take<Uv>(source_), direction = take<Uv>(source_);
      return std::make_shared<ParameterLine>(origin, direction, take<Interval>(source_));
    }
    case ParameterCurveKind::arc: {
      const auto centre = take<Uv>(source_), x = take<Uv>(source_), y = take<Uv>(source_);
      return std::make_shared<ParameterArc>(centre, x, y, take<Interval>(source_));
    }
    case ParameterCurveKind::nurbs: return std::make_shared<NurbsParameterCurve>(take<NurbsCurveForm<Uv>>(source_));
  }
  source_.refuse();
}

SurfacePtr ModelReader::new_surface() {
  const auto kind = take<SurfaceKind>(source_);
  switch (kind) {
    case SurfaceKind::plane: {
      const auto frame = take<Frame>(source_);
      return std::make_shared<PlaneSurface>(frame, take<ParameterBox>(source_));
    }
    case SurfaceKind::cylinder:
    case SurfaceKind::sphere: {
      const auto frame = take<Frame>(source_);
      const auto radius = take<double>(source_);
      const auto box = take<ParameterBox>(source_);
      if (kind == SurfaceKind::sphere) return std::make_shared<SphereSurface>(frame, radius, box);
      return std::make_shared<CylinderSurface>(frame, radius, box);
    }
    case SurfaceKind::cone:
    case SurfaceKind::torus: {
      const auto frame = take<Frame>(source_);
      const auto first = take<double>(source_), second = take<double>(source_);
      const auto box = take<ParameterBox>(source_);
      if (kind == SurfaceKind::cone) return std::make_shared<ConeSurface>(frame, first, second, box);
      return std::make_shared<TorusSurface>(frame, first, second, box);
    }
    case SurfaceKind::nurbs: {
      auto form = take<NurbsSurfaceForm>(source_);
      const auto is_periodic_u = take<bool>(source_), is_periodic_v = take<bool>(source_);
      return std::make_shared<NurbsSurface>(std::move(form), is_periodic_u, is_periodic_v, take<std::string>(source_));
    }
    case SurfaceKind::revolution: {
      const auto point = take<Point>(source_), axis = take<Vec3>(source_);
      const auto angles = take<Interval>(source_);
      return std::make_shared<RevolutionSurface>(curve(), point, axis, angles);
    }
    case SurfaceKind::extrusion: {
      const auto direction = take<Vec3>(source_);
      const auto range = take<Interval>(source_);
      return std::make_shared<ExtrusionSurface>(curve(), direction, range);
    }
    case SurfaceKind::ruled: {
      CurvePtr a = curve();
      return std::make_shared<RuledSurface>(std::move(a), curve());
    }
    case SurfaceKind::view: {
      const auto domain = take<ParameterBox>(source_);
      const auto u = take<SurfaceView::Map>(source_), v = take<SurfaceView::Map>(source_);
      const auto is_exchanged = take<bool>(source_);
      return std::make_shared<SurfaceView>(surface(), domain, u, v, is_exchanged);
    }
    case SurfaceKind::transformed: {
      const auto transform = take<Transform>(source_);
      return std::make_shared<TransformedSurface>(surface(), transform);
    }
  }
  source_.refuse();
}

Model ModelReader::model() {
  Model model;
  bool has_shape = false;
  read_value(source_, model.components);
  read_value(source_, model.corners);
  read_value(source_, model.solids);
  read_value(source_, model.source_unit);
  read_value(source_, has_shape);
  const std::size_t number = n_models_++;
  if (has_shape) model.shape = shape_of_next_(number);
  for (std::size_t n = detail::read_count(source_, 1); n > 0; --n) {
    ModelEdge edge;
    edge.curve = curve();
    read_value(source_, edge.range);
    read_value(source_, edge.start);
    read_value(source_, edge.end);
    read_value(source_, edge.tolerance);
    read_value(source_, edge.name);
    model.edges.push_back(std::move(edge));
  }
  for (std::size_t n = detail::read_count(source_, 1); n > 0; --n) {
    ModelFace face;
    face.surface = surface();
    read_value(source_, face.is_reversed);
    read_value(source_, face.component);
    read_value(source_, face.role);
    read_value(source_, face.name);
    read_value(source_, face.colour);
    read_value(source_, face.layer);
    read_value(source_, face.tolerance);
    read_value(source_, face.kind);
    for (std::size_t n_borders = detail::read_count(source_, 1); n_borders > 0; --n_borders) {
      Border border;
      for (std::size_t n_uses = detail::read_count(source_, 1); n_uses > 0; --n_uses) {
        EdgeUse use;
        read_value(source_, use.edge);
        read_value(source_, use.is_reversed);
        use.parameter = parameter_curve();
        border.push_back(std::move(use));
      }
      face.borders.push_back(std::move(border));
    }
    model.faces.push_back(std::move(face));
  }
  return model;
}

}  // namespace sterna::scripting
