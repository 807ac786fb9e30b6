#include "geom/base/hash.h"

#include <fstream>

#include "geom/base/error.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"

namespace sterna {
namespace {

TEST(HashFile, MatchesXxhsumAndSeesEveryByte) {
  const auto path = test::scratch() / "file";
  std::ofstream(path) << "";
  EXPECT_EQ(hash_file(path), "99aa06d3014798d86001c324468d497f");  // XXH3-128 of empty input, from the library's specification
  std::string text(3'000'000, 'x');
  std::ofstream(path) << text;
  const std::string before = hash_file(path);
  EXPECT_EQ(hash_file(path), before);
  text[2'500'000] = 'y';
  std::ofstream(path) << text;
  EXPECT_NE(hash_file(path), before);
}

TEST(HashFile, SeveralFilesGiveHashOfTheirList) {
  const auto folder = test::scratch();
  std::ofstream(folder / "a") << "";
  std::ofstream(folder / "b") << "";
  const std::string empty = "99aa06d3014798d86001c324468d497f";
  std::ofstream(folder / "list") << empty << "  a\n" << empty << "  b\n";  // the output of `xxhsum -H2 a b`
  const std::vector<std::filesystem::path> files{folder / "a", folder / "b"}, turned{folder / "b", folder / "a"};
  EXPECT_EQ(hash_files(files), hash_file(folder / "list"));
  EXPECT_NE(hash_files(turned), hash_files(files));
}

TEST(HashBytes, MatchesXxhsum) {
  EXPECT_EQ(hash_bytes(""), 0x2d06800538d394c2u);  // XXH3-64 of empty input, from the library's specification
  EXPECT_NE(hash_bytes("a"), hash_bytes("b"));
}

TEST(HashFile, AMissingFileIsAnError) {
  const auto message = [](const std::filesystem::path& path) {
    try {
      return hash_file(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::file_not_found);
      return std::string(error.what());
    }
  };
  const auto folder = test::scratch();
  EXPECT_NE(message(folder / "absent").find("No such file or directory"), std::string::npos) << message(folder / "absent");
  EXPECT_NE(message(folder).find("this is a folder"), std::string::npos) << message(folder);
}

TEST(HashFile, UnreadableFileGivesReason) {
  // This file opens normally, but reading its start fails.
  test::expect_error(ErrorCode::file_malformed, "/proc/self/mem: reading failed half-way: Input/output error", [&] { (void)hash_file("/proc/self/mem"); });
}

}  // namespace
}  // namespace sterna
