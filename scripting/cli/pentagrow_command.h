// `sterna pentagrow wall.stl case.cfg`, also started under the program name pentagrow.
#pragma once

#include <filesystem>
#include <string>

#include "scripting/cli/commands.h"

namespace sterna::scripting {

struct PentagrowCommand {
  std::string surface;
  std::string config;  ///< empty: pentagrow's defaults
};

/// Writes the same files as pentagrow into the current folder: the mesh as hybrid.bmsh, .cgns, .taumesh or .su2 as OutputFormat requests (each with its
/// manifest), outermost.vtu (the envelope), boundaries.smesh (envelope and outer boundary, with the farfield), sumcos.txt (skew of the prisms in 15 classes),
/// and diagnose.txt (tangled elements, of which there are none if there is a mesh).
int execute(const PentagrowCommand& command, const CommandContext& context);

}  // namespace sterna::scripting
