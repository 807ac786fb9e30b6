#include "geom/base/hash.h"

#include <fstream>

#include "geom/base/error.h"
#include "tests/support/data.h"

namespace sterna {
namespace {

TEST(HashFile, MatchesXxhsumAndSeesEveryByte) {
  const auto path = test::scratch() / "file";
  std::ofstream(path) << "";
  EXPECT_EQ(hash_file(path), "99aa06d3014798d86001c324468d497f");  // XXH3-128 of nothing, from the library's own specification
  std::string text(3'000'000, 'x');
  std::ofstream(path) << text;
  const std::string before = hash_file(path);
  EXPECT_EQ(hash_file(path), before);
  text[2'500'000] = 'y';
  std::ofstream(path) << text;
  EXPECT_NE(hash_file(path), before);
}

TEST(HashBytes, MatchesXxhsum) {
  EXPECT_EQ(hash_bytes(""), 0x2d06800538d394c2u);  // XXH3-64 of nothing, from the library's own specification
  EXPECT_NE(hash_bytes("a"), hash_bytes("b"));
}

TEST(HashFile, AMissingFileIsAnError) {
  EXPECT_THROW(hash_file(test::scratch() / "absent"), Error);
  EXPECT_THROW(hash_file(test::scratch()), Error);
}

}  // namespace
}  // namespace sterna
