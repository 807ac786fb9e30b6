// Coordinates that are nan or infinite: surface readers of every format leave out the polygons that use them, and count these polygons.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "io/file/format_table.h"
#include "io/file/surface_file.h"
#include "io/file/volume_file.h"
#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"

namespace sterna::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// A coordinate used by no other vertex; exact in single precision.
constexpr double k_planted = 0.8125;

/// Returns eight triangles; four of them use the vertex with the planted coordinate.
TriMesh octahedron() {
  TriMesh mesh;
  mesh.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, k_planted}, {0, 0, -1}};
  for (const auto& t : {std::array{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}) {
    mesh.triangles.push_back(
        {VertexId(static_cast<std::uint32_t>(t[0])), VertexId(static_cast<std::uint32_t>(t[1])), VertexId(static_cast<std::uint32_t>(t[2]))});
    mesh.triangle_patch.push_back(PatchId(0));
  }
  mesh.patches = {{"body"}};
  return mesh;
}

template <class Real>
std::string real_bytes(double value, std::endian order) {
  std::string bytes(sizeof(Real), '\0');
  const Real real = static_cast<Real>(value);
  std::memcpy(bytes.data(), &real, sizeof real);
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// Replaces the planted coordinate in any spelling. \returns the number of replacements
int plant(std::string& content, double value) {
  const std::string word = std::isnan(value) ? "nan" : value < 0.0 ? "-inf" : "inf";
  std::vector<std::pair<std::string, std::string>> spellings = {{"0.8125", word}, {"8.125e-01", word}, {"8.125E-1", word}};
  if (content.find('\0') == std::string::npos) spellings.push_back({".8125", word});
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    spellings.emplace_back(real_bytes<double>(k_planted, order), real_bytes<double>(value, order));
    spellings.emplace_back(real_bytes<float>(k_planted, order), real_bytes<float>(value, order));
  }
  int n = 0;
  for (const auto& [from, to] : spellings)
    for (std::size_t at = 0; n < 100 && (at = content.find(from, at)) != std::string::npos; at += to.size(), ++n) content.replace(at, from.size(), to);
  return n;
}

TEST(NotFinite, EveryFormatOmitsAndCountsPolygons) {
  int n_formats = 0;
  for (const io::Format& format : io::formats()) {
    if (!format.write_surface || format.name == "sterna" ||
        !io::format_of("a" + std::string(format.extensions.substr(0, format.extensions.find(' ')))).read_surface)
      continue;
    const std::string extension(format.extensions.substr(0, format.extensions.find(' ')));
    SCOPED_TRACE(std::string(format.name) + " " + extension);
    const auto path = scratch() / ("octahedron" + extension);
    for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
      io::write_surface_file(octahedron(), path, RunContext({.threads = 1}), format.name);
      std::string content = bytes_of(path);
      if (plant(content, value) == 0) continue;  // coordinates are compressed
      write_bytes(path, content);
      std::vector<std::string> warnings;
      const SurfaceSoup soup = read_surface(path, &warnings);
      EXPECT_EQ(soup.triangles.size(), 4u);
      EXPECT_THAT(warnings, testing::Contains(AllOf(HasSubstr("4 polygons have a corner whose coordinates are nan or infinite"), HasSubstr("of 8, beside ("))));
      ++n_formats;
    }
  }
  EXPECT_GE(n_formats, 3 * 15);
}

TEST(NotFinite, AQuadrilateralIsLeftOutAsAWhole) {
  std::vector<std::string> warnings;
  const SurfaceSoup soup = read_surface_text("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 nan 0\nf 1 2 3 4\nf 2 5 6 3\n", &warnings);
  EXPECT_EQ(soup.triangles.size(), 2u);
  EXPECT_EQ(soup.points.size(), 4u);
  EXPECT_THAT(warnings, ElementsAre(AllOf(HasSubstr("1 polygons"), HasSubstr("polygon 2 of 2, beside (1, 0, 0)"))));
}

TEST(NotFinite, MicrosoftsSpellingsAreNoCommentsAndNoNumbers) {
  for (const char* word : {"1.#QNAN", "-1.#IND", "1.#INF", "1e999", "-nan(ind)"}) {
    SCOPED_TRACE(word);
    std::vector<std::string> warnings;
    const SurfaceSoup soup = read_surface_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 " + std::string(word) + "\nf 1 2 3\nf 1 2 4\n", &warnings);
    EXPECT_EQ(soup.triangles.size(), 1u);
    EXPECT_EQ(warnings.size(), 1u);
  }
}

TEST(NotFinite, VolumeMeshesWithSuchNodesAreRefused) {
  const auto path = scratch() / "a.su2";
  write_bytes(path, "NDIME= 3\nNELEM= 1\n10 0 1 2 3\nNPOIN= 4\n0 0 0\n1 0 0\n0 1 0\n0 0 nan\nNMARK= 0\n");
  expect_error(ErrorCode::file_malformed, "nan", [&] { io::read_volume_file(path, RunContext({.threads = 1})); });
}

}  // namespace
}  // namespace sterna::test
