#include "scripting/verbs/geometry_verbs.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>

#include "geom/cad/unite.h"
#include "geom/model/airfoil.h"
#include "geom/model/model_builder.h"
#include "geom/model/sampled.h"
#include "geom/model/set_controls.h"
#include "geom/model/shapes.h"
#include "scripting/lua/script_function.h"
#include "scripting/lua/script_watch.h"
#include "scripting/values/aircraft_model.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/verbs/control_options.h"

namespace sterna::scripting {

/// Options of airfoil{} in addition to the section itself.
struct AirfoilOptions {
  double trailing_edge = k_automatic;
  int points = 0;
  double within = k_automatic;
};
/// Options of surface{} in addition to function and ranges.
struct SurfaceOptions {
  std::string name = "surface";
  double tolerance = SamplingOptions{}.tolerance;
  bool periodic_u = false;
  bool periodic_v = false;
  int max_intervals = SamplingOptions{}.max_intervals;
};
/// Names of boxes and cylinders; radius of a cylinder.
struct SolidOptions {
  std::string name;
  double radius = k_automatic;
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::AirfoilOptions> {
  using O = scripting::AirfoilOptions;
  static constexpr std::string_view stage = "airfoil";
  static constexpr std::array fields = {
      Field<O>{.name = "trailing_edge",
               .member = &O::trailing_edge,
               .min = 0.0,
               .max = 0.1999,
               .help = "thickness of the trailing edge, relative to the chord; 0 = sharp",
               .automatic = "unchanged"},
      Field<O>{.name = "points",
               .member = &O::points,
               .min = 0,
               .max = 2000,
               .help = "number of points along each side, dense where the section is curved; 0 = unchanged"},
      Field<O>{.name = "within",
               .member = &O::within,
               .min = 1e-9,
               .max = 0.1,
               .help = "use the fewest points that stay within this distance, relative to the chord",
               .automatic = "unchanged"},
  };
};
template <>
struct Schema<scripting::SurfaceOptions> {
  using O = scripting::SurfaceOptions;
  static constexpr std::string_view stage = "surface_function";
  static constexpr std::array fields = {
      Field<O>{.name = "name", .member = &O::name, .help = "name of the component and its patch"},
      Field<O>{.name = "tolerance",
               .member = &O::tolerance,
               .unit = Unit::metre,
               .min = 1e-12,
               .max = 1.0,
               .help = "largest distance between the function and the bicubic spline that approximates it"},
      Field<O>{.name = "periodic_u", .member = &O::periodic_u, .help = "the surface is closed and smooth across the ends of u"},
      Field<O>{.name = "periodic_v", .member = &O::periodic_v, .help = "the surface is closed and smooth across the ends of v"},
      Field<O>{.name = "max_intervals",
               .member = &O::max_intervals,
               .min = 4,
               .max = 10000,
               .help = "largest number of intervals of the spline along u and along v"},
  };
};
template <>
struct Schema<scripting::SolidOptions> {
  using O = scripting::SolidOptions;
  static constexpr std::string_view stage = "solid";
  static constexpr std::array fields = {
      Field<O>{.name = "name", .member = &O::name, .help = "name of the component and its patch; empty: the name of the verb"},
      Field<O>{.name = "radius", .member = &O::radius, .unit = Unit::metre, .min = 1e-12, .help = "radius of the cylinder", .required = true},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

// ---- Readers -------------------------------------------------------------------------------------------------------------------------------

constexpr std::string_view k_read_cad_usage = "read_cad \"model.step\"  or  read_cad{ \"model.igs\", unit = inch }";
constexpr std::string_view k_read_smx_usage = "read_smx \"widebody.smx\"  or  read_smx{ \"widebody.smx\", deflections = { Rudder = 5*deg } }";
constexpr std::string_view k_read_cpacs_usage = "read_cpacs \"d150.xml\"  or  read_cpacs{ \"d150.xml\", deflections = { [\"Flap*\"] = 10*deg } }";

ScriptValue read_cad_verb(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_read_cad_usage);
  ReadCadOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  const auto file = single_file(call, reader);
  reader.read_options(schema);
  apply_overrides(call, schema);
  reader.finish();
  return std::make_shared<const ModelValue>(read_model(*file, options, call.session.context.part("read_cad", 0.0, 1.0)));
}

/// Tests for a script that is only checked if the file has the control surfaces named in its deflections. Only the description is read; no model is made.
void check_deflections(const ScriptCall& call, const InputPath& file, const std::vector<ControlSetting>& settings, TableReader& reader) {
  std::error_code ignored;  // a path that cannot be accessed counts as missing, which is reported elsewhere
  if (!call.session.check || settings.empty() || reader.has_problems() || !std::filesystem::exists(file.path, ignored)) return;
  try {
    with_controls_set(description_of(file, RunContext()), settings);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_argument) return;  // the run reports a file that cannot be read
    reader.add_problem("deflections: " + error.info().attempted + ": " + error.info().problem + (error.info().hint.empty() ? "" : "; " + error.info().hint));
  }
}

template <ModelValue (*Read)(const InputPath&, const RunContext&)>
ScriptValue read_description(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_read_smx_usage);
  TableReader reader(table, call.attempted());
  const auto file = single_file(call, reader);
  std::vector<ControlSetting> settings;
  if (const ScriptValue* value = reader.field("deflections")) {
    if (const auto* angles = std::get_if<TableHandle>(value)) settings = read_control_settings(**angles, "deflections", reader);
    else reader.add_problem("deflections: expected a table with names of control surfaces as keys and angles as values, not " + std::string(type_text(*value)));
  }
  if (file) check_deflections(call, *file, settings, reader);
  reader.finish();
  const RunContext context = call.session.context.part(call.verb, 0.0, 1.0);
  ModelValue value = Read(*file, context);
  if (!settings.empty()) value = deflected_model(value, settings, context);
  return std::make_shared<const ModelValue>(std::move(value));
}

// ---- Airfoils ------------------------------------------------------------------------------------------------------------------------------

constexpr std::string_view k_airfoil_usage =
    "airfoil \"naca23012\"  or  airfoil{ \"naca0012\", trailing_edge = 0.002 }  or  airfoil{ {{1, 0.001}, {0.5, 0.06}, {0, 0}, {0.5, -0.06}, {1, -0.001}} }";

Airfoil airfoil_of_points(const std::vector<std::vector<double>>& rows) {
  std::string text = "points of the script\n";
  for (const std::vector<double>& row : rows) text += fmt::format("{:.17g} {:.17g}\n", row[0], row[1]);
  return parse_airfoil(text, "reading the points of an airfoil");
}

ScriptValue make_airfoil(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_airfoil_usage);
  AirfoilOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  std::optional<Airfoil> airfoil;
  // airfoil{ {1, 0}, {0.5, 0.1}, ... } lists the points themselves; airfoil{ { {1, 0}, ... } } has the list as its first entry.
  const std::vector<ScriptValue>& items = reader.items();
  if (items.empty()) reader.add_problem("needs a NACA designation, a file name or a list of points {x, z}: " + std::string(k_airfoil_usage));
  else if (items.size() == 1) airfoil = read_airfoil_value(items.front(), call, reader, "entry 1");
  else {
    auto list = std::make_shared<ScriptTable>();
    list->items = items;
    airfoil = read_airfoil_value(TableHandle(list), call, reader, "the entries");
  }
  reader.read_options(schema);
  if (options.points > 0 && !is_automatic(options.within)) reader.add_problem("points and within: give only one of the two");
  if (options.points > 0 && options.points < 5) reader.add_problem("points: at least 5");
  reader.finish();
  if (!is_automatic(options.trailing_edge)) airfoil = with_trailing_edge(*airfoil, options.trailing_edge);
  if (options.points > 0) airfoil = repaneled(*airfoil, options.points).airfoil;
  if (!is_automatic(options.within)) airfoil = repaneled_within(*airfoil, options.within).airfoil;
  return std::make_shared<const Airfoil>(std::move(*airfoil));
}

