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

ScriptValue write_su2_config(const ScriptCall& call) {
  const MeshHandle& mesh = self<MeshHandle>(call);
  const ScriptTable table = table_argument(call, 1, k_su2_config_usage);
  TableReader reader(table, call.attempted());
  Su2Options options;
  CaseOptions common;
  reader.read_options(sterna::options_of(options));
  reader.read_options(sterna::options_of(common));
  const auto flow = read_flow(reader, 1);
  const auto* file = reader.items().empty() ? nullptr : std::get_if<std::string>(&reader.items().front());
  if (!file) reader.add_problem("entry 1: expected the name of the configuration, \"case.cfg\"");
  const CaseReference reference = read_case_reference(call, reader, common);
  const CaseBoundaries boundaries = read_case_boundaries(reader);
  if (!options.mesh.empty() && !options.mesh.ends_with(".su2") && !options.mesh.ends_with(".cgns"))
    reader.add_problem("mesh: SU2 reads .su2 and .cgns, not \"" + options.mesh + "\"");
  if (file) note_output(call, output_path(call, *file));
  if (flow && call.session.check && !reader.has_problems()) {  // in a run the mesh says the rest, and all is told together
    CaseProblems needed;
    const bool asks_viscous = options.solver == "RANS" || options.solver == "NAVIER_STOKES";
    require_su2_flow(*flow, reference, asks_viscous ? std::optional<bool>(true) : std::nullopt, needed);
    for (const std::string& problem : needed.all()) reader.add_problem(problem);
  }
  reader.finish();
  const std::filesystem::path path = output_path(call, *file);
  if (options.mesh.empty()) options.mesh = path.stem().string() + ".su2";
  std::string text;
  try {
    text = su2_config(mesh->mesh, options, common, *flow, reference, boundaries, call.session.context);
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
  return options_help(sterna::options_of(options)) + solver_case_help();
}

}  // namespace sterna::scripting
