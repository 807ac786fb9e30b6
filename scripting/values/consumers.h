// Kinds of solvers to which a verdict applies. They are given by names of solvers, or by the formats of files.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "geom/mesh/gates.h"

namespace sterna::scripting {

/// Returns the consumers of a list such as "su2,openfoam"; `usual` if the list is "automatic".
/// \param option name of the option for messages: "--for"
/// \throws Error(bad_argument) with the known names
Consumers consumers_of_solvers(std::string_view list, Consumers usual, std::string_view option);
/// Returns the names that such a list may contain: "su2, tau, edge, fun3d, node-centred, openfoam, ...".
std::string known_solvers();

/// Returns the consumers of the formats of these files, combined; both kinds if there is no file.
Consumers consumers_of_files(std::span<const std::filesystem::path> files);

}  // namespace sterna::scripting