ScriptValue airfoil_field(const ScriptCall& call) {
  const Airfoil& airfoil = *self<AirfoilHandle>(call);
  const AirfoilMeasures m = measure(airfoil);
  auto points = std::make_shared<ScriptTable>();
  for (const Uv p : airfoil.points) {
    auto row = std::make_shared<ScriptTable>();
    row->items = {p.u, p.v};
    points->items.emplace_back(TableHandle(row));
  }
  return select_field(call,
                      {{"name", airfoil.name},
                       {"points", TableHandle(points)},
                       {"thickness", m.thickness},
                       {"thickness_at", m.thickness_at},
                       {"camber", m.camber},
                       {"camber_at", m.camber_at},
                       {"trailing_edge", airfoil.trailing_edge_thickness()}},
                      {});
}

// ---- Surfaces of functions -----------------------------------------------------------------------------------------------------------------

constexpr std::string_view k_surface_usage = "surface{ function(u, v) return u, v, 0.1*u*v end, u = {0, 1}, v = {0, 1}, name = \"sheet\", tolerance = 1e-6 }";

/// Makes faces over halves of the closed directions, so that no face uses a seam twice. Sides of zero length become poles.
Model model_of_surface(const SampledSurface& sampled, const SurfaceOptions& options, const ParameterBox& box) {
  const SurfacePtr surface = sampled.surface;
  const NurbsSurfaceForm form = *surface->exact_nurbs();
  ModelBuilder builder({options.name, ComponentKind::unknown});
  const auto stations = [](Interval range, bool is_closed) {
    return is_closed ? std::vector{range.from, 0.5 * (range.from + range.to), range.to} : std::vector{range.from, range.to};
  };
  const std::vector<double> us = stations(box.u, options.periodic_u), vs = stations(box.v, options.periodic_v);
  const auto length = [&](Uv from, Uv to) {
    constexpr int k_steps = 16;
    double sum = 0.0;
    for (int i = 0; i < k_steps; ++i)
      sum += distance(surface->point(from + (static_cast<double>(i) / k_steps) * (to - from)),
                      surface->point(from + (static_cast<double>(i + 1) / k_steps) * (to - from)));
    return sum;
  };
  const double size = length({box.u.from, box.v.from}, {box.u.to, box.v.to}) + length({box.u.from, box.v.to}, {box.u.to, box.v.from});
  const auto is_pole = [&](Uv from, Uv to) { return length(from, to) <= sampled.error + 1e-9 * size; };
  // Rows and columns that coincide by periodicity have the same number. Those at a pole have only one corner.
  const auto row_of = [](std::size_t i, const std::vector<double>& at, bool is_closed) { return is_closed && i + 1 == at.size() ? std::size_t{0} : i; };
  std::vector<CornerId> corners(us.size() * vs.size());
  std::vector<char> is_u_pole(vs.size()), is_v_pole(us.size());
  for (std::size_t j = 0; j < vs.size(); ++j) is_u_pole[j] = is_pole({box.u.from, vs[j]}, {box.u.to, vs[j]});
  for (std::size_t i = 0; i < us.size(); ++i) is_v_pole[i] = is_pole({us[i], box.v.from}, {us[i], box.v.to});
  const auto corner = [&](std::size_t i, std::size_t j) -> CornerId {
    i = is_u_pole[j] ? 0 : row_of(i, us, options.periodic_u);
    j = is_v_pole[i] ? 0 : row_of(j, vs, options.periodic_v);
    CornerId& id = corners[i * vs.size() + j];
    if (!id.is_valid()) id = builder.corner(surface->point({us[i], vs[j]}));
    return id;
  };
  std::vector<EdgeId> along_u(us.size() * vs.size()), along_v(us.size() * vs.size());
  const auto edge_u = [&](std::size_t i, std::size_t j) {
    EdgeId& id = along_u[i * vs.size() + row_of(j, vs, options.periodic_v)];
    if (!id.is_valid())
      id = is_u_pole[j] ? builder.pole(corner(i, j)) : builder.edge(line_of_constant_v(form, vs[j]), {us[i], us[i + 1]}, corner(i, j), corner(i + 1, j));
    return id;
  };
  const auto edge_v = [&](std::size_t i, std::size_t j) {
    EdgeId& id = along_v[row_of(i, us, options.periodic_u) * vs.size() + j];
    if (!id.is_valid())
      id = is_v_pole[i] ? builder.pole(corner(i, j)) : builder.edge(line_of_constant_u(form, us[i]), {vs[j], vs[j + 1]}, corner(i, j), corner(i, j + 1));
    return id;
  };
  for (std::size_t i = 0; i + 1 < us.size(); ++i)
    for (std::size_t j = 0; j + 1 < vs.size(); ++j)
      builder.patch(surface, {{us[i], us[i + 1]}, {vs[j], vs[j + 1]}}, {edge_u(i, j), edge_v(i + 1, j), edge_u(i, j + 1), edge_v(i, j)}, FaceRole::skin,
                    options.name);
  if (free_edges(builder.model()).empty()) return builder.closed_solid(options.name);
  Model model = builder.model();
  ModelSolid sheet{options.name, {}, false};
  for (const FaceId f : model.faces.ids()) sheet.faces.push_back(f);
  model.solids.push_back(std::move(sheet));
  return model;
}

