// aircraft{}, and the common parts of all components: methods, fields, and a line of description.
#include "scripting/verbs/component_verbs.h"
#include "scripting/lua/component_value.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "geom/model/reference_data.h"
#include "scripting/lua/script_watch.h"
#include "scripting/values/aircraft_model.h"
#include "scripting/values/geometry_tools.h"

namespace sterna::scripting {

struct AircraftOptions {
  std::string name = "aircraft";
  bool unite = true;
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::AircraftOptions> {
  using O = scripting::AircraftOptions;
  static constexpr std::string_view stage = "aircraft";
  static constexpr std::array fields = {
      Field<O>{.name = "name", .member = &O::name, .help = "name of the aircraft"},
      Field<O>{.name = "unite", .member = &O::unite, .help = "unite all components to one closed surface; otherwise they stay separate"},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

/// Returns the length along the body's own axis, round ends included.
double length_of(const Body& body) {
  const auto cap = [](const EndCap& end, const BodyFrame& frame) {
    return frame.shape == FrameShape::loop ? 0.0 : end.height * 0.25 * (frame.width + frame.height);
  };
  const double nose = body.lip ? 0.0 : cap(body.nose, body.frames.front());
  return body.frames.back().center.x - body.frames.front().center.x + nose + cap(body.tail, body.frames.back());
}

constexpr std::string_view k_aircraft_usage = "aircraft{ body, main_wing, engine, pylon{ main_wing, engine }, unite = true }";

ScriptValue make_aircraft_verb(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_aircraft_usage);
  AircraftOptions o;
  UniteOptions unite;
  OptionTable schema = sterna::options_of(o);  // all options are in one table, because `unite` is an option and also the name of a stage
  for (Option& option : sterna::options_of(unite)) schema.push_back(std::move(option));
  TableReader reader(table, call.attempted());
  AircraftParts parts;
  std::size_t number = 0;
  for (const ScriptValue& item : reader.items()) {
    ++number;
    if (const auto* component = std::get_if<ComponentHandle>(&item)) parts.components.push_back(*component);
    else if (const auto* model = std::get_if<ModelHandle>(&item)) parts.models.push_back(*model);
    else
      reader.add_problem("entry " + std::to_string(number) + ": expected a component (wing{...}, fuselage{...}) or a model, not " +
                         std::string(type_text(item)));
  }
  if (number == 0) reader.add_problem("needs components: " + std::string(k_aircraft_usage));
  reader.read_options(schema);
  apply_overrides(call, schema);
  reader.finish();
  parts.name = o.name;
  const RunContext context = call.session.context.part("aircraft", 0.0, 1.0);
  ModelValue side_by_side = make_aircraft(parts, context);
  if (!o.unite || is_sketch(call)) return std::make_shared<const ModelValue>(std::move(side_by_side));
  // The union changes the faces, but not the described components.
  const std::optional<Aircraft> description = side_by_side.description;
  ModelValue united = unite_solids({std::make_shared<const ModelValue>(std::move(side_by_side))}, unite, context);
  united.description = description;
  return std::make_shared<const ModelValue>(std::move(united));
}

std::string aircraft_help() {
  AircraftOptions o;
  UniteOptions unite;
  return options_help(sterna::options_of(o)) + options_help(sterna::options_of(unite));
}

// ---- Methods -------------------------------------------------------------------------------------------------------------------------------

ScriptValue move_component(const ScriptCall& call) {
  const ComponentHandle& component = self<ComponentHandle>(call);
  const ScriptTable table = table_argument(call, 1, "wing:move{ 0.5, 0, 0 }");
  TableReader reader(table, call.attempted());
  const auto shift = point_of(std::make_shared<const ScriptTable>(ScriptTable{reader.items(), {}, {}}));
  if (!shift) reader.add_problem("expected three numbers, dx, dy, dz in metres: wing:move{ 0.5, 0, 0 }");
  const auto* wing = std::get_if<Wing>(&component->shape);
  if (shift && shift->y != 0.0 && wing && wing->is_symmetric) reader.add_problem("a symmetric wing cannot be moved along y");
  reader.finish();
  component->placement().origin += *shift;
  return component;
}

/// Returns the point at a root-to-tip position on the chord line of a wing's right half.
ScriptValue point_on_wing(const ScriptCall& call) {
  const ComponentHandle& component = self<ComponentHandle>(call);
  const auto* wing = std::get_if<Wing>(&component->shape);
  if (!wing) reject(call, "applies to wings, not to " + std::string(component->type_text()));
  const auto span = call.arguments.size() > 1 ? number_of(call.arguments[1]) : std::nullopt,
             chord = call.arguments.size() > 2 ? number_of(call.arguments[2]) : std::nullopt;
  if (call.arguments.size() != 3 || !span || !chord)
    reject(call, "takes two numbers: fraction of the span (0 root, 1 tip), fraction of the chord (0 leading edge, 1 trailing edge)", "wing:at(0.4, 0.25)");
  if (*span < 0.0 || *span > 1.0) reject(call, fmt::format("fraction {:g} of the span is outside the wing, which reaches from 0 to 1", *span));
  struct Line {
    Point leading, trailing;
  };
  std::vector<Line> lines;
  const Transform map = transform_of(wing->placement);
  for (std::size_t i = wing->sections.size(); i-- > 0;) {
    const WingSection& s = wing->sections[i];
    const Transform location = map * transform_of({s.leading_edge, {s.dihedral, s.twist, s.yaw}});
    if (s.loop.empty()) lines.push_back({location.point({}), location.point({s.chord, 0.0, 0.0})});
    else lines.push_back({map.point(s.loop[s.loop.size() / 2]), map.point(0.5 * (s.loop.front() + s.loop.back()))});
  }
  std::vector<double> at{0.0};
  for (std::size_t i = 1; i < lines.size(); ++i)
    at.push_back(at.back() + std::hypot(lines[i].leading.y - lines[i - 1].leading.y, lines[i].leading.z - lines[i - 1].leading.z));
  const double requested = *span * at.back();
  std::size_t i = 1;
  while (i + 1 < lines.size() && at[i] < requested) ++i;
  const double t = (requested - at[i - 1]) / (at[i] - at[i - 1]);
  const Point leading = lines[i - 1].leading + t * (lines[i].leading - lines[i - 1].leading),
              trailing = lines[i - 1].trailing + t * (lines[i].trailing - lines[i - 1].trailing);
  return list_of(leading + *chord * (trailing - leading));
}

ScriptValue component_model(const ScriptCall& call) { return model_of(self<ComponentHandle>(call), call); }

ScriptValue component_field(const ScriptCall& call) {
  const ComponentValue& component = *self<ComponentHandle>(call);
  Fields fields = {{"name", component.name()}, {"kind", std::string(to_string(component.kind))}, {"position", list_of(component.placement().origin)}};
  if (const auto* wing = std::get_if<Wing>(&component.shape)) {
    const WingReference r = wing_reference(*wing);
    fields.insert(fields.end(), {{"span", r.span},
                                 {"area", r.area},
                                 {"projected_area", r.projected_area},
                                 {"unrolled_area", r.unrolled_area},
                                 {"aspect_ratio", r.aspect_ratio},
                                 {"mean_geometric_chord", r.mean_geometric_chord},
                                 {"mean_aerodynamic_chord", r.mean_aerodynamic_chord},
                                 {"aerodynamic_chord_start", list_of(r.aerodynamic_chord_start)}});
  } else {
    const Body& body = std::get<Body>(component.shape);
    double width = 0.0, height = 0.0;
    for (const BodyFrame& frame : body.frames)
      if (frame.shape != FrameShape::loop) {
        width = std::max(width, frame.width);
        height = std::max(height, frame.height);
      }
    fields.insert(fields.end(), {{"length", length_of(body)}, {"width", width}, {"height", height}});
  }
  return select_field(call, std::move(fields), component_methods());
}

constexpr std::array<ScriptVerb, 9> k_component_verbs = {{
    {"fuselage", k_fuselage_usage, "Makes a body through frames: circles, superellipses, double ellipses, eggs, points.", make_fuselage_verb, fuselage_help,
     false, "component"},
    {"wing", k_wing_usage, "Makes a wing, tail or fin through sections from the root to the tip.", make_wing_verb, wing_help, false, "component"},
    {"nacelle", k_nacelle_usage, "Makes a nacelle with inlet lip, fan face and nozzle; `position` is the centre of its front.", make_nacelle_verb, nacelle_help,
     false, "component"},
    {"pylon", k_pylon_usage, "Makes a pylon between a wing and a body below or above the wing; the pylon has a mirror image if the body has one.",
     make_pylon_verb, pylon_help, false, "component"},
    {"boom", k_boom_usage, "Makes a round rod from one point to another.", make_boom_verb, boom_help, false, "component"},
    {"fairing", k_fairing_usage, "Makes a smooth bulge: an ellipsoid along x with superelliptic sections.", make_fairing_verb, fairing_help, false,
     "component"},
    {"body_of_revolution", k_revolution_usage, "Makes a body of revolution around the x axis through a profile of radii.", make_revolution_verb,
     revolution_help, false, "component"},
    {"sting", k_sting_usage, "Makes the support of a model in a wind tunnel: a rod with flat ends, from the inside of the model to the outside.",
     make_sting_verb, sting_help, false, "component"},
    {"aircraft", k_aircraft_usage, "Makes a model of components and models, with mirror images, united to one closed surface.", make_aircraft_verb,
     aircraft_help, true, "model", true},
}};
constexpr std::array<ScriptVerb, 5> k_component_methods = {{
    {"wing:deflect", k_deflect_usage,
     "Deflects a control surface geometrically. The hinge is given by fractions of the span from the root and of the chord from the leading edge.",
     deflect_wing, deflect_help, false, "self"},
    {"wing:control", k_control_usage, "Gives a control surface a separate patch, without deflecting it.", control_wing, control_help, false, "self"},
    {"component:at", "main_wing:at(0.4, 0.25)",
     "Returns a point of a wing's chord line, given by fractions of the span from the root and of the chord from the leading edge.", point_on_wing},
    {"component:move", "body:move{ 0.5, 0, 0 }", "Moves the component in place, by metres.", move_component, nullptr, false, "self"},
    {"component:model", "main_wing:model()", "Makes a model of this component alone, with its mirror image.", component_model, nullptr, false, "model"},
}};

}  // namespace

const ScriptVerb k_component_field = {"component", "", "", component_field};

std::span<const ScriptVerb> component_verbs() { return k_component_verbs; }
std::span<const ScriptVerb> component_methods() { return k_component_methods; }

std::string describe(const ComponentValue& component) {
  std::string kind(to_string(component.kind));
  kind.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(kind.front())));
  std::string text = kind + " \"" + component.name() + "\": ";
  if (const auto* wing = std::get_if<Wing>(&component.shape)) {
    const WingReference r = wing_reference(*wing);
    text += fmt::format("{} sections, span {:.4g} m, area {:.4g} m^2, mean aerodynamic chord {:.4g} m", wing->sections.size(), r.span, r.area,
                        r.mean_aerodynamic_chord);
    if (wing->is_symmetric) text += ", both halves";
  } else {
    const Body& body = std::get<Body>(component.shape);
    text += fmt::format("{} frames, {:.4g} m long", body.frames.size(), length_of(body));
  }
  for (const Deflection& d : component.deflections)
    text += d.angle == 0.0 ? fmt::format(", {}", d.surface.name) : fmt::format(", {} {:+.4g} deg", d.surface.name, d.angle * 180.0 / std::numbers::pi);
  return text + (component.has_mirror_image() ? ", and its mirror image" : "");
}

}  // namespace sterna::scripting
