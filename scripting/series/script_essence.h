// The part of a script that determines the results of its series.
#pragma once

#include <string>

namespace sterna::scripting {

/// Returns the script without comments, with single blanks, and without the entries `run` and `retry` in the table of a series{ ... }. These entries (the
/// location of the runs, and the choice of cases to run again) do not change results.
std::string script_essence(const std::string& script);

}  // namespace sterna::scripting
