#include "scripting/interpreter/script_verbs.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "geom/base/error.h"
#include "geom/cad/unite.h"
#include "io/volume/volume_vtu.h"
#include "scripting/interpreter/script_args.h"
#include "scripting/interpreter/script_help.h"
#include "scripting/interpreter/script_objects.h"
#include "scripting/lua/quantity.h"
#include "scripting/lua/script_check.h"
#include "scripting/lua/table_reader.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/report/report_verbs.h"
#include "scripting/series/series_verbs.h"
#include "scripting/values/check_options.h"
#include "scripting/values/disc_verbs.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/layer_options.h"
#include "scripting/values/manifest.h"
#include "scripting/values/models.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/stored_stages.h"
#include "scripting/values/summary.h"
#include "scripting/values/surface_items.h"
#include "scripting/values/verbs.h"
#include "scripting/values/wake_verbs.h"
#include "scripting/verbs/component_verbs.h"
#include "scripting/verbs/draw_verbs.h"
#include "scripting/verbs/envelope_steps.h"
#include "scripting/verbs/family_gate.h"
#include "scripting/verbs/farfield_verbs.h"
#include "scripting/verbs/foam_verbs.h"
#include "scripting/verbs/gate_limits.h"
#include "scripting/verbs/geometry_verbs.h"
#include "scripting/verbs/half_verbs.h"
#include "scripting/verbs/inspect_verbs.h"
#include "scripting/verbs/model_gates.h"
#include "scripting/verbs/model_methods.h"
#include "scripting/verbs/repair_verbs.h"
#include "scripting/verbs/source_verbs.h"
#include "scripting/verbs/stage_verbs.h"
#include "scripting/verbs/su2_verbs.h"
#include "scripting/verbs/surface_motion.h"
#include "scripting/verbs/surface_verbs.h"
#include "scripting/verbs/tunnel_verbs.h"
#include "scripting/verbs/volume_case.h"
#include "scripting/verbs/wrap_verbs.h"

namespace sterna::scripting {
namespace {

// ---- read_surface, read_mesh -------------------------------------------------------------------------------------------------------------

constexpr std::string_view k_read_surface_usage = "read_surface{ \"wing.stl\", unit = mm, split_angle = 40*deg }  or  read_surface \"wing.stl\"";

ScriptValue read_surface(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_read_surface_usage);
  surfmesh::StitchOptions options;
  const OptionTable schema = sterna::options_of(options);
  TableReader reader(table, call.attempted());
  const std::vector<InputPath> files = file_names(call, reader);
  reader.read_options(schema);
  const SurfaceReader read_otherwise = read_surface_entry(reader, call);
  const RemeshEntry remesh = read_remesh_entry(reader, call);
  apply_overrides(call, schema);
  reader.finish();
  const RunContext part = call.session.context.part("read_surface", 0.0, remesh ? 0.5 : 1.0);
  SurfaceValue wall = read_otherwise ? read_otherwise(files, options, part, call.session.reuse()) : read_wall(files, options, part);
  if (remesh) wall = remesh(wall, call.session.context.part("remesh", 0.5, 1.0), call.session.reuse());
  return std::make_shared<const SurfaceValue>(std::move(wall));
}

constexpr std::string_view k_union_usage = "union{ wall, \"sting.stl\", strip_width = 4 }  or, of models,  union{ model, \"sting.step\", tolerance = 1e-6 }";

/// Returns "unit" of reading a surface, for files read by union.
OptionTable unit_option(surfmesh::StitchOptions& options) {
  OptionTable schema = sterna::options_of(options);
  std::erase_if(schema, [](const Option& option) { return option.name != "unit"; });
  return schema;
}

/// Returns true if the table contains models, components or files of either; union then uses exact geometry.
bool has_model(const ScriptTable& table) {
  return std::any_of(table.items.begin(), table.items.end(), [](const ScriptValue& item) {
    const auto* name = std::get_if<std::string>(&item);
    return std::holds_alternative<ModelHandle>(item) || std::holds_alternative<ComponentHandle>(item) || (name && is_model_file(*name));
  });
}

ScriptValue unite(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_union_usage);
  if (has_model(table)) return unite_models(call);
  UnionOptions options;
  surfmesh::StitchOptions reading;
  const OptionTable schema = sterna::options_of(options), unit = unit_option(reading);
  TableReader reader(table, call.attempted());
  const std::vector<UnionItem> items = read_surfaces_and_files(reader, call);
  reader.read_options(schema);
  reader.read_options(unit);
  apply_overrides(call, schema);
  reader.finish();
  return std::make_shared<const SurfaceValue>(unite_surfaces(items, reading.unit, options, call.session.context.part("union", 0.0, 1.0)));
}

