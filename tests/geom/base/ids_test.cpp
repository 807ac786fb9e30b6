#include "geom/base/ids.h"

#include <gtest/gtest.h>

#include "tests/support/error_of.h"

namespace sterna {
namespace {

TEST(Ids, IndexThatMeansNoneIsError) {
  EXPECT_EQ(VertexId(k_none - 1).value(), k_none - 1);
  EXPECT_FALSE(VertexId().is_valid());
  EXPECT_EQ(VertexId().value(), k_none);
  test::expect_error(ErrorCode::overflow, "does not fit", [] { VertexId{k_none}; });
  test::expect_error(ErrorCode::overflow, "does not fit", [] { VertexId{std::uint64_t{k_none} + 1}; });
  test::expect_error(ErrorCode::overflow, "does not fit", [] { VertexId{-1}; });
}

}  // namespace
}  // namespace sterna
