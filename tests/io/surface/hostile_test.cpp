// Damage to small files of every format: the reader returns a sound surface or throws sterna::Error; anything else ends the test program.
#include <unistd.h>

#include <algorithm>
#include <chrono>

#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"
#include "tests/support/reader_checks.h"

namespace sterna::test {
namespace {

/// Time limit per file. A file of one kilobyte takes far below a millisecond; the limit finds endless loops, also on a machine under load.
constexpr double k_longest_seconds = 5.0;

/// A folder in memory if the system has one, since these tests write some hundred thousand files; removed at the end.
class MemoryFolder {
 public:
  MemoryFolder() : path_(std::filesystem::is_directory("/dev/shm") ? "/dev/shm/sterna_test_" + std::to_string(getpid()) : scratch().string()) {
    std::filesystem::create_directories(path_);
  }
  ~MemoryFolder() {
    std::error_code ignored;  // a destructor must not throw; a few kB may remain in memory
    std::filesystem::remove_all(path_, ignored);
  }
  MemoryFolder(const MemoryFolder&) = delete;
  MemoryFolder& operator=(const MemoryFolder&) = delete;
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// Returns the small files of tests/data/io, and the samples of tests/data/shared.
std::vector<std::filesystem::path> victims() {
  constexpr std::uintmax_t k_small = 2500;
  std::vector<std::filesystem::path> files;
  const auto add = [&](const std::filesystem::path& folder, const std::vector<std::string>& starts) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      bool is_needed = entry.is_regular_file() && entry.file_size() <= k_small;
      is_needed = is_needed && std::any_of(starts.begin(), starts.end(), [&](const std::string& start) { return name.starts_with(start); });
      const auto ends = {".stl", ".obj", ".off",   ".ply",  ".msh", ".su2", ".ugrid", ".vtk", ".vtu", ".nas",
                         ".bdf", ".tri", ".smesh", ".poly", ".zml", ".wgs", ".fmt",   ".p3d", ".xyz"};
      if (is_needed && std::any_of(ends.begin(), ends.end(), [&](const char* end) { return name.ends_with(end); })) files.push_back(entry.path());
    }
  };
  add(corpus() / "io", {""});
  if (has_shared_data()) add(shared_data() / "formats", {"pt", "mix4."});
  EXPECT_GE(files.size(), 5u) << "the loops over them would test nothing";
  std::sort(files.begin(), files.end());
  return files;
}

/// \returns true if the file was read, false if it was refused
bool survive(const std::filesystem::path& path, const std::string& damage) {
  SCOPED_TRACE(path.filename().string() + ", " + damage);
  const auto start = std::chrono::steady_clock::now();
  bool is_read = false;
  try {
    read_surface(path);
    is_read = true;
  } catch (const Error& error) {
    // The damage may make a TetGen file refer to its .node file, which does not exist.
    const bool is_companion = error.code() == ErrorCode::file_not_found && std::string(error.what()).find(".node") != std::string::npos;
    EXPECT_TRUE(is_companion || error.code() == ErrorCode::file_malformed || error.code() == ErrorCode::unsupported_format) << error.what();
    EXPECT_TRUE(error.code() != ErrorCode::file_malformed || says_where(error, false)) << error.what();
    EXPECT_NE(std::string(error.what()).find(path.stem().string()), std::string::npos) << error.what();
  }
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), k_longest_seconds);
  return is_read;
}

TEST(Hostile, CutAtEveryByte) {
  const MemoryFolder folder;
  for (const std::filesystem::path& file : victims()) {
    const std::string content = bytes_of(file);
    for (std::size_t n = 0; n < content.size(); ++n) {
      write_bytes(folder / file.filename(), std::string_view(content).substr(0, n));
      survive(folder / file.filename(), "cut to " + std::to_string(n) + " bytes");
    }
  }
}

