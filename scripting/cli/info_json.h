// `sterna info --json`: what a file holds, for programs.
#pragma once

#include <optional>
#include <string>

#include "scripting/command/command_context.h"

namespace sterna::scripting {

/// JSON, schema "sterna-info-1" (docs/python.md): kind, format, box, patches with name, kind, faces and area; of volume meshes nodes and cells; of models
/// components, solids, wings and measures. `unit`: metres per unit of the file; without it 1, of models what the file says.
/// \throws Error of the readers
std::string info_json(const std::string& file, std::optional<double> unit, const CommandContext& context);

}  // namespace sterna::scripting
