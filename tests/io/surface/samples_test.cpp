// The two-element samples of tests/data/shared: the same two surfaces in every format.
#include <cmath>
#include <sstream>

#include "io/file/format_table.h"
#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"

namespace sterna::test {
namespace {

struct Names {
  enum Kind { none, named, numbered } kind = none;
};

struct Sample {
  const char* ending;
  Names::Kind names;
  bool is_text;
  bool is_single = false;
};

constexpr Sample k_samples[] = {{".ascii.stl", Names::named, true},
                                {".bin.stl", Names::none, false, true},
                                {".bin_attr.stl", Names::none, false, true},
                                {".bin_solidheader.stl", Names::none, false, true},
                                {".obj", Names::named, true},
                                {".off", Names::none, true},
                                {"_tri.off", Names::none, true},
                                {".ascii.ply", Names::numbered, true},
                                {".bin.ply", Names::numbered, false},
                                {".v22.msh", Names::named, true},
                                {".v41.msh", Names::named, true},
                                {".su2", Names::named, true},
                                {".lb8.ugrid", Names::named, false},
                                {".b8.ugrid", Names::named, false},
                                {".lb8l.ugrid", Names::named, false},
                                {".ugrid", Names::named, true},
                                {".v22bin.msh", Names::named, false},
                                {".ascii.vtk", Names::numbered, true},
                                {".bin.vtk", Names::numbered, false},
                                {".v51.vtk", Names::numbered, true},
                                {".v51bin.vtk", Names::numbered, false},
                                {"_surf.vtk", Names::numbered, true},
                                {".ascii.vtu", Names::numbered, true},
                                {".b64.vtu", Names::numbered, true},
                                {".b64zlib.vtu", Names::numbered, true},
                                {".raw.vtu", Names::numbered, false},
                                {".raw32.vtu", Names::numbered, false},
                                {".rawzlib.vtu", Names::numbered, false},
                                {".small.nas", Names::numbered, true},
                                {".large.nas", Names::numbered, true},
                                {".tri", Names::numbered, true},
                                {".bin.tri", Names::numbered, false, true},
                                {".smesh", Names::numbered, true},
                                {"_plc.poly", Names::numbered, true}};

struct Body {
  const char* name;
  double volume;
  std::map<std::string, int> triangles;  ///< a quad counts twice
  std::map<std::string, int> numbered;
  int n_triangles;
  std::size_t n_points;
};

const Body k_bodies[] = {
    {"pt", 2.0 / 3.0, {{"wall", 1}, {"side", 6}, {"farfield", 3}}, {{"patch_1", 1}, {"patch_2", 6}, {"patch_3", 3}}, 10, 7},
    {"mix4", 1.0 + 1.0 / 3.0 + 0.65, {{"wall", 2}, {"symmetry", 3}, {"farfield", 15}}, {{"patch_1", 2}, {"patch_2", 3}, {"patch_3", 15}}, 20, 12}};

TEST(Samples, EveryFormatGivesTheSameSurface) {
  STERNA_NEEDS_SHARED_DATA();
  for (const Body& body : k_bodies) {
    for (const Sample& sample : k_samples) {
      const std::string file = std::string(body.name) + sample.ending;
      SCOPED_TRACE(file);
      std::vector<std::string> warnings;
      const SurfaceSoup soup = read_surface(shared_data() / "formats" / file, &warnings);
      EXPECT_EQ(soup.triangles.size(), static_cast<std::size_t>(body.n_triangles));
      EXPECT_EQ(soup.points.size(), file.ends_with(".stl") ? 3 * soup.triangles.size() : body.n_points);
      // 1e-6: single precision of coordinates near 1. The sign depends on the format: boundary faces of a volume mesh have different orientations.
      EXPECT_NEAR(std::abs(volume_of(soup)), body.volume, 1e-6);
      EXPECT_EQ(soup.single_precision, sample.is_single);
      EXPECT_EQ(soup.has_names, sample.names != Names::none);
      EXPECT_EQ(triangles_by_patch(soup), sample.names == Names::named      ? body.triangles
                                          : sample.names == Names::numbered ? body.numbered
                                                                            : (std::map<std::string, int>{{"", body.n_triangles}}));
      // A warning for TetGen files about data that surfaces do not have.
      std::erase_if(warnings, [](const std::string& text) { return text.find("points in regions") != std::string::npos; });
      EXPECT_TRUE(warnings.empty()) << warnings.front();
      EXPECT_EQ(soup.source, (shared_data() / "formats" / file).string());
    }
  }
}

TEST(Samples, GzipCrlfAndMissingLineEndChangeNothing) {
  STERNA_NEEDS_SHARED_DATA();
  const std::filesystem::path folder = scratch();
  for (const Body& body : k_bodies) {
    std::filesystem::copy_file(shared_data() / "formats" / (std::string(body.name) + ".mapbc"), folder / (std::string(body.name) + ".mapbc"));
    for (const Sample& sample : k_samples) {
      const std::string file = std::string(body.name) + sample.ending;
      SCOPED_TRACE(file);
      const SurfaceSoup soup = read_surface(shared_data() / "formats" / file);
      std::string content = bytes_of(shared_data() / "formats" / file);
      write_bytes(folder / (file + ".gz"), packed(content));
      expect_same_soup(read_surface(folder / (file + ".gz")), soup);
      write_bytes(folder / file, packed(content));  // compression is detected from the content, not from the name
      expect_same_soup(read_surface(folder / file), soup);
      if (!sample.is_text) continue;
      write_bytes(folder / file, with_crlf(content));
      expect_same_soup(read_surface(folder / file), soup);
      while (content.back() == '\n') content.pop_back();
      write_bytes(folder / file, content);
      expect_same_soup(read_surface(folder / file), soup);
    }
  }
}

TEST(Samples, OldSu2WithTrailingIndices) {
  STERNA_NEEDS_SHARED_DATA();
  expect_same_soup(read_surface(shared_data() / "formats" / "pt.legacyindex.su2"), read_surface(shared_data() / "formats" / "pt.su2"));
}

TEST(Samples, VariantsThatAreNotReadAreNamed) {
  STERNA_NEEDS_SHARED_DATA();
  try {
    read_surface(shared_data() / "formats" / "n0012_113-33.su2");
    ADD_FAILURE() << "a plane mesh was read";
  } catch (const Error& error) {
    EXPECT_EQ(to_string(error.code()), "unsupported_format") << error.what();
    EXPECT_NE(std::string(error.what()).find("NDIME= 2"), std::string::npos) << error.what();
  }
}

TEST(Samples, ZonesOfSu2AreJoined) {
  STERNA_NEEDS_SHARED_DATA();
  const SurfaceSoup soup = read_surface(shared_data() / "formats" / "two.multizone.su2");  // pt and mix4
  EXPECT_EQ(triangles_by_patch(soup), (std::map<std::string, int>{{"wall", 3}, {"side", 6}, {"symmetry", 3}, {"farfield", 18}}));
}

TEST(Samples, RealVolumeMeshesGiveTheirBoundary) {
  STERNA_NEEDS_SHARED_DATA();
  EXPECT_EQ(read_surface(shared_data() / "formats" / "sphere_mixed.1.lb8.ugrid").triangles.size(), 864u);  // number from tests/data/shared/README.md
  const SurfaceSoup brick = read_surface(shared_data() / "formats" / "mesh_brick_prism_ffd.su2");
  // Markers of 380, 380 and 780, 780 quads, 1482, 1482 triangles, according to the file.
  EXPECT_EQ(triangles_by_patch(brick), (std::map<std::string, int>{{"x_m", 760}, {"x_p", 760}, {"y_m", 1560}, {"y_p", 1560}, {"z_m", 1482}, {"z_p", 1482}}));
  EXPECT_EQ(brick.patch_names, (std::vector<std::string>{"x_m", "x_p", "y_m", "y_p", "z_m", "z_p"}));
}

TEST(Samples, RealSurfacesHaveTheirListedTriangleCounts) {
  STERNA_NEEDS_SHARED_DATA();
  // Rows of the README there: "| surfaces/clean/x.stl | ... | tri=880 |".
  std::istringstream rows(bytes_of(corpus() / "shared" / "README.md"));
  int n_read = 0;
  for (std::string row; std::getline(rows, row);) {
    const std::size_t count = row.find("tri=");
    if (!row.starts_with("| surfaces/") || count == std::string::npos) continue;
    const std::string file = row.substr(2, row.find(' ', 2) - 2);
    SCOPED_TRACE(file);
    try {
      io::format_of(file);
    } catch (const Error&) {
      continue;  // CGNS, Medit: covered by the tests of other readers
    }
    EXPECT_EQ(read_surface(shared_data() / file).triangles.size(), std::stoul(row.substr(count + 4)));
    ++n_read;
  }
  EXPECT_GE(n_read, 56);  // so that a change of the table cannot empty this test
}

}  // namespace
}  // namespace sterna::test
