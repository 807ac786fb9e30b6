// Strings in the scripts that the workbench generates for files.
#pragma once

#include <string>

namespace sterna::scripting {

/// Returns the string as a Lua literal: "a \"b\"".
inline std::string quoted_for_lua(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\' || c == '\n') quoted += '\\';
    quoted += c == '\n' ? 'n' : c;
  }
  return quoted + '"';
}

}  // namespace sterna::scripting
