// `sterna foam-case` and `sterna su2-config`: apply the functions of mesh:foam_case and mesh:su2_config to a mesh from a file.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "scripting/command/command_context.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

enum class CaseSolver { openfoam, su2 };

struct CaseCommand {
  CaseSolver solver = CaseSolver::openfoam;
  std::string input;                                                ///< mesh file
  std::filesystem::path output;                                     ///< folder of the case, or the configuration file
  OptionOverrides options;                                          ///< options of the solver, options common to all cases, and options of the flow
  std::string reference;                                            ///< model file that describes the wing; empty: none
  std::string moment_origin;                                        ///< "15,0,0"; empty: from the reference
  std::vector<std::pair<std::string, OptionOverrides>> boundaries;  ///< conditions by names of patches
  OptionOverrides kinds;                                            ///< pattern of patch names, kind of these patches
};

struct CaseCommands {
  CaseCommand foam, su2;
};

/// Adds the commands; the command selected on the command line is passed to `choose`.
void add_case_commands(CLI::App& app, CaseCommands& commands, const std::function<void(std::function<int(const CommandContext&)>)>& choose);

/// \throws Error of reading the mesh and of the case; wrong options are reported before the mesh is read
int execute(const CaseCommand& command, const CommandContext& context);

}  // namespace sterna::scripting
