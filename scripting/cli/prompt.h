// The interactive prompt: Lua with the verbs, one statement at a time.
#pragma once

#include <filesystem>

#include "scripting/interpreter/script_run.h"
#include "scripting/terminal/console.h"
#include "scripting/terminal/interrupt.h"

namespace sterna::scripting {

struct PromptSettings {
  ScriptSettings script;  ///< `script.script`: a name whose folder is the second search location of files
  RunSettings run;        ///< settings for each statement; a statement is stopped by the guard
  std::filesystem::path history_file;
};

/// Reads statements until the input ends or "exit" or "quit". The value of an expression is printed. An incomplete statement is continued on the next line.
/// After an error, which is printed, the prompt continues. Ctrl-C ends the running statement, or the typed line, but not the prompt. Returns the exit status:
/// 0, or that of the last error if stdin is no terminal.
int run_prompt(const PromptSettings& settings, Console& console, InterruptGuard& interrupt);

}  // namespace sterna::scripting
