// Writes argument values into a script as the defaults of its args{}.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sterna::scripting {

/// Returns the script with these defaults in its args{ ... }. A number for number{ 10, ... } is in the unit of that entry; plain numbers are used as given. The
/// rest of the script is unchanged.
/// A value becomes a Lua string if the default was a string.
/// \throws Error(bad_argument) that names the argument if its default is not a plain value, or if not exactly one args{} of this file declares it; the script
/// is then not partly changed
std::string with_defaults(const std::string& script, const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace sterna::scripting
