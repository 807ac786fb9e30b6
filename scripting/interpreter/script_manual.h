// The reference manual, docs/lua.md, made of the tables of verbs, objects and options.
#pragma once

#include <string>
#include <string_view>

namespace sterna::scripting {

/// Markdown. `commands`: what is said of the command line's commands, in Markdown too.
std::string manual_text(std::string_view commands);

/// Lua that makes the objects and files that the examples of the manual name; in an empty folder it takes a second.
std::string_view manual_setup();

}  // namespace sterna::scripting
