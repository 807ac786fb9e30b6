// What scripts see of Lua: base, table, string, math and utf8 without what would load code, read files, or run where nothing can stop it.
#pragma once

#include <filesystem>
#include <string>

struct lua_State;

namespace sterna::scripting {

/// Opens the libraries and makes print, require, pairs, pcall, xpcall, setmetatable and math.randomseed ours. May raise.
void open_sandbox(lua_State* state);
/// From here on a global that nothing has is an error, not nil. May raise.
void refuse_unknown_globals(lua_State* state);
/// From here on a stop request ends the script: at its next instruction, and behind every verb. No pcall of a script keeps it.
void watch_for_stop(lua_State* state);

/// The text of a script.
/// \throws Error(file_not_found)
std::string read_script(const std::filesystem::path& path);

/// "case.lua:5: " of the nearest Lua function that is running.
std::string where_of(lua_State* state);

/// Whether a script's own pcall or xpcall waits for an error of what runs.
bool is_protected(lua_State* state);

}  // namespace sterna::scripting