ScriptValue make_surface(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_surface_usage);
  SurfaceOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  const auto* function = items.empty() ? nullptr : std::get_if<FunctionHandle>(&items.front());
  if (!function)
    reader.add_problem("entry 1: expected a function of (u, v) that returns x, y, z, not " + std::string(items.empty() ? "nothing" : type_text(items.front())));
  refuse_items_beyond(reader, 1);
  const auto u = read_pair(reader, "u", "a range {from, to}"), v = read_pair(reader, "v", "a range {from, to}");
  const auto breaks_u = read_numbers(reader, "breaks_u"), breaks_v = read_numbers(reader, "breaks_v");
  reader.read_options(schema);
  reader.finish();
  const ParameterBox box{u ? Interval{(*u)[0], (*u)[1]} : Interval{}, v ? Interval{(*v)[0], (*v)[1]} : Interval{}};
  const auto f = [&](Uv at) {
    std::array<double, 3> p{};
    (*function)->call(std::array{at.u, at.v}, p);
    return Point{p[0], p[1], p[2]};
  };
  const SampledSurface sampled = sample_surface(f, box,
                                                {.tolerance = options.tolerance,
                                                 .breaks_u = breaks_u.value_or(std::vector<double>{}),
                                                 .breaks_v = breaks_v.value_or(std::vector<double>{}),
                                                 .is_periodic_u = options.periodic_u,
                                                 .is_periodic_v = options.periodic_v,
                                                 .max_intervals = options.max_intervals});
  ModelValue value{.without_description = "it is made from a function"};
  value.report = fmt::format("surface \"{}\": {} x {} samples, at most {:.3g} m from the function", options.name, sampled.n_u, sampled.n_v, sampled.error);
  call.session.context.info(value.report);
  value.model = model_of_surface(sampled, options, box);
  return std::make_shared<const ModelValue>(std::move(value));
}

