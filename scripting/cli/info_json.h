// `sterna info --json`: the content of a file, machine-readable.
#pragma once

#include <optional>
#include <string>

#include "scripting/command/command_context.h"

namespace sterna::scripting {

/// Returns JSON, schema "sterna-info-1" (docs/python.md): kind, format, box, patches with name, kind, faces and area; for volume meshes nodes and cells; for
/// models components, solids, wings and measures. `unit`: metres per unit of the file; the default is 1, for models the unit given in the file.
/// \throws Error of the readers
std::string info_json(const std::string& file, std::optional<double> unit, const CommandContext& context);

}  // namespace sterna::scripting
