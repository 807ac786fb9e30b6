#include "scripting/verbs/foam_verbs.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "geom/base/error.h"
#include "geom/mesh/numbering.h"
#include "io/output/atomic_file.h"
#include "io/output/atomic_folder.h"
#include "io/volume/volume_foam.h"
#include "scripting/lua/script_check.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/foam_zones.h"
#include "scripting/values/manifest.h"
#include "scripting/values/verbs.h"
#include "scripting/verbs/case_tables.h"
#include "scripting/verbs/foam_case.h"

namespace sterna::scripting {
namespace {

constexpr double k_measured = 0.5;  ///< fraction of the progress after measuring the mesh
/// Items that foam_case and programs of OpenFOAM write into a case without results, apart from NAME.foam and log.*.
constexpr std::array<std::string_view, 7> k_case_items = {"0", "constant", "system", "Allrun", "Allclean", "mesh.json", "dynamicCode"};
constexpr std::string_view k_proof = "system/controlDict";  ///< file that marks a folder as a case

/// \param mesh the mesh for the solver, \param made its origin
void write_case(const HybridMesh& mesh, const MeshValue& made, const FoamCase& files, const FoamOptions& options, const std::filesystem::path& path,
                const RunContext& context) {
  const Numbering numbering = numbering_of(options.numbering);
  // Nodes are numbered by lines even if cells are not: the data of the mesh on its columns stay valid, and the order of nodes hardly affects solvers with
  // values in cells.
  const HybridMesh numbered = renumbered(mesh, numbering == Numbering::lines ? numbering : Numbering::both, context);
  const auto zones = zones_of_sources(numbered, made.origin ? made.origin->options.sources : std::vector<volmesh::SizeSource>{});
  io::AtomicFolder folder(path, k_proof);
  const std::filesystem::path polymesh = folder.path() / "constant" / "polyMesh";
  std::filesystem::create_directories(polymesh);
  io::write_polymesh(numbered, polymesh, {.is_binary = options.format == "binary", .numbering = numbering, .zones = zones, .joined = files.joined}, context);
  for (const CaseFile& file : files.files) {
    std::filesystem::create_directories((folder.path() / file.path).parent_path());
    io::write_whole(folder.path() / file.path, file.text);
    if (file.is_program)
      std::filesystem::permissions(folder.path() / file.path,
                                   std::filesystem::perms::owner_exec | std::filesystem::perms::group_exec | std::filesystem::perms::others_exec,
                                   std::filesystem::perm_options::add);
  }
  io::write_whole(folder.path() / (path.filename().string() + ".foam"), "");  // file by which ParaView opens the case
  io::write_whole(folder.path() / "mesh.json", manifest_json(made, path, context.seed()));
  folder.commit();
}

}  // namespace

std::filesystem::path case_folder(const std::filesystem::path& path) { return path.has_filename() ? path : path.parent_path(); }

void require_new_case(const std::filesystem::path& folder, const std::string& attempted) {
  const std::string whole = std::filesystem::absolute(folder).lexically_normal().string();
  if (whole.find_first_of(" \t\n\"'") != std::string::npos)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = attempted,
                 .problem = "the path " + whole + " has a blank or a quotation mark; OpenFOAM's programs do not run in such a folder",
                 .hint = "choose a folder without them"});
  std::vector<std::string> results, others;
  std::error_code status;  // if the folder does not exist: there are no results
  for (const auto& entry : std::filesystem::directory_iterator(folder, status)) {
    const std::string name = entry.path().filename().string();
    const bool is_time = name != "0" && std::ranges::all_of(name, [](char c) { return (c >= '0' && c <= '9') || c == '.' || c == 'e' || c == '-'; });
    if (entry.is_directory(status) && (is_time || name == "postProcessing" || name.starts_with("processor"))) results.push_back(name);
    else if (std::ranges::find(k_case_items, name) == k_case_items.end() && !name.starts_with("log.") && !name.ends_with(".foam")) others.push_back(name);
  }
  const bool is_other = std::filesystem::exists(folder / "system", status) && !std::filesystem::exists(folder / "mesh.json", status);
  if (results.empty() && (is_other || !others.empty()))
    throw Error({.code = ErrorCode::write_failed,
                 .attempted = attempted,
                 .problem = "the folder " + folder.string() +
                            (is_other ? " holds a case that foam_case did not write"
                                      : " holds \"" + *std::ranges::min_element(others) + "\", which foam_case did not write") +
                            "; a new case would replace it",
                 .hint = "choose another name, or move what is there"});
  if (results.empty()) return;
  throw Error({.code = ErrorCode::write_failed,
               .attempted = attempted,
               .problem = "the case " + folder.string() + " has results (" + *std::ranges::min_element(results) + "), which a new case would replace",
               .hint = "remove the results with Allclean of the case, or choose another name"});
}

void write_foam_folder(const MeshValue& mesh, const FoamOptions& options, const CaseRequest& request, const std::filesystem::path& folder,
                       const std::string& attempted, const RunContext& context) {
  require_new_case(folder, attempted);
  const std::optional<HybridMesh> changed = with_kinds(mesh.mesh, request.kinds, attempted);
  const HybridMesh& seen = changed ? *changed : mesh.mesh;
  require_known_kinds(mesh.unknown_kinds, request.kinds, attempted);
  FoamCase files;
  try {
    const CaseMeasure worst =
        measured_worst(seen, Measure::non_orthogonality, mesh.check ? &*mesh.check : nullptr, "OpenFOAM", context.part("check", 0.0, k_measured));
    files = foam_case(seen, options, request.options, request.flow, request.reference, request.boundaries, context, worst);
  } catch (const Error& error) {
    ErrorInfo info = error.info();
    info.attempted = attempted;
    throw Error(std::move(info));
  }
  write_case(seen, mesh, files, options, folder, context.part("write", k_measured, 1.0));
  context.info("wrote the case " + folder.string() + " for " + files.application + ": run " + (folder / "Allrun").string());
}

ScriptValue write_foam_case(const ScriptCall& call) {
  const MeshHandle& mesh = self<MeshHandle>(call);
  const ScriptTable table = table_argument(call, 1, k_foam_case_usage);
  TableReader reader(table, call.attempted());
  FoamOptions options;
  CaseRequest request;
  reader.read_options(sterna::options_of(options));
  reader.read_options(sterna::options_of(request.options));
  const auto flow = read_flow(reader, 1);
  const auto* name = reader.items().empty() ? nullptr : std::get_if<std::string>(&reader.items().front());
  if (!name) reader.add_problem("entry 1: expected the name of the folder of the case, \"case\"");
  request.reference = read_case_reference(call, reader, request.options);
  request.boundaries = read_case_boundaries(reader);
  request.kinds = read_case_kinds(reader);
  CaseProblems of_flow;
  if (flow) require_foam_flow(options, *flow, of_flow);
  for (const std::string& problem : of_flow.all()) reader.add_problem(problem);
  std::filesystem::path path;
  if (name) {
    path = case_folder(output_path(call, *name));
    note_output(call, path);
    require_new_case(path, call.attempted());
  }
  reader.finish();
  request.flow = *flow;
  write_foam_folder(*mesh, options, request, path, call.attempted(), call.session.context.part("foam_case", 0.0, 1.0));
  return mesh;
}

std::string foam_case_help() {
  FoamOptions options;
  return options_help(sterna::options_of(options)) + solver_case_help();
}

}  // namespace sterna::scripting