constexpr std::string_view k_read_mesh_usage = "read_mesh \"mesh.su2\"";

ScriptValue read_mesh_file(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_read_mesh_usage);
  TableReader reader(table, call.attempted());
  const std::vector<InputPath> files = file_names(call, reader);
  if (files.size() > 1) reader.add_problem("takes one file, not " + std::to_string(files.size()));
  reader.finish();
  return std::make_shared<const MeshValue>(read_mesh(files.front(), call.session.context.part("read_mesh", 0.0, 1.0)));
}

// ---- volume_mesh, sphere -----------------------------------------------------------------------------------------------------------------

constexpr std::string_view k_volume_mesh_usage =
    "volume_mesh{ wall, layers = 32, first_height = 1e-6, farfield = sphere{ radius = 100 }, patches = { [\"Body*\"] = { first_height = 1e-5 } }, stages = "
    "\"case.sterna\" }";

ScriptValue make_mesh(const ScriptCall& call) {
  VolumeCase made;
  const ScriptTable table = with_farfield(call, table_argument(call, 0, k_volume_mesh_usage), made.options.farfield_surface, made.farfield_inputs);
  const OptionTable schema = volmesh::options_of(made.options);
  TableReader reader(table, call.attempted());
  const std::vector<ScriptValue>& items = reader.items();
  const SurfaceHandle* wall = items.empty() ? nullptr : std::get_if<SurfaceHandle>(&items.front());
  if (!wall)
    reader.add_problem("entry 1: expected a surface (from surface_mesh or read_surface), not " +
                       std::string(items.empty() ? "nothing" : type_text(items.front())));
  else if (items.size() > 1)
    reader.add_problem("takes one surface, not " + std::to_string(items.size()) + " (read_surface{ \"a.stl\", \"b.stl\" } joins files)");
  read_volume_case(reader, call, schema, SourceEntries::taken, made);
  const std::filesystem::path stages = output_entry(reader, call, "stages", "the name of a .sterna file");
  complete_volume_case(reader, call, schema, made);
  require_volume_options(reader, made, wall ? wall->get() : nullptr);
  reader.finish();
  const SurfaceValue given = wall_of_case(**wall, made, call.session.context);
  auto mesh = std::make_shared<const MeshValue>(
      make_volume_mesh(given, made.options, stages, call.session.context.part("volume_mesh", 0.0, 1.0), call.session.reuse()));
  if (call.session.on_mesh) call.session.on_mesh(*mesh);
  return mesh;
}

constexpr std::string_view k_sphere_usage = "sphere{ radius = 100, edge = 20 }  or, as a source,  sphere{ {0, 0, 0}, radius = 1, size = 0.1 }";

// ---- Methods and fields --------------------------------------------------------------------------------------------------------------------

ScriptValue write_surface_files(const ScriptCall& call) {
  const SurfaceHandle& surface = self<SurfaceHandle>(call);
  const auto names = output_names(call);
  for (const auto& name : names) require_surface_output(name);
  finish_checks(call);
  for (const auto& name : names) {
    write_surface(*surface, name, call.session.context);
    call.session.context.info("wrote " + name.string() + ": " + describe(*surface));
  }
  return surface;
}

ScriptValue write_mesh_files(const ScriptCall& call) {
  const MeshHandle& mesh = self<MeshHandle>(call);
  WriteOptions options;
  const OptionTable schema = sterna::options_of(options);
  const auto names = output_names(call, schema);
  apply_overrides(call, schema);
  for (const auto& name : names) require_mesh_output(name);
  finish_checks(call);
  for (const auto& name : names) write_mesh(*mesh, name, options, call.session.context);
  call.session.context.info(wrote_text(names));
  return mesh;
}

