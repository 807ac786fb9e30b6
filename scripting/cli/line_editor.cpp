// The only file that uses GNU readline. Its functions and its completion take their data from globals, so only one editor may exist at a time.
#include "scripting/cli/line_editor.h"

#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>

#include <readline/history.h>
#include <readline/readline.h>

namespace sterna::scripting {
namespace {

constexpr int k_kept_lines = 2000;
/// Polling interval for the stop token while the user types.
constexpr int k_poll_ms = 50;

/// Data of the editor for readline's callbacks, which receive no context.
struct Callbacks {
  std::function<Completion(const std::string&)> complete;
  std::string before;
  std::optional<std::string> line;
  bool is_done = false;
};
Callbacks& callbacks() {
  static Callbacks of_editor;
  return of_editor;
}

char* copy_of(const std::string& text) { return ::strdup(text.c_str()); }

/// Returns readline's list of candidates, which begins with their common prefix. Null stands for names of files.
char** candidates_of(const char* word, int start, int) {
  const Completion found = callbacks().complete(callbacks().before + std::string(rl_line_buffer, static_cast<std::size_t>(rl_point)));
  rl_attempted_completion_over = found.is_text ? 0 : 1;
  rl_completion_append_character = '\0';
  if (found.candidates.empty()) return nullptr;
  // The word that readline sees may begin later than the completed one ("wall:wr" is one word here).
  const std::size_t skipped = callbacks().before.size() + static_cast<std::size_t>(start) - found.start;
  std::string common = found.candidates.front();
  for (const std::string& candidate : found.candidates) {
    std::size_t n = 0;
    while (n < common.size() && n < candidate.size() && common[n] == candidate[n]) ++n;
    common.resize(n);
  }
  auto** list = static_cast<char**>(std::calloc(found.candidates.size() + 2, sizeof(char*)));
  list[0] = copy_of(common.size() > skipped ? common.substr(skipped) : word);
  if (found.candidates.size() > 1)
    for (std::size_t i = 0; i < found.candidates.size(); ++i) list[i + 1] = copy_of(found.candidates[i].substr(skipped));
  return list;
}

void take_line(char* line) {
  callbacks().line = line ? std::optional<std::string>(line) : std::nullopt;
  callbacks().is_done = true;
  std::free(line);
  rl_callback_handler_remove();
}

}  // namespace

LineEditor::LineEditor(std::function<Completion(const std::string& text)> complete, std::filesystem::path history_file)
    : is_terminal_(::isatty(STDIN_FILENO) != 0), history_file_(std::move(history_file)) {
  if (!is_terminal_) return;
  callbacks().complete = std::move(complete);
  rl_readline_name = "sterna";
  rl_catch_signals = 0;  // Ctrl-C is a stop request
  rl_attempted_completion_function = candidates_of;
  rl_completer_word_break_characters = " \t\n\"'{}()[]=,;+-*/<>";
  rl_completer_quote_characters = "\"'";
  using_history();
  stifle_history(k_kept_lines);
  history_comment_char = '#';  // a statement may have several lines; time stamps separate statements in the file
  history_write_timestamps = 1;
  history_multiline_entries = 1;
  if (!history_file_.empty()) read_history(history_file_.c_str());  // at the first start there is no history
}

LineEditor::~LineEditor() {
  if (!is_terminal_) return;
  callbacks() = {};
  if (history_file_.empty()) return;
  std::error_code failure;
  std::filesystem::create_directories(history_file_.parent_path(), failure);
  if (!failure && write_history(history_file_.c_str()) == 0) return;
  std::fprintf(stderr, "warning: the history could not be written to %s\n", history_file_.c_str());
}

std::optional<std::string> LineEditor::read(const std::string& prompt, const std::string& before, const std::stop_token& stop) {
  if (!is_terminal_) {
    std::string line;
    if (!std::getline(std::cin, line)) return std::nullopt;
    return line;
  }
  callbacks().before = before;
  callbacks().is_done = false;
  rl_callback_handler_install(prompt.c_str(), take_line);
  while (!callbacks().is_done) {
    pollfd input{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    if (::poll(&input, 1, k_poll_ms) > 0) rl_callback_read_char();
    if (callbacks().is_done || !stop.stop_requested()) continue;
    rl_callback_handler_remove();
    std::fputs("^C\n", stdout);
    return "";
  }
  return callbacks().line;
}

void LineEditor::remember(const std::string& statement) {
  if (is_terminal_ && !statement.empty()) add_history(statement.c_str());
}

std::filesystem::path default_history_file() {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state) return std::filesystem::path(state) / "sterna" / "history";
  if (const char* home = std::getenv("HOME"); home && *home) return std::filesystem::path(home) / ".local" / "state" / "sterna" / "history";
  return {};
}

}  // namespace sterna::scripting
