// Invalid but well-formed content in a file of every writer: a coordinate that is not a number, a truncated file of half the length. Each file is refused with
// its name and a location, and never read as something else.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <set>

#include "io/container/chunked_file.h"
#include "io/file/format_table.h"
#include "io/input/byte_reader.h"
#include "io/input/text_scanner.h"
#include "io/output/cell_sections.h"
#include "io/output/face_connectivity.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/reader_checks.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"

namespace sterna::io {
namespace {

constexpr double k_mark = 0.785398163397448279;  // a coordinate that can be found again in the bytes of a file
using test::k_context;

// Readers and views refer to what they read, so they cannot be made of a temporary.
static_assert(std::is_constructible_v<TextScanner, FileBuffer&> && !std::is_constructible_v<TextScanner, FileBuffer>);
static_assert(std::is_constructible_v<ByteReader, FileBuffer&> && !std::is_constructible_v<ByteReader, FileBuffer>);
static_assert(std::is_constructible_v<ChunkedReader, FileBuffer&> && !std::is_constructible_v<ChunkedReader, FileBuffer>);
static_assert(std::is_constructible_v<CellSections, HybridMesh&> && !std::is_constructible_v<CellSections, HybridMesh>);
static_assert(std::is_constructible_v<MeshFaces, HybridMesh&, RunContext> && !std::is_constructible_v<MeshFaces, HybridMesh, RunContext>);

/// Formats and extensions, for messages.
struct Case {
  const Format* format;
  bool is_volume;
  std::string extension;
  std::string name() const { return std::string(format->name) + (is_volume ? " volume " : " surface ") + extension; }
};

/// Returns every extension of formats that are both written and read. Folders (OpenFOAM) are not files.
std::vector<Case> cases() {
  std::vector<Case> result;
  for (const Format& format : formats()) {
    std::string_view rest = format.extensions;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      const std::string extension(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
      if (format.name == "OpenFOAM" || format.name == "Cart3D binary") continue;
      if (format.write_volume && format.read_volume) result.push_back({&format, true, extension});
      if (format.write_surface && format.read_surface) result.push_back({&format, false, extension});
    }
  }
  return result;
}

std::filesystem::path write_case(const Case& c) {
  const auto path = test::scratch() / ("victim" + c.extension);
  if (c.is_volume) {
    HybridMesh mesh = test::hexahedron_with_roof();
    for (Point& p : mesh.points.raw())
      if (p.x == 0.5) p.x = k_mark;
    c.format->write_volume(mesh, path, k_context);
  } else {
    TriMesh mesh = test::cube();
    for (Point& p : mesh.points.raw())
      if (p.x == 1.0) p.x = k_mark;
    c.format->write_surface(mesh, path, k_context);
  }
  return path;
}

void read_case(const Case& c, const std::filesystem::path& path) {
  if (c.is_volume) EXPECT_EQ(test::flaw_of(c.format->read_volume(path, k_context)), "");
  else EXPECT_EQ(test::flaw_of(c.format->read_surface(path, k_context)), "");
}

void expect_refused(const Case& c, const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
  try {
    read_case(c, path);
    ADD_FAILURE() << "it was read";
  } catch (const Error& error) {
    const std::string text = error.what();
    const bool is_container = c.format->name == "CGNS" || c.format->name == "TAU" || c.format->name == "VTKHDF";
    EXPECT_EQ(to_string(error.code()), to_string(ErrorCode::file_malformed)) << text;
    EXPECT_NE(text.find(path.string()), std::string::npos) << text;
    EXPECT_TRUE(test::says_where(error, is_container)) << text;
  }
}

/// Checks that surface polygons whose corners are not numbers are left out (NotFinite.*); a format without polygons of its own refuses the file.
void expect_sound_or_refused(const Case& c, const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
  try {
    read_case(c, path);
  } catch (const Error& error) {
    EXPECT_EQ(to_string(error.code()), to_string(ErrorCode::file_malformed)) << error.what();
  }
}

template <class T>
std::string pattern_of(T value, std::endian order) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// Replaces the mark in any spelling used by the file. \returns true if it was found
bool replace_mark(std::string& bytes, double by) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const auto replace = [&](const std::string& from, const std::string& to) {
      const std::size_t at = bytes.find(from);
      if (at != std::string::npos) bytes.replace(at, from.size(), to);
      return at != std::string::npos;
    };
    if (replace(pattern_of(k_mark, order), pattern_of(by, order))) return true;
    if (replace(pattern_of(static_cast<float>(k_mark), order), pattern_of(static_cast<float>(by), order))) return true;
  }
  for (const char* const digits : {"0.785398", "7.85398", ".785398"}) {
    const std::size_t at = bytes.find(digits);
    if (at == std::string::npos) continue;
    const std::size_t end = std::min(bytes.find_first_of(" \t\r\n<*", at), bytes.size());
    std::string word = std::isnan(by) ? "nan" : "inf";
    word.resize(std::max(word.size(), end - at), ' ');  // Nastran has fixed columns
    bytes.replace(at, end - at, word);
    return true;
  }
  return false;
}

TEST(Strict, CoordinatesThatAreNoNumbers) {
  std::set<std::string> packed;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name());
    const auto path = write_case(c);
    const std::string good = test::bytes_of(path);
    read_case(c, path);
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
      std::string bytes = good;
      if (!replace_mark(bytes, value)) packed.insert(c.extension);
      else if (c.is_volume) expect_refused(c, path, bytes);
      else expect_sound_or_refused(c, path, bytes);
    }
  }
  EXPECT_EQ(packed, (std::set<std::string>{".sterna", ".vtp", ".vtu"}));  // LZ4 or zlib data: covered by the fuzzers
}

TEST(Strict, HalfAFile) {
  for (const Case& c : cases()) {
    if (c.format->name == "OBJ") continue;     // has neither counts nor an end mark: half of the file is a smaller valid file
    if (c.extension == ".adf.cgns") continue;  // ends in free space, which may be truncated
    SCOPED_TRACE(c.name());
    const auto path = write_case(c);
    const std::string good = test::bytes_of(path);
    for (const double share : {0.25, 0.5, 0.75, 0.9}) {
      SCOPED_TRACE(share);
      expect_refused(c, path, good.substr(0, static_cast<std::size_t>(share * static_cast<double>(good.size()))));
    }
  }
}

}  // namespace
}  // namespace sterna::io
