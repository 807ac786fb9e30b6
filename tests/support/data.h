// Where test inputs live: small cases in tests/data; real ones, which are packed in tests/data/shared, where the build unpacks them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

namespace sterna::test {

/// The top folder of the repository.
std::filesystem::path source_folder();
/// The folder of the build, which has the programs.
std::filesystem::path build_folder();
/// tests/data of the repository.
std::filesystem::path corpus();
/// The real inputs (unpacked tests/data/shared), by their paths in the archives.
std::filesystem::path shared_data();
/// False where the build could not unpack the real inputs.
bool has_shared_data();
/// A fresh empty folder for the running test.
std::filesystem::path scratch();

/// STERNA_REQUIRE_DATA=1: nothing that a test needs may be absent, so no test may be skipped.
bool is_all_required();

}  // namespace sterna::test

/// For what not every machine has (data, programs and modules of other packages): skips the test where `is_there` is false, fails it where is_all_required().
/// \param what what is missing
#define STERNA_NEEDS(is_there, what)                                                                        \
  do {                                                                                                      \
    if (!(is_there)) {                                                                                      \
      if (sterna::test::is_all_required()) FAIL() << "STERNA_REQUIRE_DATA=1, but " << what << " is absent"; \
      GTEST_SKIP() << what << " is absent here";                                                            \
    }                                                                                                       \
  } while (false)

/// First line of every test that reads shared_data().
#define STERNA_NEEDS_SHARED_DATA() STERNA_NEEDS(sterna::test::has_shared_data(), "the folder of real inputs, which the build unpacks from tests/data/shared,")
