// What decides results beside inputs and options: the code that runs and the processor that runs it.
#pragma once

#include <string>

namespace sterna::scripting {

/// Version, the build ids of this executable and of every library in this process (the file's hash where there is none), and which vector instructions the
/// processor has, as mathematical functions choose by them. Two processes with the same text make the same bytes of the same inputs. Lines for people, some
/// milliseconds.
/// \throws Error(file_not_found) where the executable cannot be read
std::string build_identity();

}  // namespace sterna::scripting
