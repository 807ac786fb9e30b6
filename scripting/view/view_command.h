// `sterna view`: the workbench of a script, or of a file.
#pragma once

#include "scripting/command/command_context.h"
#include "scripting/command/command_line.h"

namespace sterna::scripting {

/// Serves the page until Ctrl-C.
/// \throws Error(file_not_found, unsupported_format) for an input that cannot be shown, (bad_argument) if the port is taken
int view_command(const CommandLine& line, const CommandContext& context);

}  // namespace sterna::scripting