// ---- Solids --------------------------------------------------------------------------------------------------------------------------------

constexpr std::string_view k_solid_box_usage =
    "box{ {-1, -2, -1}, {9, 2, 3}, name = \"block\" }  or, as a source,  box{ {-1, -2, -1}, {9, 2, 3}, size = 0.05 }";
constexpr std::string_view k_solid_cylinder_usage =
    "cylinder{ {0, 0, 0}, {8, 0, 0}, radius = 1, name = \"tank\" }  or, as a source,  cylinder{ {0, 0, 0}, {8, 0, 0}, radius = 1, size = 0.05 }";

/// Returns two points {x, y, z} from entries 1 and 2.
std::array<Point, 2> two_points(TableReader& reader, std::string_view usage) {
  std::array<Point, 2> points;
  const std::vector<ScriptValue>& items = reader.items();
  for (std::size_t i = 0; i < 2; ++i) {
    const auto p = i < items.size() ? point_of(items[i]) : std::nullopt;
    if (!p) {
      reader.add_problem("expected two points {x, y, z}: " + std::string(usage));
      break;
    }
    points[i] = *p;
  }
  refuse_items_beyond(reader, 2);
  return points;
}

ScriptValue make_solid(const ScriptCall& call, bool is_round) {
  const std::string_view usage = is_round ? k_solid_cylinder_usage : k_solid_box_usage;
  const ScriptTable table = table_argument(call, 0, usage);
  SolidOptions options{.name = std::string(call.verb)};
  OptionTable schema = sterna::options_of(options);
  if (!is_round) schema.pop_back();
  TableReader reader(table, call.attempted());
  const auto [from, to] = two_points(reader, usage);
  reader.read_options(schema);
  reader.require(schema);
  reader.finish();
  ModelValue value{.without_description = "it is a " + std::string(call.verb)};
  value.model = is_round ? make_cylinder(options.name, from, to, options.radius) : make_box(options.name, from, to);
  return std::make_shared<const ModelValue>(std::move(value));
}

