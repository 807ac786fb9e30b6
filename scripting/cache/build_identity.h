// The factors that determine results beside inputs and options: the code and the processor.
#pragma once

#include <string>

namespace sterna::scripting {

/// Returns the version and the build ids of this executable and of every library in this process (the file's hash if there is no build id). Also returns the
/// vector instructions of the processor, because mathematical functions are selected by them. Two processes with the same string produce the same bytes from
/// the same inputs. Human-readable lines; takes some milliseconds.
/// \throws Error(file_not_found) if the executable cannot be read
std::string build_identity();

}  // namespace sterna::scripting