std::string check_help() {
  CheckSettings options;
  return options_help(sterna::options_of(options)) + gate_limits_help() +
         "details = true: prints all gates with their worst locations, as `sterna check`, instead of the verdict and the worst three\n" +
         "cells = \"cells.vtu\": writes the mesh with the quality of each cell, as VTK defines it\n" +
         "wall = wall: the surface of surface_mesh from which the mesh was made; nodes and facets of the mesh are compared with its model (gates G17, G18)\n";
}

ScriptValue check_mesh(const ScriptCall& call) {
  const MeshHandle& mesh = self<MeshHandle>(call);
  const ScriptTable table = table_argument(call, 1, "mesh:check{ strict = true, gates = { orthogonality = { hard = 3*deg } } }");
  CheckSettings options;
  TableReader reader(table, call.attempted());
  const std::size_t n_options = reader.read_options(sterna::options_of(options));
  GateTable limits;
  const bool has_limits = read_gate_limits(reader, limits);
  bool is_detailed = false;
  if (const ScriptValue* value = reader.field("details")) {
    if (const bool* flag = std::get_if<bool>(value)) is_detailed = *flag;
    else reader.add_problem("details: expected true or false, not " + std::string(type_text(*value)));
  }
  std::filesystem::path cells;
  if (const ScriptValue* value = reader.field("cells")) {
    if (const auto* name = std::get_if<std::string>(value)) {
      cells = output_path(call, *name);
      if (cells.extension() != ".vtu") reader.add_problem("cells: the quality of cells is written as a .vtu file, not " + *name);
    } else reader.add_problem("cells: expected the name of a .vtu file, not " + std::string(type_text(*value)));
  }
  SurfaceHandle wall;
  if (const ScriptValue* value = reader.field("wall")) {
    if (const auto* surface = std::get_if<SurfaceHandle>(value)) wall = *surface;
    else reader.add_problem("wall: expected the surface of surface_mesh, not " + std::string(type_text(*value)));
    if (!options.quality) reader.add_problem("wall: the gates G17 and G18 belong to quality, which is false");
  }
  if (const auto found = options.contradiction(limits, {}, CheckSettings::k_script_names)) reader.add_problem(found->problem + "; " + found->remedy);
  reader.finish();
  if (wall) require_model_wall(*wall, call.attempted());
  // A mesh that was made in this run has been checked with the default options, and cannot have changed since.
  const bool is_known = mesh->check && n_options == 0 && !has_limits;
  const RunContext context = call.session.context.part("check", 0.0, 1.0);
  CheckReport report = is_known ? *mesh->check : check(mesh->mesh, options.to_options(limits), context.part("mesh", 0.0, wall ? 0.5 : 1.0));
  if (wall && report.quality_measured) measure_on_model(mesh->mesh, *wall, limits, report, context.part("model", 0.5, 1.0));
  if (!cells.empty()) io::write_quality_vtu(mesh->mesh, cells, call.session.context);
  if (is_detailed) {
    call.session.print(check_text(report, mesh->mesh));
  } else {
    call.session.print(check_summary_text(report, !is_known || wall));  // the summary of volume_mesh has already reported the worst values of a new mesh
    call.session.context.debug(to_text(report));
  }
  if (report.quality_measured && report.intersections_checked) mesh->check = report;
  if (options.accepts(report)) return mesh;
  ErrorInfo info{.code = ErrorCode::mesh_invalid,
                 .attempted = call.attempted(),
                 .problem = report.is_valid() ? "the mesh is VALID, but " + quality_text(report) : "the mesh is INVALID"};
  for (const GateResult& gate : report.gates) {
    if (report.is_valid() && gate.state == GateState::fail && !gate.locations.empty())
      info.locations.push_back({gate.locations.front().position, std::string(info_of(gate.measure).title) + ", " + gate.locations.front().what});
  }
  for (const auto& [violation, count] : report.counts) info.n_locations += count;
  for (const CheckFinding& finding : report.findings)
    info.locations.push_back({finding.position, std::string(to_string(finding.violation)) + ", " + finding.what});
  throw Error(std::move(info));
}

