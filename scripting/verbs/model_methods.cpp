#include "scripting/verbs/model_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "geom/base/glob.h"
#include "geom/model/deform.h"
#include "geom/model/radial_map.h"
#include "scripting/lua/script_check.h"
#include "scripting/lua/script_function.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/models.h"
#include "scripting/values/sampled_map.h"
#include "scripting/verbs/control_options.h"

namespace sterna::scripting {

/// A full turn. Larger values are degrees that were given without `*deg`.
inline constexpr double k_turn = 6.2831853071795865;

struct RotateOptions {
  double pitch = 0.0;
  double yaw = 0.0;
  double roll = 0.0;
  double angle = 0.0;
};
struct ScaleOptions {
  double factor = k_automatic;
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::RotateOptions> {
  using O = scripting::RotateOptions;
  static constexpr std::string_view stage = "rotate";
  static constexpr std::array fields = {
      Field<O>{.name = "pitch",
               .member = &O::pitch,
               .unit = Unit::radian,
               .min = -scripting::k_turn,
               .max = scripting::k_turn,
               .help = "pitch angle about +y, positive nose up; applied after roll"},
      Field<O>{.name = "yaw",
               .member = &O::yaw,
               .unit = Unit::radian,
               .min = -scripting::k_turn,
               .max = scripting::k_turn,
               .help = "yaw angle about -z, positive nose to starboard; applied last"},
      Field<O>{.name = "roll",
               .member = &O::roll,
               .unit = Unit::radian,
               .min = -scripting::k_turn,
               .max = scripting::k_turn,
               .help = "roll angle about -x, positive with the starboard wing down; applied first"},
      Field<O>{.name = "angle",
               .member = &O::angle,
               .unit = Unit::radian,
               .min = -scripting::k_turn,
               .max = scripting::k_turn,
               .help = "right-handed rotation about `axis`, instead of pitch, yaw and roll"},
  };
};
template <>
struct Schema<scripting::ScaleOptions> {
  using O = scripting::ScaleOptions;
  static constexpr std::string_view stage = "scale";
  static constexpr std::array fields = {
      Field<O>{.name = "factor", .member = &O::factor, .min = 1e-9, .max = 1e9, .help = "scale factor of all lengths", .required = true},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

constexpr std::string_view k_move_usage = "model:move{ 0, 0, 1.5 }";
constexpr std::string_view k_rotate_usage =
    "model:rotate{ about = {1.2, 0, 0}, pitch = 4*deg, yaw = 2*deg }  or  model:rotate{ axis = {0, 0, 1}, angle = 30*deg }";
constexpr std::string_view k_scale_usage = "model:scale(0.1)  or  model:scale{ factor = 0.1, about = {0, 0, 0} }";
constexpr std::string_view k_mirror_usage = "model:mirror{ normal = {0, 1, 0}, at = {0, 0, 0} }";
constexpr std::string_view k_deform_usage =
    "model:deform{ function(x, y, z) return 0, 0, 0.02*y^2 end }  or  model:deform{ {{0, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0.1}, {1, 1, 0, "
    "0, 0, 0.1}, {0, 0, 1, 0, 0, 0}}, kernel = \"thin_plate\" }";
constexpr std::string_view k_write_usage = "model:write(\"a.step\", \"a.igs\", \"a.brep\")  or  model:write{ \"a.step\", step_schema = \"ap242\" }";
constexpr std::string_view k_kinds_usage = "model:kinds{ [\"Body*\"] = \"slip\" }";
constexpr std::string_view k_deflect_model_usage = "airliner:deflect{ [\"Rud*\"] = { angle = 5*deg, gap = \"sealed\" } }";
constexpr std::string_view k_rename_usage = "model:rename{ Body = \"fuselage\" }";

/// Returns the model without its description, which is no longer valid.
ScriptValue without_description(ModelValue value, std::string_view by) {
  if (value.description) value.without_description = "it was changed by " + std::string(by);
  value.description.reset();
  value.is_as_described = false;
  return std::make_shared<const ModelValue>(std::move(value));
}

/// Returns a model whose geometry was replaced. It is one part, at its location.
ScriptValue changed(const ModelHandle& old, Model model, std::string_view by) {
  ModelValue value = *old;
  value.model = std::move(model);
  value.parts.clear();
  return without_description(std::move(value), by);
}

/// Returns the same model at another location.
ScriptValue moved(const ModelHandle& old, const Transform& motion, std::string_view by) {
  ModelValue value = *old;
  value.parts = parts_of(*old);  // the key of the inputs of `old` is used here, because copies of a value lose their key
  move_parts(motion, value);
  return without_description(std::move(value), by);
}

ScriptValue deflect_model(const ScriptCall& call) {
  const ModelHandle& model = self<ModelHandle>(call);
  const ScriptTable table = table_argument(call, 1, k_deflect_model_usage);
  const ScriptTable nothing;
  TableReader reader(nothing, call.attempted());
  const std::vector<ControlSetting> settings = read_control_settings(table, "deflect", reader);
  reader.finish();
  return std::make_shared<const ModelValue>(deflected_model(*model, settings, call.session.context.part("deflect", 0.0, 1.0)));
}

std::string deflect_model_help() { return control_settings_help(); }

ScriptValue move_model(const ScriptCall& call) { return moved(self<ModelHandle>(call), read_shift(call, k_move_usage), "move"); }
ScriptValue rotate_model(const ScriptCall& call) { return moved(self<ModelHandle>(call), read_turn(call, k_rotate_usage), "rotate"); }

ScriptValue scale_model(const ScriptCall& call) {
  const ModelHandle& model = self<ModelHandle>(call);
  ScriptTable table = table_argument(call, 1, k_scale_usage);
  if (table.items.size() == 1 && !table.fields.contains("factor")) {
    table.fields["factor"] = table.items.front();
    table.items.clear();
  }
  ScaleOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  const Point about = read_point(reader, "about").value_or(Point{});
  reader.read_options(schema);
  reader.require(schema);
  reader.finish();
  return changed(model, transformed(model->model, scaling(about, options.factor)), "scale");
}

ScriptValue mirror_model(const ScriptCall& call) {
  const ModelHandle& model = self<ModelHandle>(call);
  const ScriptTable table = table_argument(call, 1, k_mirror_usage);
  TableReader reader(table, call.attempted());
  const Vec3 normal = read_point(reader, "normal").value_or(Vec3{0.0, 1.0, 0.0});
  const Point at = read_point(reader, "at").value_or(Point{});
  if (norm(normal) == 0.0) reader.add_problem("normal: has no direction");
  reader.finish();
  ModelValue value = *model;
  value.parts = parts_of(*model);
  mirror_parts(at, normal, value);
  return without_description(std::move(value), "mirror");
}

// ---- Deforming -----------------------------------------------------------------------------------------------------------------------------

std::shared_ptr<const SampledMap> map_of_function(const FunctionHandle& function, const Model& model, const SampledMapOptions& options,
                                                  const ScriptCall& call) {
  const auto displacement = [&](const Point& p) {
    std::array<double, 3> d{};
    function->call(std::array{p.x, p.y, p.z}, d);
    return Vec3{d[0], d[1], d[2]};
  };
  auto map = std::make_shared<const SampledMap>(displacement, box_of(model), options);
  call.session.context.info(fmt::format("deformation: a spline of {} samples, at most {:.3g} m off the function, which moves by up to {:.4g} m",
                                        map->n_samples(), map->error(), map->largest()));
  return map;
}

std::optional<ScatteredDisplacements> displacements_of(const ScriptValue& value, const ScriptCall& call, TableReader& reader) {
  if (const auto* name = std::get_if<std::string>(&value)) return read_displacements(find_input(call, *name).path);
  const auto rows = rows_of(value, 6);
  if (!rows) {
    reader.add_problem("entry 1: expected a function of (x, y, z), a file, or a list of rows {x, y, z, dx, dy, dz}, not " + std::string(type_text(value)));
    return std::nullopt;
  }
  ScatteredDisplacements data;
  for (const std::vector<double>& row : *rows) {
    data.at.push_back({row[0], row[1], row[2]});
    data.shift.push_back({row[3], row[4], row[5]});
  }
  return data;
}

ScriptValue deform_model(const ScriptCall& call) {
  const ModelHandle& model = self<ModelHandle>(call);
  const ScriptTable table = table_argument(call, 1, k_deform_usage);
  SampledMapOptions function_options;
  RadialMapOptions radial_options;
  const OptionTable function_schema = sterna::options_of(function_options), radial_schema = sterna::options_of(radial_options);
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  const auto* function = items.empty() ? nullptr : std::get_if<FunctionHandle>(&items.front());
  std::optional<ScatteredDisplacements> data;
  if (items.empty()) reader.add_problem("needs a function, a file or a list of displacements: " + std::string(k_deform_usage));
  else if (!function) data = displacements_of(items.front(), call, reader);
  refuse_items_beyond(reader, 1);
  reader.read_options(function ? function_schema : radial_schema);
  reader.finish();
  SpaceMapPtr map;
  if (function) map = map_of_function(*function, model->model, function_options, call);
  else map = std::make_shared<RadialMap>(*data, radial_options);
  return changed(model, deformed(model->model, map, call.session.context.part("deform", 0.0, 1.0)), "deform");
}

// ---- Names ---------------------------------------------------------------------------------------------------------------------------------

ScriptValue rename_model(const ScriptCall& call) {
  const ModelHandle& handle = self<ModelHandle>(call);
  const ScriptTable table = table_argument(call, 1, k_rename_usage);
  TableReader reader(table, call.attempted());
  std::vector<std::string> known;
  for (const Component& component : handle->model.components) known.push_back(component.name);
  for (const ModelFace& face : handle->model.faces) known.push_back(face.name);
  Model model = handle->model;
  for (const auto& [from, value] : table.fields) {
    reader.field(from);
    const auto* to = std::get_if<std::string>(&value);
    if (!to || to->empty()) reader.add_problem(from + ": expected a new name, not " + std::string(to ? "an empty string" : type_text(value)));
    if (std::find(known.begin(), known.end(), from) == known.end() && !is_placeholder(call, handle)) {
      const std::string nearest = nearest_name(from, known);
      reader.add_problem("no component and no face is named \"" + from + "\"" + (nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?"));
    }
    if (!to) continue;
    for (const ComponentId c : model.components.ids())
      if (handle->model.components[c].name == from) model.components[c].name = *to;
    for (const FaceId f : model.faces.ids())
      if (handle->model.faces[f].name == from) model.faces[f].name = *to;
    for (const SolidId s : model.solids.ids())
      if (handle->model.solids[s].name == from) model.solids[s].name = *to;
  }
  reader.finish();
  ModelValue renamed = *handle;
  for (Rule& rule : renamed.sizes)
    if (const auto field = table.fields.find(rule.names); field != table.fields.end()) rule.names = std::get<std::string>(field->second);
  for (Rule& rule : renamed.layers)
    if (const auto field = table.fields.find(rule.names); field != table.fields.end()) rule.names = std::get<std::string>(field->second);
  renamed.model = std::move(model);
  return without_description(std::move(renamed), "rename");
}

ScriptValue set_kinds(const ScriptCall& call) {
  const ModelHandle& handle = self<ModelHandle>(call);
  const ScriptTable table = table_argument(call, 1, k_kinds_usage);
  TableReader reader(table, call.attempted());
  ModelValue value = *handle;
  value.is_as_described = false;
  // Patterns with more literal letters come later, so that their names win.
  std::vector<std::string> patterns;
  for (const auto& [pattern, kind] : table.fields) patterns.push_back(pattern);
  std::stable_sort(patterns.begin(), patterns.end(), [](const std::string& a, const std::string& b) { return n_spelled_out(a) < n_spelled_out(b); });
  for (const std::string& pattern : patterns) {
    const std::optional<PatchKind> kind = read_patch_kind(*reader.field(pattern), pattern, reader);
    bool is_used = false;
    for (ModelFace& face : value.model.faces) {
      if (!matches_glob(face.name, pattern)) continue;
      is_used = true;
      face.kind = kind;
    }
    if (!is_used && !is_placeholder(call, handle)) reader.add_problem("no face has a name like \"" + pattern + "\"");
  }
  if (patterns.empty()) reader.add_problem("expected names of faces: " + std::string(k_kinds_usage));
  reader.finish();
  return std::make_shared<const ModelValue>(std::move(value));
}

ScriptValue select_model(const ScriptCall& call) {
  const ModelHandle& model = self<ModelHandle>(call);
  const ScriptTable table = table_argument(call, 1, "model:select \"wing*\"");
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  const auto* pattern = items.size() == 1 ? std::get_if<std::string>(&items.front()) : nullptr;
  if (!pattern) reader.add_problem("expected a name of components, with '*' for any characters: model:select \"wing*\"");
  reader.finish();
  return changed(model, select_components(model->model, *pattern, call.attempted()), "select");
}

// ---- Measures ------------------------------------------------------------------------------------------------------------------------------

ScriptValue table_of(const PartMeasures& part) {
  auto table = std::make_shared<ScriptTable>();
  table->fields = {
      {"area", part.area}, {"projected_area", part.projected_area}, {"faces", static_cast<std::int64_t>(part.n_faces)}, {"is_closed", part.is_closed}};
  if (part.is_closed) table->fields["volume"] = part.volume;
  if (!part.kind.empty()) table->fields["kind"] = part.kind;
  if (!part.box.empty()) {
    auto box = std::make_shared<ScriptTable>();
    box->items = {list_of(part.box.min), list_of(part.box.max)};
    table->fields["box"] = TableHandle(box);
  }
  return table;
}

ScriptValue measure_verb(const ScriptCall& call) {
  const ModelHandle& model = self<ModelHandle>(call);
  finish_checks(call);
  const ModelReport m = measure_model(*model, call.session.context.part("measures", 0.0, 1.0));
  auto result = std::make_shared<ScriptTable>(*std::get<TableHandle>(table_of(m.total)));
  const auto add = [&](const char* name, const std::vector<PartMeasures>& parts) {
    auto list = std::make_shared<ScriptTable>();
    for (const PartMeasures& part : parts) list->fields[part.name] = table_of(part);
    result->fields[name] = TableHandle(list);
  };
  add("components", m.components);
  add("solids", m.solids);
  auto wings = std::make_shared<ScriptTable>();
  for (const WingReference& w : m.wings) wings->fields[w.name] = wing_table(w);
  result->fields["wings"] = TableHandle(wings);
  if (!m.no_wings.empty()) call.session.context.warn(call.attempted() + ": no reference data of wings, which only wings defined as data have: " + m.no_wings);
  return result;
}

ScriptValue info_verb(const ScriptCall& call) {
  const ModelHandle& model = self<ModelHandle>(call);
  finish_checks(call);
  std::string text = describe(*model) + "\n" + measures_text(measure_model(*model, call.session.context.part("info", 0.0, 1.0)));
  text += "\n  " + closedness_text(model->model, 10);
  call.session.print(text);
  return model;
}

// ---- Writing, fields -----------------------------------------------------------------------------------------------------------------------

ScriptValue write_model_files(const ScriptCall& call) {
  const ModelHandle& model = self<ModelHandle>(call);
  ScriptTable table;
  if (call.arguments.size() == 2) table = table_argument(call, 1, k_write_usage);
  else table.items.assign(call.arguments.begin() + 1, call.arguments.end());
  WriteCadOptions options;
  TableReader reader(table, call.attempted());
  std::vector<std::filesystem::path> names;
  for (const ScriptValue& item : reader.items()) {
    if (const auto* name = std::get_if<std::string>(&item)) names.push_back(output_path(call, *name));
    else reader.add_problem("expected file names, not " + std::string(type_text(item)));
  }
  if (names.empty()) reader.add_problem("needs at least one file name: " + std::string(k_write_usage));
  reader.read_options(sterna::options_of(options));
  for (const auto& name : names) note_output(call, name);
  for (const auto& name : names)
    if (!is_placeholder(call, model) || name.extension() != ".smx") require_model_output(*model, name);
  reader.finish();
  for (const auto& name : names) {
    write_model(*model, name, options, call.session.context.part("write", 0.0, 1.0));
    call.session.context.info("wrote " + name.string() + ": " + describe(*model));
  }
  return model;
}

std::string write_help() {
  WriteCadOptions options;
  return options_help(sterna::options_of(options));
}
std::string deform_help() {
  SampledMapOptions function;
  RadialMapOptions radial;
  return "for a function:\n" + options_help(sterna::options_of(function)) + "for displacements at points:\n" + options_help(sterna::options_of(radial));
}
template <class Options>
std::string model_help_of() {
  Options options;
  return options_help(sterna::options_of(options));
}

template <class Column>
ScriptValue names_of(const Column& column) {
  auto names = std::make_shared<ScriptTable>();
  std::vector<std::string> seen;
  for (const auto& item : column)
    if (std::find(seen.begin(), seen.end(), item.name) == seen.end()) {
      seen.push_back(item.name);
      names->items.emplace_back(item.name);
    }
  return TableHandle(names);
}

ScriptValue model_field(const ScriptCall& call) {
  const ModelHandle& handle = self<ModelHandle>(call);
  const auto* name = call.arguments.size() < 2 ? nullptr : std::get_if<std::string>(&call.arguments[1]);
  if (name && is_placeholder(call, handle) && name->find_first_of("*?") != std::string::npos) return handle;
  if (name && name->find_first_of("*?") != std::string::npos) return changed(handle, select_components(handle->model, *name, call.attempted()), "select");
  const Model& model = handle->model;
  Fields fields = {{"components", names_of(model.components)},
                   {"patches", names_of(model.faces)},
                   {"solids", names_of(model.solids)},
                   {"faces", static_cast<std::int64_t>(model.faces.size())},
                   {"edges", static_cast<std::int64_t>(model.edges.size())},
                   {"is_closed", !model.faces.empty() && free_edges(model).empty()},
                   {"unit", model.source_unit},
                   {"report", handle->report}};
  const Box box = box_of(model);
  if (!box.empty()) {
    fields.emplace_back("length", box.max.x - box.min.x);
    fields.emplace_back("min", list_of(box.min));
    fields.emplace_back("max", list_of(box.max));
  }
  // Any name in m.components can be used as a field, except names of members and methods.
  const bool is_member = name && (std::any_of(fields.begin(), fields.end(), [&](const auto& field) { return field.first == *name; }) ||
                                  std::any_of(model_methods().begin(), model_methods().end(),
                                              [&](const ScriptVerb& verb) { return verb.name.substr(verb.name.find(':') + 1) == *name; }));
  if (name && !is_member && std::any_of(model.components.begin(), model.components.end(), [&](const Component& c) { return c.name == *name; }))
    return changed(handle, select_components(model, *name, call.attempted()), "select");
  try {
    return select_field(call, std::move(fields), model_methods());
  } catch (const Error& error) {
    if (!name) throw;
    ErrorInfo info = error.info();
    info.hint += "; components:";
    for (const Component& component : model.components) info.hint += " " + component.name;
    throw Error(std::move(info));
  }
}

constexpr std::array<ScriptVerb, 12> k_methods = {{
    {"model:write", k_write_usage, "Writes STEP, IGES or BREP, or sumo's .smx for models whose components are defined as data.", write_model_files, write_help,
     true, "self"},
    {"model:move", k_move_usage, "Returns the model moved, in metres.", move_model, nullptr, true, "model"},
    {"model:rotate", k_rotate_usage, "Returns the model rotated: x points aft, y to starboard, z up.", rotate_model, rotate_help, true, "model"},
    {"model:scale", k_scale_usage, "Returns the model scaled.", scale_model, model_help_of<ScaleOptions>, true, "model"},
    {"model:mirror", k_mirror_usage, "Returns the mirror image, by default in the plane y = 0; left and right are exchanged in names.", mirror_model, nullptr,
     true, "model"},
    {"model:deform", k_deform_usage,
     "Returns the model deformed by a function that gives displacements, or by displacements at points. The geometry is not refitted.", deform_model,
     deform_help, true, "model"},
    {"model:deflect", k_deflect_model_usage, "Returns a model of read_smx or read_cpacs with control surfaces deflected geometrically, as by wing:deflect{}.",
     deflect_model, deflect_model_help, true, "model"},
    {"model:rename", k_rename_usage, "Returns the model with other names of components, solids and patches.", rename_model, nullptr, true, "model"},
    {"model:kinds", k_kinds_usage, "Returns the model with other kinds of patches: wall, slip, symmetry, inflow, outflow, farfield, interface.", set_kinds,
     nullptr, true, "model"},
    {"model:select", "model:select \"Body*\"  or  model[\"Body*\"]", "Returns the components with a matching name as a model.", select_model, nullptr, true,
     "model"},
    {"model:measures", "model:measures()",
     "Returns a table with areas, volumes and bounding boxes of the model, its solids and components, and reference data of its wings.", measure_verb, nullptr,
     true, "table"},
    {"model:info", "model:info()", "Prints areas, volumes, bounding boxes and reference data, and where the model is open.", info_verb, nullptr, true},
}};

}  // namespace

Transform read_shift(const ScriptCall& call, std::string_view usage) {
  const ScriptTable table = table_argument(call, 1, usage);
  TableReader reader(table, call.attempted());
  // Accepts move{ {x, y, z} } as well as move{ x, y, z }.
  auto shift = table.items.size() == 1 ? point_of(table.items.front()) : point_of(std::make_shared<const ScriptTable>(ScriptTable{reader.items(), {}, {}}));
  reader.items();
  if (!shift) reader.add_problem("expected three numbers, dx, dy, dz in metres: " + std::string(usage));
  reader.finish();
  return translation(*shift);
}

Transform read_turn(const ScriptCall& call, std::string_view usage) {
  const ScriptTable table = table_argument(call, 1, usage);
  RotateOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  const Point about = read_point(reader, "about").value_or(Point{});
  const auto axis = read_point(reader, "axis");
  reader.read_options(schema);
  const bool has_attitude = table.fields.contains("pitch") || table.fields.contains("yaw") || table.fields.contains("roll");
  const bool has_axis = table.fields.contains("axis") || table.fields.contains("angle");
  if (has_attitude && has_axis) reader.add_problem("give pitch, yaw and roll, or axis and angle, not both");
  else if (!has_attitude && !has_axis) reader.add_problem("needs pitch, yaw or roll, or axis and angle: " + std::string(usage));
  else if (has_axis && !(axis && table.fields.contains("angle"))) reader.add_problem("axis and angle belong together: " + std::string(usage));
  reader.finish();
  return axis ? rotation(about, *axis, options.angle) : attitude(about, options.roll, options.pitch, options.yaw);
}

std::string rotate_help() { return model_help_of<RotateOptions>(); }

const ScriptVerb k_model_field = {"model", "", "", model_field};

std::span<const ScriptVerb> model_methods() { return k_methods; }

}  // namespace sterna::scripting
