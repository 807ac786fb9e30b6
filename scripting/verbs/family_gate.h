// The family rule for users: check_family{ coarse, medium, fine } and `sterna check-family`.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "geom/mesh/family.h"
#include "scripting/command/command_context.h"
#include "scripting/lua/script_call.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

struct CheckFamilyCommand {
  std::vector<std::string> inputs;  ///< from coarse to fine
  OptionOverrides options;
  bool is_json = false;
};

/// What is known of a mesh: of one made here also what was asked for; of one that was read what the manifest beside its file says, where that is the mesh's
/// own. `file`: where it was read from; empty: it was made here.
FamilyMember member_of(const MeshValue& mesh, std::string name, const std::filesystem::path& file, const RunContext& context);

/// Status 3 where a rule FAILs.
/// \throws Error of read_mesh and check_family
int execute(const CheckFamilyCommand& command, const CommandContext& context);

/// check_family.
std::span<const ScriptVerb> family_gate_verbs();

}  // namespace sterna::scripting
