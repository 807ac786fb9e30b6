// The part of Lua available to scripts: base, table, string, math and utf8 without functions that load code, read files, or cannot be interrupted.
#pragma once

#include <filesystem>
#include <string>

struct lua_State;

namespace sterna::scripting {

/// Opens the libraries and replaces print, require, pairs, pcall, xpcall, setmetatable and math.randomseed. May raise.
void open_sandbox(lua_State* state);
/// From this call on an undefined global is an error, not nil. May raise.
void refuse_unknown_globals(lua_State* state);
/// From this call on a stop request ends the script: at its next instruction, and after every verb. No pcall of a script catches it.
void watch_for_stop(lua_State* state);

/// Returns the text of a script.
/// \throws Error(file_not_found)
std::string read_script(const std::filesystem::path& path);

/// Returns "case.lua:5: " of the nearest running Lua function.
std::string where_of(lua_State* state);

/// Returns true if a pcall or xpcall of the script catches errors of the running code.
bool is_protected(lua_State* state);

}  // namespace sterna::scripting
