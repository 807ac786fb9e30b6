// What may follow at the prompt: verbs, methods and fields of objects, options inside a verb's table.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scripting/interpreter/script_state.h"

namespace sterna::scripting {

struct Completion {
  std::size_t start = 0;                ///< where the word begins that is completed
  std::vector<std::string> candidates;  ///< whole words, sorted; in a text names of patches where those are wanted, else none: names of files
  bool is_text = false;                 ///< within quotes
};

/// What can stand at the end of `text`, which may begin with earlier lines of the same statement. Looks at values, calls nothing of the script.
Completion complete(std::string_view text, ScriptState& state);

}  // namespace sterna::scripting
