// Lines from the user: with GNU readline where stdin is a terminal (editing, history in a file, completion), else as they come.
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
  /// `complete` is asked with everything of the statement up to the cursor; one editor at a time (readline has one state for a process).
  /// The history is that of `history_file`, kept there when the editor goes; empty: none is kept.
  LineEditor(std::function<Completion(const std::string& text)> complete, std::filesystem::path history_file);
  ~LineEditor();
  LineEditor(const LineEditor&) = delete;
  LineEditor& operator=(const LineEditor&) = delete;

  /// The next line without its end; `before`: earlier lines of the statement. Nothing at the end of the input. A stop request gives an empty line and clears
  /// what was typed.
  std::optional<std::string> read(const std::string& prompt, const std::string& before, const std::stop_token& stop);
  /// A whole statement for the history.
  void remember(const std::string& statement);
  bool is_terminal() const { return is_terminal_; }

 private:
  bool is_terminal_;
  std::filesystem::path history_file_;
};

/// Where the history of the prompt is kept: $XDG_STATE_HOME/sterna/history, else ~/.local/state/sterna/history; empty without a home.
std::filesystem::path default_history_file();

}  // namespace sterna::scripting
