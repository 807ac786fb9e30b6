// Values of arguments written into a script: the defaults of its args{}.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sterna::scripting {

/// The text of the script with these defaults in its args{ ... }: numbers of number{ 10, ... } in its unit, plain ones as they are given. All else stays as
/// it is. A text becomes a Lua string where the default was one.
/// \throws Error(bad_argument) naming the argument whose default is no plain value there, or that no args{} of this file, or more than one, declares; nothing is half done
std::string with_defaults(const std::string& script, const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace sterna::scripting
