// mesh:su2_config{}
#pragma once

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

inline constexpr std::string_view k_su2_config_usage =
    "mesh:su2_config{ \"case.cfg\", mesh = \"case.su2\", mach = 0.78, altitude = 11000, length = 4.2, alpha = 2*deg, reference = main_wing }  or  "
    "mesh:su2_config{ \"case.cfg\", flow{ mach = 0.78, altitude = 11000, length = 4.2 }, reference_area = 120, moment_origin = {15, 0, 0} }";
ScriptValue write_su2_config(const ScriptCall& call);
std::string su2_config_help();

}  // namespace sterna::scripting
