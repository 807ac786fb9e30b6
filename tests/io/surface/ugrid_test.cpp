#include <cstdint>
#include <cstring>
#include <limits>
#include <tuple>

#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"

namespace sterna::test {
namespace {

/// Builds the bytes of a UGRID file with 32-bit or 64-bit integers, in either byte order.
class UgridBytes {
 public:
  UgridBytes(bool is_wide, bool is_big) : is_wide_(is_wide), is_big_(is_big) {}
  UgridBytes& integers(const std::vector<std::int64_t>& values) {
    for (const std::int64_t value : values) add(static_cast<std::uint64_t>(value), is_wide_ ? 8 : 4);
    return *this;
  }
  UgridBytes& reals(const std::vector<double>& values) {
    for (const double value : values) {
      std::uint64_t bits;
      std::memcpy(&bits, &value, sizeof bits);
      add(bits, 8);
    }
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void add(std::uint64_t value, int n) {
    for (int i = 0; i < n; ++i) bytes_ += static_cast<char>(value >> (8 * (is_big_ ? n - 1 - i : i)) & 0xffu);
  }
  bool is_wide_, is_big_;
  std::string bytes_;
};

/// Returns a tetrahedron: patch 5 with three triangles, patch 2 with one, and a fifth point that no face uses.
std::string tetrahedron(bool is_wide, bool is_big, std::int64_t last_corner = 4, double last_z = 1.0) {
  return UgridBytes(is_wide, is_big)
      .integers({5, 4, 0, 1, 0, 0, 0})
      .reals({9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, last_z})
      .integers({2, 4, 3, 2, 3, 5, 2, 5, 4, 3, last_corner, 5})
      .integers({5, 5, 5, 2})
      .integers({2, 3, 4, 5})
      .bytes();
}

TEST(SurfaceUgrid, EveryWidthAndByteOrder) {
  for (const auto& [name, is_wide, is_big] :
       {std::tuple{"t.lb8.ugrid", false, false}, {"t.b8.ugrid", false, true}, {"t.lb8l.ugrid", true, false}, {"T.B8L.UGRID", true, true}}) {
    SCOPED_TRACE(name);
    const SurfaceSoup soup = read_surface_text(name, tetrahedron(is_wide, is_big));
    EXPECT_NEAR(volume_of(soup), 1.0 / 6.0, 1e-15);
    EXPECT_EQ(soup.points.size(), 4u);
    EXPECT_EQ(soup.patch_names, (std::vector<std::string>{"patch_5", "patch_2"}));
    EXPECT_TRUE(soup.has_names);
  }
}

TEST(SurfaceUgrid, NamesOfTheMapbcBesideIt) {
  const std::filesystem::path folder = scratch();
  const auto names_with = [&](const char* mapbc, const char* text, const char* mesh) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    write_bytes(folder / mapbc, text);
    write_bytes(folder / mesh, tetrahedron(false, false));
    return read_surface(folder / mesh).patch_names;
  };
  const std::vector<std::string> named = {"wing", "far field"}, numbered = {"patch_5", "patch_2"};
  EXPECT_EQ(names_with("a.mapbc", "2\n2 5000 far field\n5 4000 wing\n", "a.lb8.ugrid"), named);
  EXPECT_EQ(names_with("a.lb8.mapbc", "2\r\n2 5000 far field\r\n5 4000 wing\r\n", "a.lb8.ugrid"), named);
  EXPECT_EQ(names_with("a.v2.mapbc", "2\n2 5000 far field\n5 4000 wing", "a.v2.lb8.ugrid.gz"), named);
  EXPECT_EQ(names_with("a.mapbc", "1\n5 4000 wing\n", "a.lb8.ugrid"), (std::vector<std::string>{"wing", "patch_2"}));
  EXPECT_EQ(names_with("a.mapbc", "2\n5 4000\n2 5000\n", "a.lb8.ugrid"), numbered);
  EXPECT_EQ(names_with("a.mapbc", "1\n5 4000 wing\n", "a.v2.lb8.ugrid"), numbered);  // belongs to another mesh
  EXPECT_EQ(names_with("a.mapbc", "2\n5 4000 wing\n2 4000 wing\n", "a.lb8.ugrid"), std::vector<std::string>{"wing"});
}

TEST(SurfaceUgrid, ADamagedMapbcIsAnError) {
  const std::filesystem::path folder = scratch();
  write_bytes(folder / "a.lb8.ugrid", tetrahedron(false, false));
  for (const auto& [text, where] :
       {std::pair{"2\n5 4000 wing\n", "end of the file"}, {"2\n5 wall wing\n2 5000 far\n", "line 2"}, {"-1\n", "line 1"}, {"names\n", "line 1"}}) {
    write_bytes(folder / "a.mapbc", text);
    try {
      read_surface(folder / "a.lb8.ugrid");
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(to_string(error.code()), "file_malformed");
      EXPECT_NE(std::string(error.what()).find("a.mapbc"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(where), std::string::npos) << error.what();
    }
  }
}

TEST(SurfaceUgrid, MistakesAreToldWithTheirByte) {
  const auto refused = [](const char* name, const std::string& bytes, const std::vector<std::string>& texts) {
    expect_refused(name, bytes, ErrorCode::file_malformed, texts);
  };
  const std::string whole = tetrahedron(false, false);
  refused("t.b8.ugrid", whole, {"byte 28", "coordinates of the points"});  // read in the other byte order: 83886080 points
  refused("t.lb8.ugrid", tetrahedron(false, false, 6), {"byte 192", "found point 6", "1 to 5"});
  refused("t.lb8.ugrid", tetrahedron(false, false, 0), {"byte 192", "found point 0"});
  refused("t.lb8l.ugrid", tetrahedron(true, false, -1), {"found point -1"});
  refused("t.lb8.ugrid", UgridBytes(false, false).integers({-1, 0, 0, 0, 0, 0, 0}).bytes(), {"found the count -1", "byte order"});
  refused("t.lb8.ugrid", whole.substr(0, 20), {"byte 0", "seven counts"});
  refused("t.lb8.ugrid", whole.substr(0, whole.size() - 1), {"volume cells of 4 corners", "cut short"});
  refused("t.lb8l.ugrid", UgridBytes(true, false).integers({std::int64_t{1} << 62, 1, 1, 1, 1, 1, 1}).bytes(), {"coordinates of the points"});
}

TEST(SurfaceUgrid, FortranRecordsAreNotRead) {
  expect_refused("t.r8.ugrid", tetrahedron(false, true), ErrorCode::unsupported_format, {"Fortran records (.r8.ugrid)", ".lb8.ugrid"});
}

TEST(SurfaceUgrid, WhatFollowsTheCellsIsNotLookedAt) {
  expect_same_soup(read_surface_text("t.lb8.ugrid", tetrahedron(false, false) + "more records"), read_surface_text("t.lb8.ugrid", tetrahedron(false, false)));
}

}  // namespace
}  // namespace sterna::test
