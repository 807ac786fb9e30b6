// The error that something throws, for tests of what it says.
#pragma once

#include <gtest/gtest.h>

#include "geom/base/error.h"

namespace sterna::test {

/// What `run` threw; a failure of the test when it threw nothing.
template <class Run>
Error error_of(const Run& run) {
  try {
    run();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error was thrown";
  return Error({.code = ErrorCode::internal, .attempted = "no error was thrown"});
}

/// The same, taken apart.
template <class Run>
ErrorInfo error_info_of(const Run& run) {
  return error_of(run).info();
}

}  // namespace sterna::test