TEST(Hostile, EveryByteChanged) {
  const MemoryFolder folder;
  for (const std::filesystem::path& file : victims()) {
    if (file.filename().string().starts_with("mix4")) continue;  // similar contents in twice the bytes
    std::string content = bytes_of(file);
    constexpr std::size_t k_large = 600;  // in larger files, every third byte is sufficient
    const std::size_t step = content.size() > k_large ? 3 : 1;
    for (std::size_t i = 0; i < content.size(); i += step) {
      const char before = content[i];
      for (const int mask : {0x01, 0x80, 0xff}) {
        content[i] = static_cast<char>(before ^ mask);
        write_bytes(folder / file.filename(), content);
        survive(folder / file.filename(), "byte " + std::to_string(i) + " xor " + std::to_string(mask));
      }
      for (const char other : {'9', '-', '\n'}) {
        content[i] = other;
        write_bytes(folder / file.filename(), content);
        survive(folder / file.filename(), "byte " + std::to_string(i) + " = " + std::to_string(other));
      }
      content[i] = before;
    }
  }
}

TEST(Hostile, EveryNumberBecomesHuge) {
  const MemoryFolder folder;
  for (const std::filesystem::path& file : victims()) {
    const std::string content = bytes_of(file);
    if (content.find('\0') != std::string::npos || file.filename().string().starts_with("mix4")) continue;
    for (std::size_t begin = 0; begin < content.size();) {
      begin = content.find_first_of("0123456789", begin);
      if (begin == std::string::npos) break;
      const std::size_t end = std::min(content.find_first_not_of("0123456789", begin), content.size());
      for (const char* number : {"2147483648", "4294967296", "99999999999999", "-9223372036854775808", "9223372036854775807", "1e400", "nan"}) {
        write_bytes(folder / file.filename(), content.substr(0, begin) + number + content.substr(end));
        survive(folder / file.filename(), std::string(number) + " at byte " + std::to_string(begin));
      }
      begin = end;
    }
  }
}

TEST(Hostile, DamagedGzip) {
  const MemoryFolder folder;
  const std::filesystem::path path = folder / "cube.off.gz";
  std::string content = packed(bytes_of(corpus() / "io" / "quad_and_pentagon.off"));
  for (std::size_t n = 1; n < content.size(); ++n) {
    write_bytes(path, std::string_view(content).substr(0, n));
    EXPECT_FALSE(survive(path, "cut to " + std::to_string(n) + " bytes"));
  }
  for (std::size_t i = 0; i < content.size(); ++i) {
    content[i] = static_cast<char>(content[i] ^ 0x10);
    write_bytes(path, content);
    survive(path, "byte " + std::to_string(i));
    content[i] = static_cast<char>(content[i] ^ 0x10);
  }
}

TEST(Hostile, MissingFolderAndEmptyFile) {
  for (const char* name :
       {"a.stl", "a.obj", "a.off", "a.ply", "a.msh", "a.su2", "a.lb8.ugrid", "a.vtk", "a.vtp", "a.nas", "a.tri", "a.smesh", "a.zml", "a.wgs", "a.fmt"}) {
    const std::filesystem::path folder = scratch();
    const auto code_of = [&] {
      try {
        read_surface(folder / name);
      } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find((folder / name).string()), std::string::npos) << error.what();
        return std::string(to_string(error.code()));
      }
      return std::string("read");
    };
    EXPECT_EQ(code_of(), "file_not_found");
    write_bytes(folder / name, "");
    EXPECT_EQ(code_of(), "file_malformed");
    std::filesystem::remove(folder / name);
    std::filesystem::create_directory(folder / name);
    EXPECT_EQ(code_of(), "file_not_found");
  }
}

TEST(Hostile, UnknownExtensionNamesTheKnownOnes) {
  expect_refused("wing.xyzzy", "anything", ErrorCode::unsupported_format, {"wing.xyzzy", ".stl", ".su2", ".lb8.ugrid"});
}

}  // namespace
}  // namespace sterna::test
