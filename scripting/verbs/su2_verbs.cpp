#include "scripting/verbs/su2_verbs.h"

#include <filesystem>

#include "geom/base/error.h"
#include "io/output/atomic_file.h"
#include "scripting/lua/script_check.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/verbs.h"
#include "scripting/verbs/case_tables.h"
#include "scripting/verbs/su2_config.h"

namespace sterna::scripting {

std::string problem_of_su2_mesh(const std::string& name) {
  return name.empty() || name.ends_with(".su2") || name.ends_with(".cgns") ? "" : "mesh: SU2 reads .su2 and .cgns, not \"" + name + "\"";
}

void write_su2_file(const MeshValue& mesh, Su2Options options, const CaseRequest& request, const std::filesystem::path& file, const std::string& attempted,
                    const RunContext& context) {
  if (options.mesh.empty()) options.mesh = file.stem().string() + ".su2";
  const std::optional<HybridMesh> changed = with_kinds(mesh.mesh, request.kinds, attempted);
  const HybridMesh& seen = changed ? *changed : mesh.mesh;
  require_known_kinds(mesh.unknown_kinds, request.kinds, attempted);
  std::string text;
  try {
    const CaseMeasure worst = measured_worst(seen, Measure::orthogonality, mesh.check ? &*mesh.check : nullptr, "SU2", context);
    text = su2_config(seen, options, request.options, request.flow, request.reference, request.boundaries, context, worst);
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.attempted = attempted;
    throw Error(std::move(info));
  }
  io::write_whole(file, text);
  const std::filesystem::path of_mesh = file.parent_path() / options.mesh;
  std::error_code none;
  context.info("wrote " + file.string() + " for the mesh " + options.mesh +
               (std::filesystem::exists(of_mesh, none) ? "" : ", which does not exist yet: mesh:write \"" + of_mesh.string() + "\""));
}

ScriptValue write_su2_config(const ScriptCall& call) {
  const MeshHandle& mesh = self<MeshHandle>(call);
  const ScriptTable table = table_argument(call, 1, k_su2_config_usage);
  TableReader reader(table, call.attempted());
  Su2Options options;
  CaseRequest request;
  reader.read_options(sterna::options_of(options));
  reader.read_options(sterna::options_of(request.options));
  const auto flow = read_flow(reader, 1);
  const auto* file = reader.items().empty() ? nullptr : std::get_if<std::string>(&reader.items().front());
  if (!file) reader.add_problem("entry 1: expected the name of the configuration, \"case.cfg\"");
  request.reference = read_case_reference(call, reader, request.options);
  request.boundaries = read_case_boundaries(reader);
  request.kinds = read_case_kinds(reader);
  if (const std::string problem = problem_of_su2_mesh(options.mesh); !problem.empty()) reader.add_problem(problem);
  if (file) note_output(call, output_path(call, *file));
  if (flow && call.session.check && !reader.has_problems()) {  // in a run the mesh provides the other data, and all problems are reported together
    CaseProblems needed;
    const bool requests_viscous = options.solver == "RANS" || options.solver == "NAVIER_STOKES";
    require_su2_flow(*flow, requests_viscous ? std::optional<bool>(true) : std::nullopt, needed);
    for (const std::string& problem : needed.all()) reader.add_problem(problem);
  }
  reader.finish();
  request.flow = *flow;
  write_su2_file(*mesh, options, request, output_path(call, *file), call.attempted(), call.session.context);
  return mesh;
}

std::string su2_config_help() {
  Su2Options options;
  return options_help(sterna::options_of(options)) + solver_case_help();
}

}  // namespace sterna::scripting
