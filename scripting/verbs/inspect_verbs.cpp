#include "scripting/verbs/inspect_verbs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scripting/lua/quantity.h"
#include "scripting/lua/table_reader.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/inspect_surface.h"
#include "scripting/values/layer_options.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/models.h"
#include "scripting/verbs/farfield_verbs.h"
#include "scripting/verbs/volume_case.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_inspect_usage =
    "inspect(wall)  or  inspect{ wall, layers = 32, first_height = 2e-6, flow = flow{ mach = 0.78, altitude = 11000, length = 4.2 }, output = \"trouble.vtu\" "
    "}  or  inspect{ \"wall.stl\", unit = mm }";

/// Converts inspect(wall) to the table of inspect{ wall }.
ScriptTable inspection_table(const ScriptCall& call) {
  if (call.arguments.size() != 1 || !std::holds_alternative<SurfaceHandle>(call.arguments.front())) return table_argument(call, 0, k_inspect_usage);
  ScriptTable table;
  table.items.push_back(call.arguments.front());
  return table;
}

TableHandle handle(ScriptTable table) { return std::make_shared<const ScriptTable>(std::move(table)); }

/// Sets an entry of the table. A number that is not finite gets no entry.
void set_number(ScriptTable& table, const std::string& name, double value) {
  if (std::isfinite(value)) table.fields[name] = value;
}

TableHandle point_table(const Point& p) {
  ScriptTable table;
  table.items = {p.x, p.y, p.z};
  return handle(std::move(table));
}

TableHandle finding_table(const volmesh::Finding& finding) {
  ScriptTable table, locations;
  table.fields = {{"kind", std::string(to_string(finding.kind))},
                  {"severity", std::string(to_string(finding.severity))},
                  {"count", finding.count},
                  {"unit", finding.unit},
                  {"text", finding.text},
                  {"advice", finding.advice}};
  set_number(table, "share", finding.share);
  set_number(table, "value", finding.value);
  set_number(table, "limit", finding.limit);
  for (const volmesh::FindingLocation& location : finding.locations) {
    ScriptTable entry;
    entry.fields = {{"at", point_table(location.position)}, {"patch", location.patch}, {"value", location.value}, {"what", location.what}};
    locations.items.emplace_back(handle(std::move(entry)));
  }
  if (!finding.locations.empty()) {
    table.fields["at"] = point_table(finding.locations.front().position);
    table.fields["patch"] = finding.locations.front().patch;
  }
  table.fields["places"] = handle(std::move(locations));
  return handle(std::move(table));
}

TableHandle preparation_table(const Preparation& preparation) {
  ScriptTable table;
  table.fields = {{"needed", std::string(to_string(preparation.needed))},
                  {"reason", preparation.reason},
                  {"command", preparation.command},
                  {"script", preparation.script},
                  {"hint", preparation.hint},
                  {"seconds", preparation.seconds},
                  {"basis", preparation.basis},
                  {"remesh", preparation.is_remesh_advised},
                  {"needle_share", preparation.needle_share}};
  if (preparation.location) table.fields["at"] = point_table(*preparation.location);
  return handle(std::move(table));
}

TableHandle report_table(const Inspection& report) {
  ScriptTable table, findings;
  for (const volmesh::Finding& finding : report.findings) findings.items.emplace_back(finding_table(finding));
  table.fields = {{"ok", report.is_ok()},
                  {"errors", report.count(volmesh::Severity::error)},
                  {"warnings", report.count(volmesh::Severity::warn)},
                  {"notes", report.count(volmesh::Severity::note)},
                  {"triangles", static_cast<std::int64_t>(report.mesh.n_triangles())},
                  {"parts", report.n_bodies},
                  {"is_closed", report.is_closed},
                  {"length", report.length},
                  {"preparation", preparation_table(report.preparation)},
                  {"findings", handle(std::move(findings))}};
  if (report.layer.is_known) {
    table.fields["coverage"] = report.layer.coverage;
    table.fields["compressed"] = report.layer.compressed;
    table.fields["collapsed"] = report.layer.collapsed;
  }
  return handle(std::move(table));
}

/// The input: a surface, or files, but not both.
struct Given {
  SurfaceHandle surface;
  std::vector<InputPath> files;
};

Given read_given(const ScriptCall& call, TableReader& reader) {
  Given given;
  const std::vector<ScriptValue>& items = reader.items();
  if (items.size() == 1 && std::holds_alternative<SurfaceHandle>(items.front())) {
    given.surface = std::get<SurfaceHandle>(items.front());
    return given;
  }
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (const auto* name = std::get_if<std::string>(&items[i])) given.files.push_back(find_input(call, *name));
    else reader.add_problem("entry " + std::to_string(i + 1) + ": expected one surface or names of files, not " + std::string(type_text(items[i])));
  }
  if (items.empty()) reader.add_problem("needs a surface or the name of a file: " + std::string(k_inspect_usage));
  return given;
}

