// The command line of `sterna`.
#pragma once

namespace sterna::scripting {

/// Parses, runs and prints; returns the exit status of exit_status.h. Never throws.
int run_command_line(int argc, const char* const* argv) noexcept;

}  // namespace sterna::scripting