ScriptValue describe_object(const ScriptCall& call) {
  if (call.arguments.empty()) return std::monostate{};
  const ScriptValue& object = call.arguments.front();
  if (const auto* surface = std::get_if<SurfaceHandle>(&object)) return describe(**surface);
  if (const auto* envelope = std::get_if<EnvelopeHandle>(&object)) return describe(**envelope);
  if (const auto* tetrahedra = std::get_if<TetrahedraHandle>(&object)) return describe(**tetrahedra);
  if (const auto* mesh = std::get_if<MeshHandle>(&object)) return describe(**mesh);
  if (const auto* model = std::get_if<ModelHandle>(&object)) return describe(**model);
  if (const auto* component = std::get_if<ComponentHandle>(&object)) return describe(**component);
  if (const auto* airfoil = std::get_if<AirfoilHandle>(&object)) return describe(**airfoil);
  if (const auto* quantity = std::get_if<QuantityHandle>(&object)) return (*quantity)->text;
  if (const auto* error = std::get_if<ErrorHandle>(&object)) return std::string((*error)->what());
  std::string text;
  if (const auto* shape = std::get_if<TableHandle>(&object)) {
    if (const auto kind = (*shape)->fields.find("shape"); kind != (*shape)->fields.end() && std::holds_alternative<std::string>(kind->second))
      text = std::get<std::string>(kind->second);
    for (const auto& [name, value] : (*shape)->fields) {
      if (const auto* number = std::get_if<double>(&value)) text += ", " + name + " " + std::to_string(*number) + " m";
      if (const auto* whole = std::get_if<std::int64_t>(&value)) text += ", " + name + " " + std::to_string(*whole) + " m";
    }
  }
  return text;
}

template <class PatchColumn>
ScriptValue patch_names(const PatchColumn& patches) {
  auto names = std::make_shared<ScriptTable>();
  for (const Patch& patch : patches) names->items.emplace_back(patch.name);
  return names;
}

ScriptValue surface_field(const ScriptCall& call) {
  const SurfaceValue& surface = *self<SurfaceHandle>(call);
  Fields fields = {{"triangles", static_cast<std::int64_t>(surface.mesh.n_triangles())},
                   {"vertices", static_cast<std::int64_t>(surface.mesh.n_vertices())},
                   {"length", body_length(surface.mesh)},
                   {"is_closed", surface.report.is_closed},
                   {"patches", patch_names(surface.mesh.patches)}};
  if (const auto& report = surface.mesh_report) {
    fields.emplace_back("min_angle", report->min_angle);
    fields.emplace_back("max_angle", report->max_angle);
    fields.emplace_back("share_20_130", report->share_20_130);
    fields.emplace_back("crossings", report->n_crossings);
    fields.emplace_back("absorbed", static_cast<std::int64_t>(report->absorbed.size()));
  }
  if (surface.smooth_angle) fields.emplace_back("smooth_angle", *surface.smooth_angle);
  return select_field(call, std::move(fields), surface_methods());
}

ScriptValue mesh_field(const ScriptCall& call) {
  const MeshValue& mesh = *self<MeshHandle>(call);
  const CellCounts cells = count_cells(mesh.mesh);
  Fields fields = {{"nodes", static_cast<std::int64_t>(mesh.mesh.points.size())},
                   {"prisms", cells.prisms},
                   {"pyramids", cells.pyramids},
                   {"tetrahedra", cells.tetrahedra},
                   {"hexahedra", cells.hexahedra},
                   {"cells", cells.total()},
                   {"patches", patch_names(mesh.mesh.patches)}};
  if (mesh.origin) {
    fields.emplace_back("coverage", mesh.origin->report.layer.coverage);
    fields.emplace_back("attainable", mesh.origin->report.layer.attainable);
    fields.emplace_back("mean_height", mesh.origin->report.layer.mean_height);
    fields.emplace_back("compressed", mesh.origin->report.layer.n_compressed);
    fields.emplace_back("collapsed", static_cast<std::int64_t>(mesh.origin->report.layer.collapsed.size()));
  }
  return select_field(call, std::move(fields), mesh_methods());
}

