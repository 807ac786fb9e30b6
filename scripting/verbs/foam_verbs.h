// mesh:foam_case{}, and the functions common with `sterna foam-case`.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/verbs/foam_case.h"

namespace sterna::scripting {

inline constexpr std::string_view k_foam_case_usage =
    "mesh:foam_case{ \"case\", mach = 0.2, altitude = 0, length = 4.2, alpha = 2*deg, reference = main_wing, model = \"kOmegaSST\", tasks = 8 }  or  "
    "mesh:foam_case{ \"case\", flow{ reynolds = 100, length = 1 }, model = \"laminar\", reference_area = 0.785 }";
ScriptValue write_foam_case(const ScriptCall& call);
std::string foam_case_help();

/// Writes the folder of a case, completely or not at all. An older case without results is replaced.
/// \throws Error(bad_argument) of foam_case and with_kinds, (write_failed) as require_new_case
void write_foam_folder(const MeshValue& mesh, const FoamOptions& options, const CaseRequest& request, const std::filesystem::path& folder,
                       const std::string& attempted, const RunContext& context);
/// Rejects a folder whose case has been run, because its results took hours.
/// \throws Error(write_failed)
void require_new_case(const std::filesystem::path& folder, const std::string& attempted);
/// Returns the path without the slash with which a folder may end.
std::filesystem::path case_folder(const std::filesystem::path& path);

}  // namespace sterna::scripting
