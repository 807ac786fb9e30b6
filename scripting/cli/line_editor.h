// Input lines of the user. If stdin is a terminal, they are read by GNU readline (editing, history in a file, completion), else unprocessed.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "scripting/interpreter/completion.h"

namespace sterna::scripting {

class LineEditor {
 public:
  /// `complete` receives the statement up to the cursor. Only one editor may exist at a time (readline has one state per process). The history is read from
  /// `history_file` and saved by the destructor; empty: no history is kept.
  LineEditor(std::function<Completion(const std::string& text)> complete, std::filesystem::path history_file);
  ~LineEditor();
  LineEditor(const LineEditor&) = delete;
  LineEditor& operator=(const LineEditor&) = delete;

  /// Returns the next line without its end; `before`: earlier lines of the statement. Returns nothing at the end of the input. A stop request gives an empty
  /// line and clears the typed characters.
  std::optional<std::string> read(const std::string& prompt, const std::string& before, const std::stop_token& stop);
  /// Adds a whole statement to the history.
  void remember(const std::string& statement);
  bool is_terminal() const { return is_terminal_; }

 private:
  bool is_terminal_;
  std::filesystem::path history_file_;
};

/// Returns the history file of the prompt: $XDG_STATE_HOME/sterna/history, else ~/.local/state/sterna/history; empty without a home.
std::filesystem::path default_history_file();

}  // namespace sterna::scripting
