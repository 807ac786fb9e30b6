// Exit statuses of a run. Also printed by `sterna --help`.
#pragma once

#include "geom/base/error.h"

namespace sterna::scripting {

inline constexpr int k_exit_success = 0;
inline constexpr int k_exit_failed = 1;         ///< the run failed because of an unusable surface, a missing file, an engine or the disk
inline constexpr int k_exit_usage = 2;          ///< the command line, an option or the script is wrong
inline constexpr int k_exit_invalid = 3;        ///< the mesh is INVALID, or with --strict a QUALITY gate FAILs
inline constexpr int k_exit_interrupted = 130;  ///< stopped by Ctrl-C or SIGTERM; 128 + SIGINT, as in shells

inline constexpr const char* k_exit_status_help =
    "Exit status: 0 success (check: VALID), 1 the run failed, 2 wrong command line, option or script, 3 the mesh is INVALID (with check --strict also: a "
    "QUALITY gate FAILs), 130 stopped by Ctrl-C.";

constexpr int exit_status_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::bad_argument:
    case ErrorCode::unknown_option:
    case ErrorCode::script_failed: return k_exit_usage;
    case ErrorCode::mesh_invalid: return k_exit_invalid;
    case ErrorCode::cancelled: return k_exit_interrupted;
    default: return k_exit_failed;
  }
}

}  // namespace sterna::scripting
