#include "scripting/verbs/case_tables.h"

#include <vector>

#include "geom/base/error.h"
#include "scripting/lua/component_value.h"
#include "scripting/lua/script_check.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/geometry_tools.h"
#include "scripting/values/models.h"
#include "volmesh/case/farfield_options.h"

namespace sterna::scripting {
namespace {

/// Takes area, mean chord and quarter-chord point of the wing called `name`, or of the largest wing. Returns the problem; empty if there is none.
std::string take_wing(const std::vector<WingReference>& wings, const std::string& name, const std::string& why_none, CaseReference& reference) {
  const WingReference* chosen = nullptr;
  std::string names;
  for (const WingReference& wing : wings) {
    names += (names.empty() ? "" : ", ") + wing.name;
    if (name.empty() ? !chosen || wing.area > chosen->area : wing.name == name) chosen = &wing;
  }
  if (!chosen)
    return wings.empty()
               ? "reference: the model has no reference data of wings" + (why_none.empty() ? std::string() : ": " + why_none) + "; give reference_area"
               : "wing: there is no wing \"" + name + "\" (" + names + ")";
  reference.area = chosen->area;
  reference.length = chosen->mean_aerodynamic_chord;
  reference.moment_origin = chosen->aerodynamic_chord_start + Vec3{0.25 * chosen->mean_aerodynamic_chord, 0.0, 0.0};
  reference.source = "wing \"" + chosen->name + "\"";
  return {};
}

}  // namespace

CaseReference read_case_reference(const ScriptCall& call, TableReader& reader, const CaseOptions& options) {
  CaseReference reference;
  const auto take = [&](const std::vector<WingReference>& wings, const std::string& why_none) {
    if (const std::string problem = take_wing(wings, options.wing, why_none, reference); !problem.empty()) reader.add_problem(problem);
  };
  if (const ScriptValue* value = reader.field("reference")) {
    if (const auto* component = std::get_if<ComponentHandle>(value); component && std::holds_alternative<Wing>((*component)->shape)) {
      take({wing_reference(std::get<Wing>((*component)->shape))}, {});
    } else if (is_placeholder(call, *value) && std::holds_alternative<ModelHandle>(*value)) {
      reference.area = 1.0;  // the wings of the placeholder are unknown
    } else if (const auto* model = std::get_if<ModelHandle>(value)) {
      const ModelReport report = measure_model(**model, call.session.context.part("reference", 0.0, 0.1));
      take(report.wings, report.no_wings);
    } else {
      reader.add_problem("reference: expected an aircraft or a wing, not " + std::string(type_text(*value)));
    }
  }
  set_reference(options, reference);
  const auto origin = read_point(reader, "moment_origin");
  if (origin) reference.moment_origin = *origin;
  return reference;
}

void set_reference(const CaseOptions& options, CaseReference& reference) {
  if (!is_automatic(options.reference_area)) {
    reference.area = options.reference_area;
    reference.source.clear();
  }
  if (!is_automatic(options.reference_length)) reference.length = options.reference_length;
}

CaseReference reference_of_model(const std::string& file, const CaseOptions& options, const RunContext& context) {
  const std::string attempted = "taking reference values from " + file;
  if (!is_model_file(file))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = attempted,
                 .problem = "the file is not a model",
                 .hint = "give a sumo or CPACS file, which describes wings, or reference_area and reference_length"});
  const ModelReport report = measure_model(read_model({file, file}, {}, context), context);
  CaseReference reference;
  if (const std::string problem = take_wing(report.wings, options.wing, report.no_wings, reference); !problem.empty())
    throw Error({.code = ErrorCode::bad_argument, .attempted = attempted, .problem = problem});
  return reference;
}

std::vector<CaseKind> read_case_kinds(TableReader& reader) {
  std::vector<CaseKind> kinds;
  const ScriptValue* value = reader.field("kinds");
  if (!value) return kinds;
  const auto* table = std::get_if<TableHandle>(value);
  if (!table || !(*table)->items.empty() || !(*table)->other_keys.empty()) {
    reader.add_problem("kinds: expected a table with names of patches as keys, { [\"top*\"] = \"slip\" }" +
                       (table ? "; the keys are strings" : ", not " + std::string(type_text(*value))));
    return kinds;
  }
  for (const auto& [names, entry] : (*table)->fields) {
    const std::string where = "kinds[\"" + names + "\"]";
    const auto* kind = std::get_if<std::string>(&entry);
    if (!kind) {
      reader.add_problem(where + ": expected a kind of patch, such as \"slip\", not " + std::string(type_text(entry)));
      continue;
    }
    try {
      kinds.push_back({names, volmesh::patch_kind_of(*kind, where)});
    } catch (const Error& error) {
      reader.add_problem(where + ": " + error.info().problem + " (" + error.info().hint + ")");
    }
  }
  return kinds;
}

CaseBoundaries read_case_boundaries(TableReader& reader) {
  CaseBoundaries boundaries;
  const ScriptValue* value = reader.field("boundaries");
  if (!value) return boundaries;
  const auto* table = std::get_if<TableHandle>(value);
  if (!table || !(*table)->items.empty()) {
    reader.add_problem("boundaries: expected a table with names of patches as keys, { prop = { thrust = 800 } }");
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

std::string solver_case_help() {
  CaseOptions options;
  CaseBoundary boundary;
  volmesh::FlowConditions conditions;
  return options_help(sterna::options_of(options)) + "flow conditions, by name or as the second entry, flow{...}:\n" + options_help(flow_options(conditions)) +
         "reference = aircraft or wing: source of reference area, length and moment_origin (quarter-chord point); moment_origin = {x, y, z}\nboundaries = { "
         "[\"prop\"] = { ... } }, with names of inflows, outflows and actuator discs as keys:\n" +
         options_help(sterna::options_of(boundary)) +
         "kinds = { [\"top*\"] = \"slip\" }, with patterns of patch names as keys: kinds of patches for the solver (wall, slip, symmetry, inflow, outflow, "
         "farfield), instead of those in the mesh\n";
}

}  // namespace sterna::scripting
