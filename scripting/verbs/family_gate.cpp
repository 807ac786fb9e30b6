#include "scripting/verbs/family_gate.h"

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "geom/base/error.h"
#include "scripting/lua/script_check.h"
#include "scripting/lua/table_reader.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/terminal/exit_status.h"
#include "volmesh/case/layer_choice.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_family_gate_usage = "check_family{ mesh, finer }";

struct CheckFamilyOptions {
  bool strict = false;
};

/// Reads the volume sizes in the manifest beside a mesh file. A manifest that belongs to another file, or to another mesh of that name, is ignored.
void read_manifest(const std::filesystem::path& file, FamilyMember& member, const RunContext& context) {
  const std::filesystem::path path = file.string() + ".json";
  std::error_code ignored;  // a path that cannot be accessed counts as missing
  if (!std::filesystem::exists(path, ignored)) return;
  std::ifstream stream(path, std::ios::binary);
  const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
  if (json.is_discarded() || !json.is_object() || json.value("schema", "") != "sterna-manifest-1")
    return context.warn(path.string() + " is not the manifest of a mesh and is ignored");
  const auto number = [&](const char* location) -> std::optional<double> {
    const nlohmann::json::json_pointer at(location);
    return json.contains(at) && json[at].is_number() ? std::optional(json[at].get<double>()) : std::nullopt;
  };
  if (number("/mesh/nodes") != static_cast<double>(member.nodes))
    return context.warn(path.string() + " belongs to another mesh than " + file.string() + " and is ignored");
  member.refinement = number("/options/family/refinement");
  if (const std::optional<double> growth = number("/options/size/size_growth")) member.tet_growth = 1.0 + (*growth - 1.0) / member.refinement.value_or(1.0);
}

}  // namespace
}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::CheckFamilyOptions> {
  using O = scripting::CheckFamilyOptions;
  static constexpr std::string_view stage = "check_family";
  static constexpr std::array fields = {
      Field<O>{.name = "strict", .member = &O::strict, .help = "treat a rule that FAILs as an error"},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

std::string check_family_help() {
  FamilyTolerances tolerances;
  CheckFamilyOptions options;
  return options_help(sterna::options_of(tolerances)) + options_help(sterna::options_of(options));
}

ScriptValue table_of(const FamilyReport& report) {
  auto table = std::make_shared<ScriptTable>();
  table->fields["verdict"] = std::string(to_string(report.state()));
  for (const FamilyStep& step : report.steps) {
    auto entry = std::make_shared<ScriptTable>();
    entry->fields = {{"factor", step.factor}, {"factor_by_nodes", step.factor_by_nodes}, {"factor_by_edges", step.factor_by_edges}};
    auto states = std::make_shared<ScriptTable>();
    for (const FamilyRule& rule : step.rules) states->fields[rule.name] = std::string(to_string(rule.state));
    entry->fields["rules"] = TableHandle(states);
    table->items.emplace_back(TableHandle(entry));
  }
  return TableHandle(table);
}

ScriptValue check_family_verb(const ScriptCall& call) {
  FamilyTolerances tolerances;
  CheckFamilyOptions options;
  const ScriptTable table = table_argument(call, 0, k_family_gate_usage);
  TableReader reader(table, call.attempted());
  const OptionTable schema = sterna::options_of(tolerances);
  std::vector<std::pair<MeshHandle, InputPath>> meshes;
  for (const ScriptValue& item : reader.items()) {
    if (const auto* mesh = std::get_if<MeshHandle>(&item)) meshes.push_back({*mesh, {}});
    else if (const auto* name = std::get_if<std::string>(&item)) meshes.push_back({nullptr, find_input(call, *name)});
    else reader.add_problem("entry " + std::to_string(meshes.size() + 1) + ": expected a mesh or the name of its file, not " + std::string(type_text(item)));
  }
  if (meshes.size() < 2) reader.add_problem("needs at least two meshes, from coarse to fine: " + std::string(k_family_gate_usage));
  reader.read_options(schema);
  reader.read_options(sterna::options_of(options));
  apply_overrides(call, schema);
  reader.finish();
  std::vector<FamilyMember> members;
  const double n = static_cast<double>(meshes.size());
  for (const auto& [mesh, file] : meshes) {
    const double i = static_cast<double>(members.size());
    const RunContext part = call.session.context.part("check_family", i / n, (i + 1) / n);
    // If the mesh was read in this run, the name of its file is known, and therefore its manifest.
    InputPath from = file;
    if (mesh && !mesh->origin && mesh->inputs.size() == 1) from = find_input(call, mesh->inputs.front().name);
    const std::string name = from.name.empty() ? "mesh " + std::to_string(members.size() + 1) : from.name;
    members.push_back(member_of(mesh ? *mesh : read_mesh(from, part), name, from.path, part));
  }
  const FamilyReport report = check_family(std::move(members), tolerances);
  call.session.print(to_text(report));
  if (options.strict && report.state() == GateState::fail)
    throw Error(
        {.code = ErrorCode::mesh_invalid, .attempted = call.attempted(), .problem = "the meshes are not a family: the rules that FAIL are printed above"});
  return table_of(report);
}

constexpr std::array<ScriptVerb, 1> k_family_gate_verbs = {{
    {"check_family", k_family_gate_usage,
     "Checks that meshes are members of one family, each finer than the previous mesh by the same factor in all directions. Prints measured and expected "
     "values of each rule.",
     check_family_verb, check_family_help, true, "table", false, held_options<FamilyTolerances>},
}};

}  // namespace

FamilyMember member_of(const MeshValue& mesh, std::string name, const std::filesystem::path& file, const RunContext& context) {
  FamilyMember member = family_member(mesh.mesh, std::move(name), context);
  if (mesh.origin) {
    member.refinement = mesh.origin->options.family.refinement;
    member.tet_growth = volmesh::refined(mesh.origin->options).size.size_growth;
  } else if (!file.empty()) {
    read_manifest(file, member, context);
  }
  return member;
}

int check_family_command(const CommandLine& line, const CommandContext& context) {
  FamilyTolerances tolerances;
  set_options(sterna::options_of(tolerances), line.options, context);
  std::vector<FamilyMember> members;
  const std::vector<std::string>& files = line.all("meshes");
  const double n = static_cast<double>(files.size());
  for (const std::string& name : files) {
    const double i = static_cast<double>(members.size());
    const RunContext part = context.run.part("check-family", i / n, (i + 1) / n);
    members.push_back(member_of(read_mesh({name, name}, part), name, name, part));
  }
  const FamilyReport report = check_family(std::move(members), tolerances);
  context.console.end_progress();
  context.console.print(line.flag("json") ? to_json(report) : to_text(report));
  return report.state() == GateState::fail ? k_exit_invalid : k_exit_success;
}

std::span<const ScriptVerb> family_gate_verbs() { return k_family_gate_verbs; }

}  // namespace sterna::scripting
