// Converts exceptions of the standard library to errors for the user: lack of memory or threads, else an internal error.
#pragma once

#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include "geom/base/error.h"

namespace sterna::scripting {

/// Returns the error for an exception. For std::bad_alloc and for a thread that the system cannot start, it has the code overflow and a remedy; all others have
/// the code internal, to be reported to the developers.
inline ErrorInfo foreign_error(const std::exception& error, std::string attempted) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr)
    return {.code = ErrorCode::overflow,
            .attempted = std::move(attempted),
            .problem = "not enough memory",
            .hint =
                "a larger limit (ulimit -v, the job's memory), fewer triangles or layers, larger tetrahedra (size_growth, farfield_edge), or fewer tasks at "
                "once on this machine"};
  const auto* of_system = dynamic_cast<const std::system_error*>(&error);
  if (of_system != nullptr && of_system->code() == std::errc::resource_unavailable_try_again)
    return {.code = ErrorCode::overflow,
            .attempted = std::move(attempted),
            .problem = "the system cannot start more threads or processes: its limit of memory or processes is reached",
            .hint = "a larger limit (ulimit -v, ulimit -u, the job's memory), --threads 1, or fewer tasks at once on this machine"};
  return {.code = ErrorCode::internal, .attempted = std::move(attempted), .problem = error.what(), .hint = "please report this with the script and its inputs"};
}

}  // namespace sterna::scripting
