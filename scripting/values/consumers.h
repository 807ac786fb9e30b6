// Which kinds of solvers a verdict is for: by names of solvers, or by the formats of files.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "geom/mesh/gates.h"

namespace sterna::scripting {

/// The consumers of a list such as "su2,openfoam"; `usual` where the list is "automatic".
/// \param option its name, for messages: "--for"
/// \throws Error(bad_argument) with the known names
Consumers consumers_of_solvers(std::string_view list, Consumers usual, std::string_view option);
/// "su2, tau, edge, fun3d, node-centred, openfoam, ...": what such a list may hold.
std::string known_solvers();

/// The consumers of the formats of these files, all of them together; both kinds where there is no file.
Consumers consumers_of_files(std::span<const std::filesystem::path> files);

}  // namespace sterna::scripting
