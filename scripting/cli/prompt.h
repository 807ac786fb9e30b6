// The interactive prompt: Lua with the verbs, a statement at a time.
#pragma once

#include <filesystem>

#include "scripting/interpreter/script_run.h"
#include "scripting/terminal/console.h"
#include "scripting/terminal/interrupt.h"

namespace sterna::scripting {

struct PromptSettings {
  ScriptSettings script;  ///< `script.script`: a name whose folder is where files are looked for second
  RunSettings run;        ///< of each statement; its stop is the guard's
  std::filesystem::path history_file;
};

/// Reads statements until the input ends or "exit" or "quit": an expression is printed, what is not finished is asked for, an error is printed and the prompt
/// goes on. Ctrl-C ends the statement that runs, or the line that is typed, not the prompt. Returns the exit status: 0, or where stdin is no terminal that of
/// the last error.
int run_prompt(const PromptSettings& settings, Console& console, InterruptGuard& interrupt);

}  // namespace sterna::scripting
