// Command line of the commands that check more than one mesh: determinism, check-family.
#pragma once

#include <functional>

#include "scripting/cli/determinism.h"
#include "scripting/verbs/family_gate.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

struct GateCommands {
  DeterminismCommand determinism;
  CheckFamilyCommand family;
};

/// Adds the commands; the command selected on the command line is passed to `choose`.
void add_gate_commands(CLI::App& app, GateCommands& commands, const std::function<void(std::function<int(const CommandContext&)>)>& choose);

}  // namespace sterna::scripting
