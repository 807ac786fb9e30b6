#include "scripting/verbs/stage_verbs.h"

#include <algorithm>
#include <array>

#include "scripting/lua/script_check.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/stored_stages.h"
#include "scripting/verbs/farfield_verbs.h"
#include "scripting/verbs/source_verbs.h"
#include "scripting/verbs/volume_case.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::scripting {
namespace {

template <class Handle>
Handle entry(TableReader& reader, std::size_t number, std::string_view what) {
  const std::vector<ScriptValue>& items = reader.items();
  const Handle* handle = items.size() < number ? nullptr : std::get_if<Handle>(&items[number - 1]);
  if (handle) return *handle;
  reader.add_problem("entry " + std::to_string(number) + ": expected " + std::string(what) + ", not " +
                     std::string(items.size() < number ? "nothing" : type_text(items[number - 1])));
  return nullptr;
}

void require_entries(TableReader& reader, std::size_t n) {
  if (reader.items().size() > n) reader.add_problem("entry " + std::to_string(n + 1) + ": unexpected, the verb takes fewer entries without names");
}

constexpr std::string_view k_envelope_usage = "make_envelope{ wall, layers = 35, first_height = 2e-6, max_growth = 1.35 }";

ScriptValue make_envelope_verb(const ScriptCall& call) {
  VolumeCase made;
  const ScriptTable table = with_farfield(call, table_argument(call, 0, k_envelope_usage), made.options.farfield_surface, made.farfield_inputs);
  const OptionTable schema = envelope_options(made.options);
  TableReader reader(table, call.attempted());
  const auto wall = entry<SurfaceHandle>(reader, 1, "a surface (from surface_mesh or read_surface)");
  require_entries(reader, 1);
  read_volume_case(reader, call, schema, SourceEntries::of_a_later_step, made);
  complete_volume_case(reader, call, schema, made);
  require_volume_options(reader, made, wall.get());
  reader.finish();
  const auto given = std::make_shared<const SurfaceValue>(wall_of_case(*wall, made, call.session.context));
  return std::make_shared<const EnvelopeValue>(make_envelope(given, made.options, call.session.context.part("make_envelope", 0.0, 1.0), call.session.reuse()));
}

constexpr std::string_view k_tetrahedra_usage =
    "tetrahedra{ env, engine = \"tetgen\", radius_edge = 1.2, wall_perpendicularity = 0.1, sources = { box{ {1, 0, 0}, {3, 1, 1}, size = 0.3 } } }";

ScriptValue make_tetrahedra_verb(const ScriptCall& call) {
  std::shared_ptr<const TriMesh> farfield_surface;
  std::vector<InputFile> farfield_inputs;
  const ScriptTable table = with_farfield(call, table_argument(call, 0, k_tetrahedra_usage), farfield_surface, farfield_inputs);
  TableReader reader(table, call.attempted());
  const auto envelope = entry<EnvelopeHandle>(reader, 1, "an envelope (from make_envelope or read_stages)");
  require_entries(reader, 1);
  volmesh::MeshCase options = envelope ? envelope->options : volmesh::MeshCase();
  if (farfield_surface) options.farfield_surface = farfield_surface;
  const OptionTable schema = tetrahedra_options(options);
  reader.read_options(schema);
  if (table.fields.contains("sources")) options.sources.clear();
  for (const volmesh::SizeSource& source : read_sources(reader, call)) options.sources.push_back(source);
  apply_overrides(call, schema);
  reader.finish();
  return std::make_shared<const TetrahedraValue>(make_tetrahedra(*envelope, options, call.session.context.part("tetrahedra", 0.0, 1.0), call.session.reuse()));
}

constexpr std::string_view k_prisms_usage = "prisms{ env, tets, improve_rounds = 30 }";

/// Rejects options of the layer, which belong to tetrahedra{}. The layer is subdivided before the tetrahedra are made, because it may have to be lower than the
/// envelope.
void refuse_layer_options(TableReader& reader) {
  volmesh::PrismOptions options;
  for (const Option& option : sterna::options_of(options))
    if (reader.field(std::string(option.name)))
      reader.add_problem(std::string(option.name) + ": belongs to tetrahedra{ env, " + std::string(option.name) +
                         " = ... }, which subdivides the layer before making tetrahedra");
}

ScriptValue make_prisms_verb(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_prisms_usage);
  TableReader reader(table, call.attempted());
  const auto envelope = entry<EnvelopeHandle>(reader, 1, "an envelope (from make_envelope or read_stages)");
  const auto tets = entry<TetrahedraHandle>(reader, 2, "tetrahedra (from tetrahedra{...} or read_stages)");
  require_entries(reader, 2);
  if (envelope && tets && envelope->wall != tets->wall) reader.add_problem("entry 2: these tetrahedra were made around another envelope");
  volmesh::MeshCase options = tets ? tets->options : volmesh::MeshCase();
  const OptionTable schema = finish_options(options);
  reader.read_options(schema);
  refuse_layer_options(reader);
  apply_overrides(call, schema);
  reader.finish();
  auto mesh = std::make_shared<const MeshValue>(finish_mesh(*tets, options, call.session.context.part("prisms", 0.0, 1.0), call.session.reuse()));
  if (call.session.on_mesh) call.session.on_mesh(*mesh);
  return mesh;
}

constexpr std::string_view k_read_stages_usage = "read_stages \"case.sterna\"";

