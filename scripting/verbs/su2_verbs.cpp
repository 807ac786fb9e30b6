#include "scripting/verbs/su2_verbs.h"

#include <algorithm>
#include <filesystem>

#include "geom/base/error.h"
#include "io/output/atomic_file.h"
#include "scripting/lua/component_value.h"
#include "scripting/lua/script_check.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/models.h"
#include "scripting/verbs/su2_config.h"

namespace sterna::scripting {
namespace {

/// Area, mean chord and quarter-chord point of the wing called `name`, or of the largest.
void take_wing(const std::vector<WingReference>& wings, const std::string& name, const std::string& why_none, Su2Reference& reference, TableReader& reader) {
  const WingReference* chosen = nullptr;
  std::string names;
  for (const WingReference& wing : wings) {
    names += (names.empty() ? "" : ", ") + wing.name;
    if (name.empty() ? !chosen || wing.area > chosen->area : wing.name == name) chosen = &wing;
  }
  if (!chosen) {
    reader.add_problem(wings.empty() ? "reference: no reference data of wings" + (why_none.empty() ? std::string() : ": " + why_none) + "; give reference_area"
                                     : "wing: there is no wing \"" + name + "\" (" + names + ")");
    return;
  }
  reference.area = chosen->area;
  reference.length = chosen->mean_aerodynamic_chord;
  reference.moment_origin = chosen->aerodynamic_chord_start + Vec3{0.25 * chosen->mean_aerodynamic_chord, 0.0, 0.0};
  reference.source = "wing \"" + chosen->name + "\"";
}

void read_reference(const ScriptCall& call, TableReader& reader, const Su2Options& options, Su2Reference& reference) {
  if (const ScriptValue* value = reader.field("reference")) {
    if (const auto* component = std::get_if<ComponentHandle>(value); component && std::holds_alternative<Wing>((*component)->shape)) {
      take_wing({wing_reference(std::get<Wing>((*component)->shape))}, options.wing, {}, reference, reader);
    } else if (is_stand_in(call, *value) && std::holds_alternative<ModelHandle>(*value)) {
      reference.area = 1.0;  // its wings are not known yet
    } else if (const auto* model = std::get_if<ModelHandle>(value)) {
      const ModelReport report = measure_model(**model, call.session.context.part("reference", 0.0, 0.1));
      take_wing(report.wings, options.wing, report.no_wings, reference, reader);
    } else {
      reader.add_problem("reference: expected an aircraft or a wing, not " + std::string(type_text(*value)));
    }
  }
  if (!is_automatic(options.reference_area)) {
    reference.area = options.reference_area;
    reference.source.clear();
  }
  if (!is_automatic(options.reference_length)) reference.length = options.reference_length;
  const auto origin = read_point(reader, "moment_origin");
  if (origin) reference.moment_origin = *origin;
}

std::map<std::string, Su2Boundary> read_boundaries(TableReader& reader) {
  std::map<std::string, Su2Boundary> boundaries;
  const ScriptValue* value = reader.field("boundaries");
  if (!value) return boundaries;
  const auto* table = std::get_if<TableHandle>(value);
  if (!table || !(*table)->items.empty()) {
    reader.add_problem("boundaries: expected a table by names of patches, { prop = { thrust = 800 } }");
    return boundaries;
  }
  for (const auto& [name, entry] : (*table)->fields) {
    const auto* of_patch = std::get_if<TableHandle>(&entry);
    if (!of_patch) {
      reader.add_problem("boundaries[\"" + name + "\"]: expected a table, not " + std::string(type_text(entry)));
      continue;
    }
    TableReader entries(**of_patch, "boundaries");
    entries.read_options(sterna::options_of(boundaries[name]));
    try {
      entries.finish();
    } catch (const Error& error) {
      reader.add_problem("boundaries[\"" + name + "\"]: " + error.info().problem);
    }
  }
  return boundaries;
}

}  // namespace

ScriptValue write_su2_config(const ScriptCall& call) {
  const MeshHandle& mesh = self<MeshHandle>(call);
  const ScriptTable table = table_argument(call, 1, k_su2_config_usage);
  TableReader reader(table, call.attempted());
  Su2Options options;
  reader.read_options(sterna::options_of(options));
  const auto flow = read_flow(reader, 1);
  const auto* file = reader.items().empty() ? nullptr : std::get_if<std::string>(&reader.items().front());
  if (!file) reader.add_problem("entry 1: expected the name of the configuration, \"case.cfg\"");
  Su2Reference reference;
  read_reference(call, reader, options, reference);
  const std::map<std::string, Su2Boundary> boundaries = read_boundaries(reader);
  if (!options.mesh.empty() && !options.mesh.ends_with(".su2") && !options.mesh.ends_with(".cgns"))
    reader.add_problem("mesh: SU2 reads .su2 and .cgns, not \"" + options.mesh + "\"");
  if (file) note_output(call, output_path(call, *file));
  reader.finish();
  const std::filesystem::path path = output_path(call, *file);
  if (options.mesh.empty()) options.mesh = path.stem().string() + ".su2";
  std::string text;
  try {
    text = su2_config(mesh->mesh, options, *flow, reference, boundaries, call.session.context);
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.attempted = call.attempted();
    throw Error(std::move(info));
  }
  io::write_whole(path, text);
  std::error_code none;
  const bool is_there = std::filesystem::exists(path.parent_path() / options.mesh, none);
  call.session.context.info("wrote " + path.string() + " for the mesh " + options.mesh +
                            (is_there ? "" : ", which is not there yet: mesh:write \"" + (path.parent_path() / options.mesh).string() + "\""));
  return mesh;
}

std::string su2_config_help() {
  Su2Options options;
  Su2Boundary boundary;
  volmesh::FlowConditions conditions;
  return options_help(sterna::options_of(options)) + "the flow, by name or as the second entry, flow{...}:\n" + options_help(flow_options(conditions)) +
         "reference = aircraft or wing: reference area, length and moment_origin (its quarter-chord point); moment_origin = {x, y, z}\nboundaries = { "
         "[\"prop\"] = { ... } }, by names of inflows, outflows and actuator discs:\n" +
         options_help(sterna::options_of(boundary));
}

}  // namespace sterna::scripting
