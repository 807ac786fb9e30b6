#include "scripting/cli/case_commands.h"

#include <CLI/CLI.hpp>

#include <array>
#include <sstream>

#include "geom/base/error.h"
#include "scripting/command/cli_options.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/typed_number.h"
#include "scripting/values/verbs.h"
#include "scripting/verbs/case_tables.h"
#include "scripting/verbs/foam_verbs.h"
#include "scripting/verbs/su2_verbs.h"
#include "volmesh/case/farfield_options.h"

namespace sterna::scripting {
namespace {

constexpr double k_case_read_end = 0.6;  ///< fraction of the progress after reading the mesh

/// All numeric and string settings of a case, and the structs to which they are written.
struct CaseSettings {
  FoamOptions foam;
  Su2Options su2;
  CaseRequest request;
  volmesh::FlowConditions flow;

  OptionTable options(CaseSolver solver) {
    OptionTable table = solver == CaseSolver::openfoam ? sterna::options_of(foam) : sterna::options_of(su2);
    for (Option& option : sterna::options_of(request.options)) table.push_back(std::move(option));
    for (Option& option : flow_options(flow)) table.push_back(std::move(option));
    return table;
  }
};

std::string attempted_by(const CaseCommand& command) {
  return (command.solver == CaseSolver::openfoam ? "writing the case " : "writing the configuration ") + command.output.string();
}

/// Splits "mach=0.78 altitude=11000 length=4.2" into single options.
void add_flow_words(const std::string& text, OptionOverrides& options) {
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0) throw CLI::ValidationError("--flow", "\"" + word + "\" is not NAME=VALUE");
    options.emplace_back(word.substr(0, equals), word.substr(equals + 1));
  }
}

Point point_of_words(const std::string& text) {
  std::vector<double> values;
  std::istringstream list(text);
  for (std::string value; std::getline(list, value, ',');) values.push_back(typed_number(value, Unit::metre));
  if (values.size() != 3)
    throw Error({.code = ErrorCode::bad_argument, .attempted = "--moment-origin " + text, .problem = "expected three coordinates, as 15,0,0"});
  return {values[0], values[1], values[2]};
}

std::vector<CaseKind> kinds_of(const OptionOverrides& given) {
  std::vector<CaseKind> kinds;
  for (const auto& [names, kind] : given) kinds.push_back({names, volmesh::patch_kind_of(kind, "--kind " + names + "=" + kind)});
  return kinds;
}

CaseBoundaries boundaries_of(const std::vector<std::pair<std::string, OptionOverrides>>& given) {
  CaseBoundaries boundaries;
  for (const auto& [name, options] : given) {
    const OptionTable table = sterna::options_of(boundaries[name]);
    const std::string attempted = "--boundary " + name;
    for (const auto& [key, value] : options) set_option_as_typed(find_option(table, key, attempted), value);
  }
  return boundaries;
}

/// Returns the name of the mesh that SU2 reads, for the configuration; SU2 reads two formats.
std::string mesh_beside(const CaseCommand& command) {
  const std::filesystem::path mesh = command.input;
  if (!problem_of_su2_mesh(mesh.string()).empty()) return {};
  std::error_code failure;  // error of a missing folder, which the writer reports
  const std::filesystem::path folder = command.output.has_parent_path() ? command.output.parent_path() : std::filesystem::path(".");
  const std::filesystem::path beside = std::filesystem::proximate(mesh, folder, failure);
  return failure ? mesh.string() : beside.string();
}