ScriptValue error_field(const ScriptCall& call) {
  const Error& error = *self<ErrorHandle>(call);
  return select_field(call, {{"code", std::string(to_string(error.code()))}, {"message", std::string(error.what())}, {"places", error.n_locations()}}, {});
}

// ---- help ----------------------------------------------------------------------------------------------------------------------------------

std::string surface_help() {
  surfmesh::StitchOptions options;
  return options_help(sterna::options_of(options)) +
         "repair = true or { gap = 1e-3, ... }, wrap = true or { edge = 0.01, ... }: applies these verbs; auto = true: takes the surface (or model) unchanged "
         "if it can be meshed, otherwise repairs it, otherwise wraps it, then remeshes it if it has many sliver triangles\nremesh = true or { max_edge = 0.1, "
         "... }: applies the verb remesh\n";
}
std::string union_help() {
  UnionOptions options;
  surfmesh::StitchOptions reading;
  UniteOptions models;
  return options_help(sterna::options_of(options)) + options_help(unit_option(reading)) + "for models:\n" + options_help(sterna::options_of(models));
}
OptionTable volume_options(volmesh::MeshCase& options) { return volmesh::options_of(options); }

std::string volume_help() {
  volmesh::MeshCase options;
  return options_help(volmesh::options_of(options)) + layer_rules_help() +
         "periodic = { { \"left\", \"right\" }, ... }: pairs of flat sides, each the translated image of the other; the meshes of both sides match node by "
         "node and face by face\n";
}

constexpr std::array<ScriptVerb, 6> k_first_verbs = {{
    {"read_surface", k_read_surface_usage, "Reads surface files and joins them to one wall.", read_surface, surface_help, true, "surface", false,
     held_options<surfmesh::StitchOptions>},
    {"union", k_union_usage, "Unites closed surfaces that intersect, or the crossing parts of one file, to one wall; or unites models to one model.", unite,
     union_help, true, "model or surface", true, held_options<UnionOptions, UniteOptions>},
    {"read_mesh", k_read_mesh_usage, "Reads a volume mesh.", read_mesh_file, nullptr, true, "mesh"},
    {"volume_mesh", k_volume_mesh_usage, "Meshes the space around a wall: prism layers on it, tetrahedra to the farfield.", make_mesh, volume_help, true,
     "mesh", false, held_table<volume_options, volmesh::MeshCase>},
    {"sphere", k_sphere_usage, "Spherical farfield for volume_mesh; with a centre and size: a source of short edges, for volume_mesh and surface_mesh.",
     make_sphere, sphere_help, false, "source"},
    {"help", "help(volume_mesh)  or  help(wall)  or  help \"mesh:write\"  or  help \"first_height\"",
     "Explains a verb with its options, an object with its methods and fields, or an option with the verbs that take it.", print_help},
}};
constexpr ScriptVerb k_write_surface = {"surface:write", "wall:write \"wall.vtu\"", "Writes a surface.", write_surface_files, nullptr, true, "self"};
constexpr std::array<ScriptVerb, 4> k_mesh_methods = {{
    {"mesh:check", "mesh:check()  or  mesh:check{ wall = wall }",
     "Proves that the mesh tiles its domain and prints the verdict; an INVALID mesh is an error that lists the locations.", check_mesh, check_help, true,
     "self"},
    {"mesh:write", "mesh:write(\"mesh.su2\", \"mesh.vtu\")  or  mesh:write{ \"mesh.su2\", numbering = \"both\" }",
     "Writes the mesh, each file with a manifest <file>.json beside it.", write_mesh_files, nullptr, true, "self", false, held_options<WriteOptions>},
    {"mesh:su2_config", k_su2_config_usage, "Writes an SU2 configuration for the mesh: markers, flow, reference values and initial settings.", write_su2_config,
     su2_config_help, true, "self"},
    {"mesh:foam_case", k_foam_case_usage,
     "Writes a complete OpenFOAM case: mesh, fields by the kinds of patches, models, schemes for such meshes, forces, Allrun.", write_foam_case, foam_case_help,
     true, "self"},
}};
constexpr std::array<ScriptUnit, 7> k_units = {
    {{"m", 1.0}, {"mm", 1e-3}, {"um", 1e-6}, {"cm", 1e-2}, {"inch", 0.0254}, {"ft", 0.3048}, {"deg", std::numbers::pi / 180.0}}};

}  // namespace

