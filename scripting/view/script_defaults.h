// Writes argument values into a script as the defaults of its args{}.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sterna::scripting {

/// Returns the script with these defaults in its args{ ... }: numbers of number{ 10, ... } in its unit, plain numbers as given. The rest of the script is
/// unchanged.
/// A value becomes a Lua string if the default was a string.
/// \throws Error(bad_argument) naming the argument if its default is not a plain value, or if no args{} of this file, or more than one, declares it; the script
/// is then not partly changed
std::string with_defaults(const std::string& script, const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace sterna::scripting
