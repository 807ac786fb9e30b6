// What of a script decides the results of its series.
#pragma once

#include <string>

namespace sterna::scripting {

/// Returns the script without comments, with single blanks, and without the entries `run` and `retry` that stand in the table of a series{ ... }: where cases
/// run, and which of them run again, changes no result.
std::string script_essence(const std::string& script);

}  // namespace sterna::scripting
