// The reference manual, docs/lua.md, generated from the tables of verbs, objects and options.
#pragma once

#include <string>
#include <string_view>

namespace sterna::scripting {

/// Returns the manual in Markdown. `commands`: description of the command line's commands, also in Markdown.
std::string manual_text(std::string_view commands);

/// Returns Lua code that creates the objects and files used by the examples of the manual; it takes a second in an empty folder.
std::string_view manual_setup();

}  // namespace sterna::scripting
