// Completion at the prompt: verbs, methods and fields of objects, options inside a verb's table.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scripting/interpreter/script_state.h"

namespace sterna::scripting {

struct Completion {
  std::size_t start = 0;                ///< start of the completed word
  std::vector<std::string> candidates;  ///< whole words, sorted. Within a string they are names of patches if patches are expected; otherwise there are none,
                                        ///< and file names are completed
  bool is_text = false;                 ///< within quotes
};

/// Returns the possible continuations at the end of `text`, which may begin with earlier lines of the same statement. Inspects values, but calls no function of
/// the script.
Completion complete(std::string_view text, ScriptState& state);

}  // namespace sterna::scripting
