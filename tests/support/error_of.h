// Errors thrown by a function, for tests of their code and text.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "geom/base/error.h"

namespace sterna::test {

/// Returns the error that `run` throws; fails the test if `run` throws nothing.
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

/// Returns the error that `run` throws as ErrorInfo.
template <class Run>
ErrorInfo error_info_of(const Run& run) {
  return error_of(run).info();
}

/// Returns the text of the error that `run` throws; "" if nothing is thrown.
template <class Run>
std::string message_of(const Run& run) {
  try {
    run();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Runs f, which must throw an Error with this code whose text contains `text`.
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