void add_case_command(CLI::App& app, const std::string& name, const std::string& verb, const std::string& summary, const std::string& footer,
                      CaseCommand& command, const std::function<void(std::function<int(const CommandContext&)>)>& choose) {
  CLI::App* parsed = app.add_subcommand(name, summary)->alias(verb);
  const bool is_foam = command.solver == CaseSolver::openfoam;
  parsed->add_option("input", command.input, "volume mesh file; .sterna files keep the growth lines of layers. `sterna formats` lists the formats")->required();
  parsed->add_option("-o,--output", command.output, is_foam ? "folder of the case" : "case.cfg")->required();
  CaseSettings settings;
  add_schema_options(*parsed, settings.options(command.solver), command.options);
  parsed
      ->add_option_function<std::string>(
          "--flow", [&command](const std::string& text) { add_flow_words(text, command.options); },
          "flow conditions in one string, --flow \"mach=0.78 altitude=11000 length=4.2\"")
      ->type_name("CONDITIONS");
  parsed->add_option("--reference", command.reference, "model file (sumo, CPACS) with the wing for reference area, length and moment origin")
      ->type_name("FILE");
  parsed->add_option("--moment-origin", command.moment_origin, "origin of moments, e.g. 15,0,0")->type_name("X,Y,Z");
  add_patch_option(*parsed, command.boundaries,
                   "conditions at an inflow, outflow or actuator disc, e.g. --boundary prop:thrust=800, --boundary "
                   "nozzle:total_pressure=1.5e5,total_temperature=600; may be given several times",
                   "--boundary");
  parsed
      ->add_option_function<std::vector<std::string>>(
          "--kind",
          [&command](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              const std::size_t equals = text.rfind('=');
              if (equals == std::string::npos || equals == 0) throw CLI::ValidationError("--kind", "\"" + text + "\" is not NAMES=KIND");
              command.kinds.emplace_back(text.substr(0, equals), text.substr(equals + 1));
            }
          },
          "kind of patches with matching names for the solver, instead of the kind in the mesh, e.g. --kind \"top*=slip\"; may be given several times")
      ->type_name("NAMES=KIND")
      ->allow_extra_args(false)
      ->take_all();
  parsed->footer(footer);
  parsed->final_callback([&command, choose] { choose([&command](const CommandContext& context) { return execute(command, context); }); });
}

}  // namespace

void add_case_commands(CLI::App& app, CaseCommands& commands, const std::function<void(std::function<int(const CommandContext&)>)>& choose) {
  commands.foam.solver = CaseSolver::openfoam;
  commands.su2.solver = CaseSolver::su2;
  add_case_command(
      app, "foam-case", "foam_case", "write a complete OpenFOAM case for a mesh: fields by the kinds of patches, schemes, forces, Allrun",
      "sterna foam-case wing.sterna -o case --mach 0.2 --altitude 0 --length 4.2 --alpha 2deg --reference-area 30; then: case/Allrun. docs/flow.md",
      commands.foam, choose);
  add_case_command(app, "su2-config", "su2_config", "write an SU2 configuration for a mesh: markers, flow, reference values and initial settings",
                   "sterna su2-config wing.su2 -o wing.cfg --mach 0.78 --altitude 11000 --length 4.2 --alpha 2deg --reference-area 120. docs/flow.md",
                   commands.su2, choose);
}

int execute(const CaseCommand& command, const CommandContext& context) {
  const std::string attempted = attempted_by(command);
  const bool is_foam = command.solver == CaseSolver::openfoam;
  CaseSettings settings;
  set_options(settings.options(command.solver), command.options, context);
  CaseRequest& request = settings.request;
  request.flow = volmesh::flow_state(settings.flow);
  request.kinds = kinds_of(command.kinds);
  request.boundaries = boundaries_of(command.boundaries);
  if (!command.reference.empty()) request.reference = reference_of_model(command.reference, request.options, context.run.part("reference", 0.0, 0.1));
  set_reference(request.options, request.reference);
  if (!command.moment_origin.empty()) request.reference.moment_origin = point_of_words(command.moment_origin);
  CaseProblems problems;  // problems that do not depend on the mesh are reported before it is read
  if (is_foam) require_foam_flow(settings.foam, request.flow, problems);
  else require_su2_flow(request.flow, std::nullopt, problems);
  if (const std::string problem = problem_of_su2_mesh(settings.su2.mesh); !problem.empty()) problems.add(problem);
  problems.require_none(attempted);
  const std::filesystem::path output = is_foam ? case_folder(command.output) : command.output;
  if (is_foam) require_new_case(output, attempted);
  const MeshValue mesh = read_mesh({command.input, command.input}, context.run.part("read", 0.1, k_case_read_end));
  const RunContext part = context.run.part("write", k_case_read_end, 1.0);
  if (is_foam) {
    write_foam_folder(mesh, settings.foam, request, output, attempted, part);
  } else {
    if (settings.su2.mesh.empty()) settings.su2.mesh = mesh_beside(command);
    write_su2_file(mesh, settings.su2, request, output, attempted, part);
  }
  context.console.end_progress();
  return k_exit_success;
}

}  // namespace sterna::scripting
