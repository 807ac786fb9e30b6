// mesh:foam_case{}, and what `sterna foam-case` shares with it.
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

/// The folder appears whole or not at all; an older case without results is replaced.
/// \throws Error(bad_argument) of foam_case and with_kinds, (write_failed) as require_new_case
void write_foam_folder(const MeshValue& mesh, const FoamOptions& options, const CaseRequest& request, const std::filesystem::path& folder,
                       const std::string& attempted, const RunContext& context);
/// A case that was run holds what took hours: it is not replaced.
/// \throws Error(write_failed)
void require_new_case(const std::filesystem::path& folder, const std::string& attempted);
/// Without the slash that a folder may end in.
std::filesystem::path case_folder(const std::filesystem::path& path);

}  // namespace sterna::scripting
