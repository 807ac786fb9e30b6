// mesh:su2_config{}, and what `sterna su2-config` shares with it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/verbs/su2_config.h"

namespace sterna::scripting {

inline constexpr std::string_view k_su2_config_usage =
    "mesh:su2_config{ \"case.cfg\", mesh = \"case.su2\", mach = 0.78, altitude = 11000, length = 4.2, alpha = 2*deg, reference = main_wing }  or  "
    "mesh:su2_config{ \"case.cfg\", flow{ mach = 0.78, altitude = 11000, length = 4.2 }, reference_area = 120, moment_origin = {15, 0, 0} }";
ScriptValue write_su2_config(const ScriptCall& call);
std::string su2_config_help();

/// Writes a configuration for a mesh file that `options` names, else for one beside it with the same name.
/// \throws Error(bad_argument) of su2_config and with_kinds
void write_su2_file(const MeshValue& mesh, Su2Options options, const CaseRequest& request, const std::filesystem::path& file, const std::string& attempted,
                    const RunContext& context);
/// What is wrong with the name of a mesh that SU2 is to read; empty: nothing.
std::string problem_of_su2_mesh(const std::string& name);

}  // namespace sterna::scripting