const ScriptVerb k_describe_object = {"tostring", "", "", describe_object};
const ScriptVerb k_surface_field = {"surface", "", "", surface_field};
const ScriptVerb k_mesh_field = {"mesh", "", "", mesh_field};
const ScriptVerb k_error_field = {"error", "", "", error_field};

std::span<const ScriptVerb> script_verbs() {
  static const std::vector<ScriptVerb> all = [] {
    std::vector<ScriptVerb> verbs(k_first_verbs.begin(), k_first_verbs.end());
    verbs.insert(verbs.end(), repair_verbs().begin(), repair_verbs().end());
    verbs.insert(verbs.end(), wrap_verbs().begin(), wrap_verbs().end());
    verbs.insert(verbs.end(), surface_verbs().begin(), surface_verbs().end());
    verbs.insert(verbs.end(), inspect_verbs().begin(), inspect_verbs().end());
    verbs.insert(verbs.end(), stage_verbs().begin(), stage_verbs().end());
    verbs.insert(verbs.end(), source_verbs().begin(), source_verbs().end());
    verbs.insert(verbs.end(), disc_verbs().begin(), disc_verbs().end());
    verbs.insert(verbs.end(), wake_verbs().begin(), wake_verbs().end());
    verbs.insert(verbs.end(), geometry_verbs().begin(), geometry_verbs().end());
    verbs.insert(verbs.end(), component_verbs().begin(), component_verbs().end());
    verbs.insert(verbs.end(), draw_verbs().begin(), draw_verbs().end());
    verbs.insert(verbs.end(), report_verbs().begin(), report_verbs().end());
    verbs.insert(verbs.end(), half_verbs().begin(), half_verbs().end());
    verbs.insert(verbs.end(), family_verbs().begin(), family_verbs().end());
    verbs.insert(verbs.end(), family_gate_verbs().begin(), family_gate_verbs().end());
    verbs.insert(verbs.end(), flow_verbs().begin(), flow_verbs().end());
    verbs.insert(verbs.end(), tunnel_verbs().begin(), tunnel_verbs().end());
    verbs.insert(verbs.end(), series_verbs().begin(), series_verbs().end());
    verbs.insert(verbs.end(), envelope_step_verbs().begin(), envelope_step_verbs().end());
    verbs.insert(verbs.end(), argument_verbs().begin(), argument_verbs().end());
    return verbs;
  }();
  return all;
}
std::span<const ScriptVerb> surface_methods() {
  static const std::vector<ScriptVerb> all = [] {
    std::vector<ScriptVerb> verbs = {k_write_surface, k_check_surface};
    verbs.insert(verbs.end(), surface_motions().begin(), surface_motions().end());
    return verbs;
  }();
  return all;
}
std::span<const ScriptVerb> mesh_methods() { return k_mesh_methods; }
std::span<const ScriptUnit> script_units() { return k_units; }

std::string hint_for_global(std::string_view name) {
  constexpr std::array<std::string_view, 8> k_left_out = {"io", "os", "debug", "package", "coroutine", "load", "loadfile", "dofile"};
  if (std::ranges::find(k_left_out, name.substr(0, name.find('.'))) != k_left_out.end())
    return "scripts have Lua's string, table, math and utf8, and require for modules beside the script; verbs read and write files, args{} reads numbers of "
           "the command line";
  std::vector<std::string> known;
  for (const ScriptVerb& verb : script_verbs()) known.emplace_back(verb.name);
  for (const ScriptUnit& unit : k_units) known.emplace_back(unit.name);
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? "" : "did you mean " + nearest + "?";
}

}  // namespace sterna::scripting