/// Returns the options of reading models and of their surface that are no options of volume_mesh as well.
OptionTable options_of_models_alone(SurfaceRecipe& recipe, ReadCadOptions& reading) {
  OptionTable table = model_surface_options(recipe.options, reading);
  volmesh::MeshCase volume;
  const OptionTable of_volume = volmesh::options_of(volume);
  std::erase_if(table,
                [&](const Option& option) { return option.name == "periodic" || std::ranges::find(of_volume, option.name, &Option::name) != of_volume.end(); });
  return table;
}

ScriptValue inspect(const ScriptCall& call) {
  volmesh::InspectRequest request;
  VolumeCase made;
  const ScriptTable table = with_farfield(call, inspection_table(call), made.options.farfield_surface, made.farfield_inputs);
  TableReader reader(table, call.attempted());
  const Given given = read_given(call, reader);
  const bool is_model = std::ranges::any_of(given.files, [](const InputPath& file) { return is_model_file(file.path); });
  surfmesh::StitchOptions stitching;
  ReadCadOptions reading;
  SurfaceRecipe recipe;
  const OptionTable limits = sterna::options_of(request.limits), volume = volmesh::options_of(made.options),
                    surface = given.surface ? OptionTable()
                              : is_model    ? options_of_models_alone(recipe, reading)
                                            : sterna::options_of(stitching);
  reader.read_options(limits);
  reader.read_options(surface);
  read_volume_case(reader, call, volume, SourceEntries::taken, made);
  if (is_model) recipe.sources = made.options.sources;
  if (const ScriptValue* value = reader.field("flow")) {
    if (const auto* quantity = std::get_if<QuantityHandle>(value)) request.flow = (*quantity)->flow;
    else reader.add_problem("flow: expected flow{ mach = 0.78, altitude = 11000, length = 4.2 }, not " + std::string(type_text(*value)));
  }
  const std::filesystem::path output = output_entry(reader, call, "output", "the name of a .vtu or .png file");
  for (const OptionTable* part : {&limits, &surface}) apply_overrides(call, *part);
  complete_volume_case(reader, call, volume, made);
  if (reader.is_given("family", "refinement")) recipe.options.sizes.refinement = made.options.family.refinement;  // as `sterna mesh`
  if (made.first_heights && !given.surface) reader.add_problem("first_height: a function needs a surface as the first entry (from read_surface), not a file");
  reader.finish();
  if (!output.empty()) require_inspection_output(output);
  if (given.surface) set_first_heights(made.first_heights, *given.surface, made.options, call.session.context);
  request.volume = made.options;
  const RunContext context = call.session.context.part("inspect", 0.0, 1.0);
  const Inspection report = given.surface ? inspect_surface(*given.surface, request, context)
                            : is_model    ? inspect_models(given.files, reading, recipe, request, context)
                                          : inspect_files(given.files, stitching, request, context);
  std::string name;
  if (given.surface)
    for (const InputFile& input : given.surface->inputs) name += (name.empty() ? "" : " ") + input.name;
  for (const InputPath& file : given.files) name += (name.empty() ? "" : " ") + file.name;
  call.session.print(text_of(report, name.empty() ? "surface" : name));
  if (!output.empty()) write_inspection(report, output, context);
  return report_table(report);
}

std::string inspect_help() {
  volmesh::InspectOptions limits;
  return options_help(sterna::options_of(limits)) +
         "flow = flow{ ... }: compares the first height with y+ in this flow. output = \"trouble.vtu\": writes the surface with predicted heights, visibility "
         "angles, gaps and findings; \"trouble.png\": a picture\nThe options of volume_mesh are taken as well; without first_height the layer is not "
         "predicted. With names of files the options of read_surface, or for models those of read_cad and surface_mesh, are taken, too\nReturns a table: ok "
         "(nothing is an error), errors, warnings, notes, "
         "coverage, compressed, collapsed (predicted shares of the area), findings = { { kind, severity, count, share, value, limit, unit, at, patch, text, "
         "advice, places = { { at, patch, value, what } } } }, preparation = { needed (none, repair, wrap, remesh, beyond), reason, at, command, script, hint, "
         "seconds (of one thread, about), basis, remesh (advised, perhaps after repair), needle_share }\n";
}

constexpr std::array<ScriptVerb, 1> k_inspect_verbs = {{
    {"inspect", k_inspect_usage,
     "Predicts within seconds how volume_mesh will treat a surface: reasons to refuse it, low layers, bad cells, each with a line of advice.", inspect,
     inspect_help, true, "inspection"},
}};

}  // namespace

std::span<const ScriptVerb> inspect_verbs() { return k_inspect_verbs; }

ScriptValue inspection_placeholder() { return report_table({}); }

}  // namespace sterna::scripting