ScriptValue read_stages_verb(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_read_stages_usage);
  TableReader reader(table, call.attempted());
  const std::vector<InputPath> files = file_names(call, reader);
  if (files.size() > 1) reader.add_problem("takes one file, not " + std::to_string(files.size()));
  reader.finish();
  StageContent content = read_stages(files.front(), call.session.context.part("read_stages", 0.0, 1.0));
  auto result = std::make_shared<ScriptTable>();
  if (content.surface) result->fields["surface"] = content.surface;
  if (content.envelope) result->fields["envelope"] = content.envelope;
  if (content.tetrahedra) result->fields["tetrahedra"] = content.tetrahedra;
  if (content.mesh) result->fields["mesh"] = content.mesh;
  return result;
}

// ---- Methods and fields --------------------------------------------------------------------------------------------------------------------

/// Returns the envelope's points with the connectivity of the wall.
SurfaceValue surface_of(const EnvelopeValue& envelope) {
  SurfaceValue surface = *envelope.wall;
  surface.mesh_report.reset();  // the report is that of the wall
  surface.parts.clear();
  for (const VertexId v : surface.mesh.points.ids()) surface.mesh.points[v] = envelope.stage.envelope.point(envelope.wall->mesh, v);
  return surface;
}

ScriptValue write_envelope_files(const ScriptCall& call) {
  const EnvelopeHandle& envelope = self<EnvelopeHandle>(call);
  const auto names = output_names(call);
  finish_checks(call);
  if (envelope->step == volmesh::EnvelopeStep::classified) reject(call, "a classification has no heights to write", "write the result of envelope.initial");
  for (const auto& name : names) {
    if (name.extension() == ".sterna") write_stage(*envelope, name, call.session.context);
    else write_surface(surface_of(*envelope), name, call.session.context);
  }
  return envelope;
}

ScriptValue write_tetrahedra_files(const ScriptCall& call) {
  const TetrahedraHandle& tetrahedra = self<TetrahedraHandle>(call);
  const auto names = output_names(call);
  for (const auto& name : names) require_stage_output(name);
  finish_checks(call);
  for (const auto& name : names) write_stage(*tetrahedra, name, call.session.context);
  return tetrahedra;
}

ScriptValue envelope_field(const ScriptCall& call) {
  const EnvelopeValue& envelope = *self<EnvelopeHandle>(call);
  const auto& heights = envelope.stage.envelope.height;
  return select_field(call,
                      {{"wall", envelope.wall},
                       {"vertices", static_cast<std::int64_t>(heights.size())},
                       {"collapsed", static_cast<std::int64_t>(std::count(heights.begin(), heights.end(), 0.0))},
                       {"step", std::string(to_string(envelope.step))},
                       {"feature_angle", envelope.stage.feature_angle}},
                      envelope_methods());
}

ScriptValue tetrahedra_field(const ScriptCall& call) {
  const volmesh::TetraResult& tets = self<TetrahedraHandle>(call)->stage.tets;
  return select_field(call,
                      {{"tetrahedra", static_cast<std::int64_t>(tets.tetrahedra.size())},
                       {"points", static_cast<std::int64_t>(tets.new_points.size())},
                       {"engine", tets.engine}},
                      tetrahedra_methods());
}

std::string envelope_help() {
  volmesh::MeshCase options;
  return options_help(envelope_options(options)) + layer_rules_help();
}

template <OptionTable (*Options)(volmesh::MeshCase&)>
std::string help_of() {
  volmesh::MeshCase options;
  return options_help(Options(options));
}

constexpr std::array<ScriptVerb, 4> k_stage_verbs = {{
    {"make_envelope", k_envelope_usage, "Makes the envelope of the layer: the first step of volume_mesh.", make_envelope_verb, envelope_help, true, "envelope"},
    {"tetrahedra", k_tetrahedra_usage, "Makes the layer below an envelope, and tetrahedra from the envelope to the farfield: the second step of volume_mesh.",
     make_tetrahedra_verb, help_of<tetrahedra_options>, true, "tetrahedra"},
    {"prisms", k_prisms_usage, "Joins layer and tetrahedra to a checked mesh: the last step of volume_mesh.", make_prisms_verb, help_of<finish_options>, true,
     "mesh"},
    {"read_stages", k_read_stages_usage,
     "Reads a .sterna file and returns the content as fields surface, envelope, tetrahedra and mesh. Meshing can continue from each of them.", read_stages_verb,
     nullptr, true, "stages"},
}};
constexpr std::array<ScriptVerb, 1> k_envelope_methods = {{
    {"envelope:write", "env:write(\"case.sterna\", \"env.vtu\")",
     "Writes the envelope with all data needed to continue (.sterna), or the surface of the envelope only.", write_envelope_files, nullptr, true, "self"},
}};
constexpr std::array<ScriptVerb, 1> k_tetrahedra_methods = {{
    {"tetrahedra:write", "tets:write \"case.sterna\"", "Writes layer and tetrahedra with all data needed to continue.", write_tetrahedra_files, nullptr, true,
     "self"},
}};

}  // namespace

const ScriptVerb k_envelope_field = {"envelope", "", "", envelope_field};
const ScriptVerb k_tetrahedra_field = {"tetrahedra", "", "", tetrahedra_field};

std::span<const ScriptVerb> stage_verbs() { return k_stage_verbs; }
std::span<const ScriptVerb> envelope_methods() { return k_envelope_methods; }
std::span<const ScriptVerb> tetrahedra_methods() { return k_tetrahedra_methods; }

}  // namespace sterna::scripting
