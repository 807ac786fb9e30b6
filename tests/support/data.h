// Where test inputs live: small cases in tests/data; real ones in ../shared/data, whose tests are skipped with a message where it is absent.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

namespace sterna::test {

/// tests/data of the repository.
std::filesystem::path corpus();
/// ../shared/data beside the repository; may not exist.
std::filesystem::path shared_data();
bool has_shared_data();
/// A fresh empty folder for the running test.
std::filesystem::path scratch();

}  // namespace sterna::test

/// First line of every test that reads ../shared/data: skips where it is absent, fails where STERNA_REQUIRE_DATA=1 says that it must be there.
#define STERNA_NEEDS_SHARED_DATA()                                                                             \
  do {                                                                                                         \
    if (!sterna::test::has_shared_data()) {                                                                    \
      const char* required = std::getenv("STERNA_REQUIRE_DATA");                                               \
      if (required && std::string_view(required) == "1") FAIL() << "STERNA_REQUIRE_DATA=1, but ../shared/data is absent"; \
      GTEST_SKIP() << "needs ../shared/data, which is absent here";                                            \
    }                                                                                                          \
  } while (false)
