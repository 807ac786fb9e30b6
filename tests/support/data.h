// Locations of test inputs: small cases in tests/data; real cases packed in tests/data/shared, in the folder where the build unpacks them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

namespace sterna::test {

/// Returns the top folder of the repository.
std::filesystem::path source_folder();
/// Returns the build folder, which contains the programs.
std::filesystem::path build_folder();
/// Returns tests/data of the repository.
std::filesystem::path corpus();
/// Returns the folder of the real inputs (unpacked tests/data/shared), with the paths of the archives.
std::filesystem::path shared_data();
/// Returns false if the build could not unpack the real inputs.
bool has_shared_data();
/// Returns a new empty folder for the running test.
std::filesystem::path scratch();

/// Returns true if STERNA_REQUIRE_DATA=1: all requirements of tests must be present, so no test may be skipped.
bool is_all_required();

}  // namespace sterna::test

/// Marks requirements that some machines lack (data, programs and modules of other packages). If `is_there` is false, the test is skipped, or fails if
/// is_all_required().
/// \param what the missing requirement
#define STERNA_NEEDS(is_there, what)                                                                        \
  do {                                                                                                      \
    if (!(is_there)) {                                                                                      \
      if (sterna::test::is_all_required()) FAIL() << "STERNA_REQUIRE_DATA=1, but " << what << " is absent"; \
      GTEST_SKIP() << what << " is absent here";                                                            \
    }                                                                                                       \
  } while (false)

/// First line of every test that reads shared_data().
#define STERNA_NEEDS_SHARED_DATA() STERNA_NEEDS(sterna::test::has_shared_data(), "the folder of real inputs, which the build unpacks from tests/data/shared,")
