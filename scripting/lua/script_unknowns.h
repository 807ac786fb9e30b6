// What a script that is only checked does not know: a value that takes part in everything (arithmetic, fields, calls, comparisons) and decides nothing.
#pragma once

struct lua_State;

namespace sterna::scripting {

inline constexpr const char* k_unknown_type = "sterna.unknown";

/// Makes its metatable and lets the functions of Lua's libraries take it. `assert` is passed over once anything stands for what was not made.
/// After open_sandbox(). May raise.
void open_unknowns(lua_State* state);
/// Pushes such a value.
/// \pre open_unknowns() May raise.
void push_unknown(lua_State* state);

}  // namespace sterna::scripting
