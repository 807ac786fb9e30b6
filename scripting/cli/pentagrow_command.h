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

/// Writes the same files as pentagrow into the current folder: hybrid.bmsh .cgns .taumesh .su2 as OutputFormat requests (each with its manifest), outermost.vtu
/// (the envelope), boundaries.smesh (envelope and outer boundary, with the farfield), sumcos.txt (skew of the prisms in 15 classes) and diagnose.txt (tangled
/// elements: none, or there is no mesh).
int execute(const PentagrowCommand& command, const CommandContext& context);

}  // namespace sterna::scripting