template <class Options>
std::string geometry_help_of() {
  Options options;
  return options_help(sterna::options_of(options));
}

constexpr std::array<ScriptVerb, 5> k_geometry_verbs = {{
    {"read_cad", k_read_cad_usage, "Reads a STEP, IGES or BREP file, repairs it and reports what it found.", read_cad_verb, nullptr, true, "model", true,
     held_options<ReadCadOptions>},
    {"read_smx", k_read_smx_usage, "Reads a geometry file of sumo. Its components stay separate.", read_description<read_smx_model>, control_settings_help,
     true, "model", true},
    {"read_cpacs", k_read_cpacs_usage, "Reads a CPACS file. Its components stay separate.", read_description<read_cpacs_model>, control_settings_help, true,
     "model", true},
    {"airfoil", k_airfoil_usage, "Makes a wing section from a NACA designation, a file (Selig or Lednicer) or points.", make_airfoil,
     geometry_help_of<AirfoilOptions>, false, "airfoil"},
    {"surface", k_surface_usage, "Makes a surface from a function, approximated by a spline that is checked between its samples.", make_surface,
     geometry_help_of<SurfaceOptions>, false, "model"},
}};

}  // namespace

const ScriptVerb k_airfoil_field = {"airfoil", "", "", airfoil_field};

std::span<const ScriptVerb> geometry_verbs() { return k_geometry_verbs; }

std::string describe(const Airfoil& airfoil) {
  const AirfoilMeasures m = measure(airfoil);
  return fmt::format("Airfoil: {}, {} points, {:.2f} % thick at {:.1f} %, {:.2f} % camber, trailing edge {:.3g} of the chord", airfoil.name,
                     airfoil.points.size(), 100.0 * m.thickness, 100.0 * m.thickness_at, 100.0 * m.camber, airfoil.trailing_edge_thickness());
}

ScriptValue make_box_model(const ScriptCall& call) { return make_solid(call, false); }
ScriptValue make_cylinder_model(const ScriptCall& call) { return make_solid(call, true); }

ScriptValue unite_models(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, "union{ model, sting }");
  UniteOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  std::vector<ModelHandle> models;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto* name = std::get_if<std::string>(&items[i]);
    if (ModelHandle model = model_of(items[i], call)) models.push_back(std::move(model));
    else if (name && is_model_file(*name))
      models.push_back(std::make_shared<const ModelValue>(read_model(find_input(call, *name), {}, call.session.context.part("read", 0.0, 0.2))));
    else
      reader.add_problem("entry " + std::to_string(i + 1) + ": union takes models (exact geometry) or triangulated surfaces, not both; this is " +
                         (name ? "the file of a surface, \"" + *name + "\"" : std::string(type_text(items[i]))));
  }
  reader.read_options(schema);
  apply_overrides(call, schema);
  reader.finish();
  if (is_sketch(call)) return std::make_shared<const ModelValue>(assemble(models, call.session.context));
  return std::make_shared<const ModelValue>(unite_solids(models, options, call.session.context.part("union", 0.2, 1.0)));
}

std::optional<Airfoil> read_airfoil_value(const ScriptValue& value, const ScriptCall& call, TableReader& reader, const std::string& where) {
  try {
    if (const auto* airfoil = std::get_if<AirfoilHandle>(&value)) return **airfoil;
    if (const auto* text = std::get_if<std::string>(&value)) {
      const InputPath file = find_input(call, *text);
      // A designation has no extension. If there is a file of that name, the file wins.
      const bool is_file = std::filesystem::exists(file.path) || (file.path.has_extension() && text->find(' ') == std::string::npos);
      return is_file ? read_airfoil(file.path) : naca_airfoil(*text);
    }
    if (const auto rows = rows_of(value, 2)) return airfoil_of_points(*rows);
    reader.add_problem(where + ": expected a NACA designation, a file name, an airfoil or a list of points {x, z}, not " + std::string(type_text(value)));
  } catch (const Error& error) {
    const ErrorInfo& info = error.info();
    reader.add_problem(where + ": " + info.attempted + ": " + info.problem + (info.hint.empty() ? "" : " (" + info.hint + ")"));
  }
  return std::nullopt;
}

}  // namespace sterna::scripting
