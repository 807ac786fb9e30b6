// The factors that determine results besides inputs and options: the code and the processor.
#pragma once

#include <string>

namespace sterna::scripting {

/// Returns the version and the build ids of this executable and of every library in this process (the file's hash if there is no build id). The text also
/// contains the vector instructions of the processor, because mathematical functions are selected by them. Two processes with the same text produce the same
/// bytes from the same inputs. The lines are human-readable; the call takes some milliseconds.
std::string build_identity();

}  // namespace sterna::scripting
