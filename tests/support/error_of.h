// The error that something throws, for tests of what it says.
#pragma once

#include <gtest/gtest.h>

#include <string>

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

/// What the error says; "" when nothing was thrown.
template <class Run>
std::string message_of(const Run& run) {
  try {
    run();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Runs f, which must throw an Error of that code whose text contains `text`.
template <class F>
void expect_error(ErrorCode code, const std::string& text, const F& f) {
  try {
    f();
    ADD_FAILURE() << "no error, expected " << to_string(code) << ": " << text;
  } catch (const Error& error) {
    EXPECT_EQ(to_string(error.code()), to_string(code)) << error.what();
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

}  // namespace sterna::test
