// Commands that run verbs: the words of a command line become the table of a verb, and the verb's own function does the work.
#pragma once

#include <string_view>

#include "scripting/cache/stage_cache.h"
#include "scripting/command/command_context.h"
#include "scripting/command/command_line.h"
#include "scripting/lua/script_value.h"

namespace sterna::scripting {

/// Returns the options that the description of a verb lists. \pre it lists options
HeldOptions options_of_verb(std::string_view verb);

/// Calls the function of a verb with one table, as a script does. Results go to the console.
/// \throws Error of the verb
ScriptValue execute_verb(std::string_view verb, ScriptTable table, const CommandContext& context, const RunContext& part, const StageCache* cache = nullptr);

/// Sets the given options, as set_options does, and adds their values to the table.
/// \throws Error(bad_argument); OptionsShown
void add_options(ScriptTable& table, const OptionTable& options, const OptionOverrides& given, const CommandContext& context);

/// Returns the entry `patches` of a verb's table: { ["wing*"] = { max_edge = 0.1 } }.
/// \throws Error(bad_argument, unknown_option)
ScriptValue patches_entry(const PatchEntries& patches);
/// Returns the entry `sources` of a verb's table.
/// \throws Error of source_of_text
ScriptValue sources_entry(const std::vector<std::string>& texts);

/// The commands whose work is one verb: `sterna half`, `remesh`, `draw` (of one file), `repair`, `wrap`, `union` (of several).
int half_command(const CommandLine& line, const CommandContext& context);
int remesh_command(const CommandLine& line, const CommandContext& context);
int repair_command(const CommandLine& line, const CommandContext& context);
int wrap_command(const CommandLine& line, const CommandContext& context);
int union_command(const CommandLine& line, const CommandContext& context);
int draw_command(const CommandLine& line, const CommandContext& context);

}  // namespace sterna::scripting
