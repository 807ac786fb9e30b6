// The family rule as verb and command: check_family{ coarse, medium, fine } and `sterna check-family`.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "geom/mesh/family.h"
#include "scripting/command/command_context.h"
#include "scripting/command/command_line.h"
#include "scripting/lua/script_call.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Returns the known data of a mesh. For a mesh made in this run, they include the requested options. For a mesh that was read, they include those of the
/// manifest beside its file, if the manifest belongs to the mesh. `file`: source of the mesh; empty: made in this run.
FamilyMember member_of(const MeshValue& mesh, std::string name, const std::filesystem::path& file, const RunContext& context);

/// `sterna check-family`: returns status 3 if a rule FAILs.
/// \throws Error of read_mesh and check_family
int check_family_command(const CommandLine& line, const CommandContext& context);

/// The verb check_family.
std::span<const ScriptVerb> family_gate_verbs();

}  // namespace sterna::scripting
