// mesh:foam_case{}
#pragma once

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

inline constexpr std::string_view k_foam_case_usage =
    "mesh:foam_case{ \"case\", mach = 0.2, altitude = 0, length = 4.2, alpha = 2*deg, reference = main_wing, model = \"kOmegaSST\", tasks = 8 }  or  "
    "mesh:foam_case{ \"case\", flow{ reynolds = 100, length = 1 }, model = \"laminar\", reference_area = 0.785 }";
ScriptValue write_foam_case(const ScriptCall& call);
std::string foam_case_help();

}  // namespace sterna::scripting
