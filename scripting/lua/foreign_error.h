// Exceptions of the standard library, as errors for the user: memory or threads that ran out, else a fault of ours.
#pragma once

#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include "geom/base/error.h"

namespace sterna::scripting {

/// Of std::bad_alloc and of a thread that the system does not start: code overflow and what to try; of all others code internal, to be reported.
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
            .problem = "the system starts no more threads or processes: its limit of memory or of processes is reached",
            .hint = "a larger limit (ulimit -v, ulimit -u, the job's memory), --threads 1, or fewer tasks at once on this machine"};
  return {.code = ErrorCode::internal, .attempted = std::move(attempted), .problem = error.what(), .hint = "please report this with the script and its inputs"};
}

}  // namespace sterna::scripting
