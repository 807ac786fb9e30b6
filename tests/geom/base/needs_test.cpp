// STERNA_NEEDS itself: an absent requirement skips the test, or fails the test where every requirement must be present.
#include <gtest/gtest-spi.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "tests/support/data.h"

namespace sterna {
namespace {

class Needs : public testing::Test {
 protected:
  Needs() {
    if (const char* const value = std::getenv(k_name)) before_ = value;
  }
  ~Needs() override {
    if (before_) ::setenv(k_name, before_->c_str(), 1);
    else ::unsetenv(k_name);
  }
  static constexpr const char* k_name = "STERNA_REQUIRE_DATA";

 private:
  std::optional<std::string> before_;
};

TEST_F(Needs, FailWhereEverythingIsRequired) {
  ::setenv(k_name, "1", 1);
  EXPECT_FATAL_FAILURE(
      {
        STERNA_NEEDS(false, "the tool "
                                << "x");
      },
      "STERNA_REQUIRE_DATA=1, but the tool x is absent");
  STERNA_NEEDS(true, "what is there");
}

TEST_F(Needs, SkipElsewhere) {
  ::setenv(k_name, "0", 1);
  bool is_behind = false;
  testing::TestPartResultArray results;
  {
    const testing::ScopedFakeTestPartResultReporter reporter(testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
    [&] {
      STERNA_NEEDS(false, "a package");
      is_behind = true;
    }();
  }
  EXPECT_FALSE(is_behind);
  ASSERT_EQ(results.size(), 1);
  EXPECT_TRUE(results.GetTestPartResult(0).skipped());
}

}  // namespace
}  // namespace sterna
