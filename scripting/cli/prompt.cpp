#include "scripting/cli/prompt.h"

#include <string_view>

#include "geom/base/error.h"
#include "scripting/cli/line_editor.h"
#include "scripting/interpreter/script_state.h"
#include "scripting/terminal/exit_status.h"

namespace sterna::scripting {
namespace {

constexpr const char* k_first = "> ";
constexpr const char* k_further = ">> ";
constexpr const char* k_chunk_name = "=prompt";

bool is_blank(const std::string& text) { return text.find_first_not_of(" \t\r\n;") == std::string::npos; }

bool is_end(const std::string& line) { return line == "exit" || line == "quit" || line == "exit()" || line == "quit()"; }

RunContext context_of(const PromptSettings& settings, const InterruptGuard& interrupt) {
  RunSettings run = settings.run;
  run.stop = interrupt.token();
  return RunContext(run);
}

/// Reads lines until Lua has a whole statement; returns nothing at the end of the input. An expression is prefixed with "return".
std::optional<std::string> read_statement(ScriptState& state, LineEditor& editor, InterruptGuard& interrupt, bool& is_last) {
  std::string statement;
  while (true) {
    interrupt.renew();
    const auto line = editor.read(statement.empty() ? k_first : k_further, statement, interrupt.token());
    if (!line) {
      is_last = true;
      return is_blank(statement) ? std::nullopt : std::optional(statement);
    }
    if (interrupt.token().stop_requested()) return "";
    if (statement.empty() && is_end(*line)) return std::nullopt;
    statement += (statement.empty() ? "" : "\n") + *line;
    if (is_blank(statement)) return "";
    const std::string expression = "return " + statement;
    if (state.is_correct(statement) || state.is_correct(expression)) return statement;
    if (!state.is_incomplete(statement) && !state.is_incomplete(expression)) return statement;
  }
}

}  // namespace

int run_prompt(const PromptSettings& settings, Console& console, InterruptGuard& interrupt) {
  interrupt.wait_for_late_work();
  ScriptState state(settings.script, context_of(settings, interrupt));
  LineEditor editor([&](const std::string& text) { return complete(text, state); }, settings.history_file);
  if (editor.is_terminal())
    console.print("sterna " STERNA_VERSION ": help() lists the verbs, help(volume_mesh) explains a verb, Tab completes names, exit ends");
  int status = k_exit_success;
  for (bool is_last = false; !is_last;) {
    const auto statement = read_statement(state, editor, interrupt, is_last);
    if (!statement) break;
    if (is_blank(*statement)) continue;
    editor.remember(*statement);
    interrupt.renew();
    state.session().context = context_of(settings, interrupt);
    try {
      const std::string expression = "return " + *statement;
      state.run_and_print(state.is_correct(expression) ? expression : *statement, k_chunk_name);
    } catch (const Error& error) {
      console.end_progress();
      console.error(error.what());
      if (!editor.is_terminal()) status = exit_status_of(error.code());
    }
    console.end_progress();
  }
  return status;
}

}  // namespace sterna::scripting
