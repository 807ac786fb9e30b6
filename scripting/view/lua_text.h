// Texts in the scripts that the workbench makes for files.
#pragma once

#include <string>

namespace sterna::scripting {

/// The text as Lua writes it: "a \"b\"".
inline std::string quoted_for_lua(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\' || c == '\n') quoted += '\\';
    quoted += c == '\n' ? 'n' : c;
  }
  return quoted + '"';
}

}  // namespace sterna::scripting
