// mesh:su2_config{}, and the functions common with `sterna su2-config`.
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

/// Writes a configuration for the mesh file named in `options`. If none is named, the mesh file has the same name and is beside the configuration.
/// \throws Error(bad_argument) of su2_config and with_kinds
void write_su2_file(const MeshValue& mesh, Su2Options options, const CaseRequest& request, const std::filesystem::path& file, const std::string& attempted,
                    const RunContext& context);
/// Returns the problem with the name of a mesh file for SU2; empty if there is none.
std::string problem_of_su2_mesh(const std::string& name);

}  // namespace sterna::scripting
