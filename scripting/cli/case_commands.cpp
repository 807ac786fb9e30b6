// `sterna foam-case` and `sterna su2-config`: apply the functions of mesh:foam_case and mesh:su2_config to a mesh from a file.
#include <sstream>

#include "geom/base/error.h"
#include "scripting/cli/command_table.h"
#include "scripting/cli/commands.h"
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

Point point_of_words(const std::string& text) {
  std::vector<double> values;
  std::istringstream list(text);
  for (std::string value; std::getline(list, value, ',');) values.push_back(typed_number(value, Unit::metre));
  if (values.size() != 3)
    throw Error({.code = ErrorCode::bad_argument, .attempted = "--moment-origin " + text, .problem = "expected three coordinates, as 15,0,0"});
  return {values[0], values[1], values[2]};
}

std::vector<CaseKind> kinds_of(const std::vector<std::string>& texts) {
  std::vector<CaseKind> kinds;
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    kinds.push_back({text.substr(0, equals), volmesh::patch_kind_of(text.substr(equals + 1), "--kind " + text)});
  }
  return kinds;
}

CaseBoundaries boundaries_of(const PatchEntries& given) {
  CaseBoundaries boundaries;
  for (const auto& [name, options] : given) {
    const OptionTable table = sterna::options_of(boundaries[name]);
    const std::string attempted = "--boundary " + name;
    for (const auto& [key, value] : options) set_option_as_typed(find_option(table, key, attempted), value);
  }
  return boundaries;
}

/// Returns the name of the mesh that SU2 reads, for the configuration; SU2 reads two formats.
std::string mesh_beside(const std::filesystem::path& mesh, const std::filesystem::path& output) {
  if (!problem_of_su2_mesh(mesh.string()).empty()) return {};
  std::error_code failure;  // error of a missing folder, which the writer reports
  const std::filesystem::path folder = output.has_parent_path() ? output.parent_path() : std::filesystem::path(".");
  const std::filesystem::path beside = std::filesystem::proximate(mesh, folder, failure);
  return failure ? mesh.string() : beside.string();
}

/// Reads the options common to both solvers, and those of one of them: `own`.
CaseRequest read_case(const CommandLine& line, OptionTable own, const CommandContext& context) {
  CaseRequest request;
  volmesh::FlowConditions flow;
  for (Option& option : sterna::options_of(request.options)) own.push_back(std::move(option));
  for (Option& option : flow_options(flow)) own.push_back(std::move(option));
  set_options(own, line.options, context);
  request.flow = volmesh::flow_state(flow);
  request.kinds = kinds_of(line.all("kind"));
  request.boundaries = boundaries_of(line.patches_of("boundary"));
  if (const std::string model = line.word("reference"); !model.empty())
    request.reference = reference_of_model(model, request.options, context.run.part("reference", 0.0, 0.1));
  set_reference(request.options, request.reference);
  if (const std::string origin = line.word("moment-origin"); !origin.empty()) request.reference.moment_origin = point_of_words(origin);
  return request;
}

MeshValue mesh_of_case(const CommandLine& line, const CommandContext& context) {
  return read_mesh({line.word("input"), line.word("input")}, context.run.part("read", 0.1, k_case_read_end));
}

}  // namespace

HeldOptions case_arguments(bool is_foam) {
  return joined_options(is_foam ? held_options<FoamOptions, CaseOptions>() : held_options<Su2Options, CaseOptions>(),
                        held_table<flow_options, volmesh::FlowConditions>());
}

int foam_case_command(const CommandLine& line, const CommandContext& context) {
  const std::string attempted = "writing the case " + line.word("output");
  FoamOptions options;
  const CaseRequest request = read_case(line, sterna::options_of(options), context);
  CaseProblems problems;  // problems that do not depend on the mesh are reported before it is read
  require_foam_flow(options, request.flow, problems);
  problems.require_none(attempted);
  const std::filesystem::path folder = case_folder(line.word("output"));
  require_new_case(folder, attempted);
  const MeshValue mesh = mesh_of_case(line, context);
  write_foam_folder(mesh, options, request, folder, attempted, context.run.part("write", k_case_read_end, 1.0));
  context.console.end_progress();
  return k_exit_success;
}

int su2_config_command(const CommandLine& line, const CommandContext& context) {
  const std::filesystem::path output = line.word("output");
  const std::string attempted = "writing the configuration " + output.string();
  Su2Options options;
  const CaseRequest request = read_case(line, sterna::options_of(options), context);
  CaseProblems problems;
  require_su2_flow(request.flow, std::nullopt, problems);
  if (const std::string problem = problem_of_su2_mesh(options.mesh); !problem.empty()) problems.add(problem);
  problems.require_none(attempted);
  const MeshValue mesh = mesh_of_case(line, context);
  if (options.mesh.empty()) options.mesh = mesh_beside(line.word("input"), output);
  write_su2_file(mesh, options, request, output, attempted, context.run.part("write", k_case_read_end, 1.0));
  context.console.end_progress();
  return k_exit_success;
}

}  // namespace sterna::scripting
