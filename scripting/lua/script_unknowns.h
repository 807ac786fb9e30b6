// Unknown values in a script that is only checked. Such a value can be used everywhere (arithmetic, fields, calls, comparisons), and nothing is decided by it.
#pragma once

struct lua_State;

namespace sterna::scripting {

inline constexpr const char* k_unknown_type = "sterna.unknown";

/// Makes the metatable of unknown values, and lets the functions of Lua's libraries accept them. `assert` has no effect once a placeholder exists. To be called
/// after open_sandbox(). May raise.
void open_unknowns(lua_State* state);
/// Pushes an unknown value.
/// \pre open_unknowns() May raise.
void push_unknown(lua_State* state);

}  // namespace sterna::scripting
