// Verbs of bodies: fuselage, nacelle, pylon, boom, fairing, body of revolution, sting. Each table becomes a Body (a pylon: a Wing) of geom/model/aircraft.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "geom/model/shapes.h"
#include "scripting/lua/component_value.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/verbs/component_verbs.h"

namespace sterna::scripting {

struct BodyOptions {
  std::string name;
  bool symmetric = false;
};
struct FuselageOptions {
  std::string along = "monotone";
  std::string nose = "round";
  double nose_height = 1.0;
  std::string tail = "round";
  double tail_height = 1.0;
  double pitch = 0.0;
};
struct FrameOptions {
  double x = k_automatic;
  double y = 0.0;
  double z = 0.0;
  double diameter = k_automatic;
  double width = k_automatic;
  double height = k_automatic;
  std::string shape = "ellipse";
  double exponent = 2.0;
  double offset = 0.0;
  double distortion = 0.0;
};
struct NacellePatches {
  std::string intake;
  std::string exhaust;
};
struct RevolutionOptions {
  bool straight = false;
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::BodyOptions> {
  using O = scripting::BodyOptions;
  static constexpr std::string_view stage = "component";
  static constexpr std::array fields = {
      Field<O>{.name = "name", .member = &O::name, .help = "name of the component and its patch; empty: the name of the verb"},
      Field<O>{.name = "symmetric", .member = &O::symmetric, .help = "add a mirror image on the other side of y = 0"},
  };
};
template <>
struct Schema<scripting::FuselageOptions> {
  using O = scripting::FuselageOptions;
  static constexpr std::string_view stage = "fuselage";
  static constexpr std::array fields = {
      Field<O>{.name = "along",
               .member = &O::along,
               .help = "interpolation between frames: monotone (smooth, without overshoot), smooth (Bessel, as sumo), akima (as sumo, keeps straight parts "
                       "straight), linear",
               .choices = "monotone smooth akima linear"},
      Field<O>{.name = "nose", .member = &O::nose, .help = "shape of the end before the first frame, if that frame is not a point", .choices = "round flat"},
      Field<O>{.name = "nose_height",
               .member = &O::nose_height,
               .min = 0.01,
               .max = 20.0,
               .help = "height of a round nose, relative to the mean radius of the first frame"},
      Field<O>{.name = "tail", .member = &O::tail, .help = "shape of the end behind the last frame, if that frame is not a point", .choices = "round flat"},
      Field<O>{.name = "tail_height",
               .member = &O::tail_height,
               .min = 0.01,
               .max = 20.0,
               .help = "height of a round tail, relative to the mean radius of the last frame"},
      Field<O>{.name = "pitch", .member = &O::pitch, .unit = Unit::radian, .min = -1.6, .max = 1.6, .help = "rotation about the position, nose up"},
  };
};
template <>
struct Schema<scripting::FrameOptions> {
  using O = scripting::FrameOptions;
  static constexpr std::string_view stage = "frame";
  static constexpr std::array fields = {
      Field<O>{.name = "x", .member = &O::x, .unit = Unit::metre, .help = "x of the frame's plane", .required = true},
      Field<O>{.name = "y", .member = &O::y, .unit = Unit::metre, .help = "coordinate of the frame's centre"},
      Field<O>{.name = "z", .member = &O::z, .unit = Unit::metre, .help = "coordinate of the frame's centre"},
      Field<O>{.name = "diameter",
               .member = &O::diameter,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "diameter of a circular frame; 0 = a point, at the ends only",
               .automatic = "from width and height"},
      Field<O>{.name = "width", .member = &O::width, .unit = Unit::metre, .min = 0.0, .help = "width along y", .automatic = "the height"},
      Field<O>{.name = "height", .member = &O::height, .unit = Unit::metre, .min = 0.0, .help = "height along z", .automatic = "the width"},
      Field<O>{.name = "shape",
               .member = &O::shape,
               .help = "shape of the section; points: a custom list of points",
               .choices = "ellipse circle superellipse double_ellipse egg isikveren points"},
      Field<O>{.name = "exponent", .member = &O::exponent, .min = 0.5, .max = 20.0, .help = "exponent n of a superellipse: |y|^n + |z|^n = 1; 2 = ellipse"},
      Field<O>{
          .name = "offset", .member = &O::offset, .min = -0.95, .max = 0.95, .help = "height at which a double ellipse is widest, relative to half its height"},
      Field<O>{.name = "distortion",
               .member = &O::distortion,
               .min = -0.95,
               .max = 0.95,
               .help = "only for shape = egg: parameter d of Huegelschaeffer's egg curve, y^2 ~ (1 - z^2)/(1 + d z); 0: ellipse, above 0: wider at the bottom"},
  };
};
template <>
struct Schema<scripting::NacellePatches> {
  using O = scripting::NacellePatches;
  static constexpr std::string_view stage = "nacelle_patches";
  static constexpr std::array fields = {
      Field<O>{.name = "intake", .member = &O::intake, .help = "name of the fan face's patch; empty: the nacelle's patch"},
      Field<O>{.name = "exhaust", .member = &O::exhaust, .help = "name of the nozzle's patch; empty: the nacelle's patch"},
  };
};
template <>
struct Schema<scripting::RevolutionOptions> {
  using O = scripting::RevolutionOptions;
  static constexpr std::string_view stage = "revolution";
  static constexpr std::array fields = {
      Field<O>{.name = "straight", .member = &O::straight, .help = "connect the points of the profile by straight lines; otherwise by a smooth curve"},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

/// The options common to all bodies: name, mirror image, position.
struct BodyTable {
  ScriptTable table;
  TableReader reader;
  BodyOptions options;
  OptionTable schema;
  Point position;

  BodyTable(const ScriptCall& call, std::string_view usage, std::string name = {})
      : table(table_argument(call, 0, usage)),
        reader(table, call.attempted()),
        options{.name = name.empty() ? std::string(call.verb) : std::move(name)},
        schema(sterna::options_of(options)) {}
  void read_shared() {
    position = read_point(reader, "position").value_or(Point{});
    reader.read_options(schema);
    if (options.name.empty()) reader.add_problem("name: must not be empty");
  }
  Body body() const { return {.name = options.name, .placement = {position, {}}, .has_mirror_image = options.symmetric}; }
  ScriptValue value(Body body, ComponentKind kind) const {
    body.kind = kind;
    return std::make_shared<ComponentValue>(ComponentValue{.kind = kind, .shape = std::move(body)});
  }
};

EndCap cap(const std::string& shape, double height) { return {CapShape::dome, shape == "round" ? height : 0.0}; }

BodyFrame point_frame(const Point& at, std::string name) { return {.name = std::move(name), .center = at, .shape = FrameShape::loop, .loop = {at}}; }

/// Sets the points {y, z} of the right half, from bottom to top, as the frame's own points. They are given in metres relative to the centre.
void set_points(BodyFrame& frame, const std::vector<std::vector<double>>& rows, TableReader& reader, const std::string& where) {
  double half_width = 0.0, low = rows.front()[1], high = rows.back()[1];
  for (const std::vector<double>& row : rows) half_width = std::max(half_width, row[0]);
  if (rows.size() < 3 || !(half_width > 0.0) || !(high > low)) {
    reader.add_problem(where + ": points: needs at least 3 points {y, z} of the right half, from the bottom to the top");
    return;
  }
  frame.shape = FrameShape::points;
  frame.center.z += 0.5 * (low + high);
  frame.width = 2.0 * half_width;
  frame.height = high - low;
  for (const std::vector<double>& row : rows) frame.points.push_back({row[0] / half_width, (row[1] - 0.5 * (low + high)) / (0.5 * frame.height)});
}

std::optional<BodyFrame> frame_of(const ScriptValue& value, const std::string& where, TableReader& outer) {
  const auto* table = std::get_if<TableHandle>(&value);
  if (!table) {
    outer.add_problem(where + ": expected a frame { x = 1, diameter = 2 }, not " + std::string(type_text(value)));
    return std::nullopt;
  }
  FrameOptions o;
  const OptionTable schema = sterna::options_of(o);
  TableReader reader(**table, where);
  BodyFrame frame{.name = where, .n_points = 11};
  reader.read_options(schema);
  reader.require(schema);
  frame.center = {o.x, o.y, o.z};
  const ScriptValue* points = reader.field("points");
  std::map<std::string, double> isikveren;
  for (const char* name : {"zp", "a0", "a1", "b1"})
    if (const ScriptValue* number = reader.field(name)) {
      const auto given = number_of(*number);
      if (!given) reader.add_problem(std::string(name) + ": expected a number, not " + std::string(type_text(*number)));
      isikveren[name] = given.value_or(0.0);
    }
  if (!is_automatic(o.diameter) && !(is_automatic(o.width) && is_automatic(o.height)))
    reader.add_problem("diameter, width and height: give either the diameter or width and height");
  if (points) {
    const auto rows = rows_of(*points, 2);
    if (!rows) reader.add_problem("points: expected a list {{y, z}, ...} of the right half, from the bottom to the top");
    else set_points(frame, *rows, reader, where);
  } else {
    const double width = !is_automatic(o.diameter) ? o.diameter : !is_automatic(o.width) ? o.width : o.height;
    const double height = !is_automatic(o.diameter) ? o.diameter : !is_automatic(o.height) ? o.height : o.width;
    if (is_automatic(width)) reader.add_problem("needs a diameter, a width or a height (0 = a point), or points");
    if (o.shape == "points") reader.add_problem("shape: \"points\" needs a list points = {{y, z}, ...}");
    frame.width = width;
    frame.height = height;
    frame.exponent = o.exponent;
    frame.offset = o.offset;
    frame.distortion = o.distortion;
    frame.zp = isikveren["zp"], frame.a0 = isikveren["a0"], frame.a1 = isikveren["a1"], frame.b1 = isikveren["b1"];
    static const std::map<std::string, FrameShape> k_shapes = {{"circle", FrameShape::circle},
                                                               {"ellipse", FrameShape::ellipse},
                                                               {"superellipse", FrameShape::ellipse},
                                                               {"double_ellipse", FrameShape::double_ellipse},
                                                               {"egg", FrameShape::egg},
                                                               {"isikveren", FrameShape::isikveren},
                                                               {"points", FrameShape::points}};
    frame.shape = k_shapes.at(o.shape);
    if (width == 0.0 && height == 0.0) frame = point_frame(frame.center, where);
  }
  try {
    reader.finish();
  } catch (const Error& error) {
    outer.add_problem(where + ": " + error.info().problem);
    return std::nullopt;
  }
  return frame;
}

}  // namespace

ScriptValue make_fuselage_verb(const ScriptCall& call) {
  BodyTable t(call, k_fuselage_usage);
  FuselageOptions o;
  const OptionTable schema = sterna::options_of(o);
  t.read_shared();
  t.reader.read_options(schema);
  Body body = t.body();
  const ScriptValue* frames = t.reader.field("frames");
  const auto* list = frames ? std::get_if<TableHandle>(frames) : nullptr;
  if (!list || (*list)->items.size() < 2) t.reader.add_problem("frames: needs a list of at least 2 frames: " + std::string(k_fuselage_usage));
  else
    for (std::size_t i = 0; i < (*list)->items.size(); ++i)
      if (auto frame = frame_of((*list)->items[i], "frame " + std::to_string(i + 1), t.reader)) body.frames.push_back(std::move(*frame));
  for (std::size_t i = 1; i < body.frames.size(); ++i)
    if (!(body.frames[i].center.x > body.frames[i - 1].center.x))
      t.reader.add_problem("frames: '" + body.frames[i].name + "' is not behind '" + body.frames[i - 1].name + "'; x must increase");
  t.reader.finish();
  body.placement.rotation.y = o.pitch;
  body.tangents = o.along == "monotone" ? BodyTangents::monotone
                  : o.along == "akima"  ? BodyTangents::akima
                  : o.along == "linear" ? BodyTangents::linear
                                        : BodyTangents::bessel;
  body.nose = cap(o.nose, o.nose_height);
  body.tail = cap(o.tail, o.tail_height);
  return t.value(std::move(body), ComponentKind::body);
}

ScriptValue make_nacelle_verb(const ScriptCall& call) {
  BodyTable t(call, k_nacelle_usage);
  NacelleOptions o;
  NacellePatches patches;
  const OptionTable schema = sterna::options_of(o), patch_schema = sterna::options_of(patches);
  t.read_shared();
  t.reader.read_options(schema);
  t.reader.read_options(patch_schema);
  t.reader.require(schema);
  t.reader.finish();
  Body body = nacelle_body(t.options.name, t.position, o);
  body.has_mirror_image = t.options.symmetric;
  return std::make_shared<ComponentValue>(
      ComponentValue{.kind = ComponentKind::nacelle, .shape = std::move(body), .intake = patches.intake, .exhaust = patches.exhaust});
}

ScriptValue make_pylon_verb(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_pylon_usage);
  BodyOptions shared{.name = "pylon"};
  PylonOptions o;
  const OptionTable schema = sterna::options_of(o);
  OptionTable name = sterna::options_of(shared);
  name.pop_back();  // symmetric if the component that hangs on it is symmetric
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  const auto component = [&](std::size_t i) { return i < items.size() ? std::get_if<ComponentHandle>(&items[i]) : nullptr; };
  const ComponentHandle *wing = component(0), *body = component(1);
  if (!wing || !std::holds_alternative<Wing>((*wing)->shape))
    reader.add_problem("entry 1: expected a wing (from wing{...}), not " + std::string(items.empty() ? "nothing" : type_text(items[0])));
  if (!body || !std::holds_alternative<Body>((*body)->shape))
    reader.add_problem("entry 2: expected a nacelle or another body, not " + std::string(items.size() < 2 ? "nothing" : type_text(items[1])));
  refuse_items_beyond(reader, 2);
  reader.read_options(name);
  reader.read_options(schema);
  reader.finish();
  const Body& hung = std::get<Body>((*body)->shape);
  Wing pylon = pylon_wing(shared.name, std::get<Wing>((*wing)->shape), hung, o);
  pylon.has_mirror_image = hung.has_mirror_image;
  return std::make_shared<ComponentValue>(ComponentValue{.kind = ComponentKind::pylon, .shape = std::move(pylon)});
}

namespace {

/// Makes boom{} and sting{}: a body from one point to another.
template <class Options>
ScriptValue make_rod(const ScriptCall& call, std::string_view usage, ComponentKind kind,
                     Body (*make)(const std::string&, const Point&, const Point&, const Options&)) {
  BodyTable t(call, usage);
  Options o;
  const OptionTable schema = sterna::options_of(o);
  const auto from = read_point(t.reader, "from"), to = read_point(t.reader, "to");
  t.reader.read_options(t.schema);
  t.reader.read_options(schema);
  t.reader.require(schema);
  if (!from || !to) t.reader.add_problem("needs from = {x, y, z} and to = {x, y, z}: " + std::string(usage));
  t.reader.finish();
  Body body = make(t.options.name, *from, *to, o);
  body.has_mirror_image = t.options.symmetric;
  return t.value(std::move(body), kind);
}

}  // namespace

ScriptValue make_boom_verb(const ScriptCall& call) { return make_rod<BoomOptions>(call, k_boom_usage, ComponentKind::boom, boom_body); }
ScriptValue make_sting_verb(const ScriptCall& call) { return make_rod<StingOptions>(call, k_sting_usage, ComponentKind::sting, sting_body); }

ScriptValue make_revolution_verb(const ScriptCall& call) {
  BodyTable t(call, k_revolution_usage, "body");
  RevolutionOptions o;
  const OptionTable schema = sterna::options_of(o);
  t.read_shared();
  t.reader.read_options(schema);
  const ScriptValue* profile = t.reader.field("profile");
  const auto rows = profile ? rows_of(*profile, 2) : std::nullopt;
  if (!rows) t.reader.add_problem("profile: needs a list {{x, radius}, ...}, from nose to tail");
  t.reader.finish();
  std::vector<Uv> points;
  for (const std::vector<double>& row : *rows) points.push_back({row[0], row[1]});
  Body body = body_of_revolution(t.options.name, {t.position, {}}, points, o.straight);
  body.has_mirror_image = t.options.symmetric;
  return t.value(std::move(body), ComponentKind::body);
}

ScriptValue make_fairing_verb(const ScriptCall& call) {
  BodyTable t(call, k_fairing_usage);
  FairingOptions o;
  const OptionTable schema = sterna::options_of(o);
  t.read_shared();
  t.reader.read_options(schema);
  t.reader.require(schema);
  t.reader.finish();
  Body body = fairing_body(t.options.name, t.position, o);
  body.has_mirror_image = t.options.symmetric;
  return t.value(std::move(body), ComponentKind::fairing);
}

namespace {

constexpr const char* k_ends_help = "  from = {x, y, z}, to = {x, y, z}\n      required: the ends of the axis\n";
constexpr const char* k_position_help = "  position = {x, y, z}\n      position of the whole component; {0, 0, 0}\n";

template <class... Options>
std::string body_help_of() {
  std::string text;
  const auto add = [&]<class O>(O options) { text += options_help(sterna::options_of(options)); };
  (add(Options{}), ...);
  return text;
}

}  // namespace

std::string fuselage_help() {
  return body_help_of<BodyOptions, FuselageOptions>() + k_position_help +
         "  frames = { {...}, {...} }\n      required: at least two, from the nose to the tail\neach frame:\n" + body_help_of<FrameOptions>() +
         "  points = {{y, z}, ...}\n      points of the right half from the bottom to the top, for the shape \"points\"\n  zp, a0, a1, b1\n      numbers, for "
         "the shape \"isikveren\"\n";
}
std::string nacelle_help() { return body_help_of<BodyOptions, NacelleOptions, NacellePatches>() + k_position_help; }
std::string pylon_help() { return body_help_of<PylonOptions>(); }
std::string boom_help() { return body_help_of<BodyOptions, BoomOptions>() + k_ends_help; }
std::string sting_help() { return body_help_of<BodyOptions, StingOptions>() + k_ends_help; }
std::string fairing_help() { return body_help_of<BodyOptions, FairingOptions>() + k_position_help; }
std::string revolution_help() {
  return body_help_of<BodyOptions, RevolutionOptions>() + k_position_help + "  profile = {{x, radius}, ...}\n      required: points from nose to tail\n";
}

}  // namespace sterna::scripting
