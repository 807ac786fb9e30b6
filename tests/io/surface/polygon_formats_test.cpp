// OBJ, OFF and PLY: polygons by index.
#include <bit>
#include <cstdint>

#include "tests/io/surface/surface_tools.h"
#include "tests/support/data.h"

namespace sterna::test {
namespace {

const std::string k_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
void obj_refused(const std::string& content, const std::vector<std::string>& texts) { expect_refused("a.obj", content, ErrorCode::file_malformed, texts); }
void off_refused(const std::string& content, const std::vector<std::string>& texts) { expect_refused("a.off", content, ErrorCode::file_malformed, texts); }
void ply_refused(const std::string& content, const std::vector<std::string>& texts) { expect_refused("a.ply", content, ErrorCode::file_malformed, texts); }

double area_z(const SurfaceSoup& soup) {
  double area = 0.0;
  for (const auto& t : soup.triangles) area += 0.5 * cross(soup.points[t[1]] - soup.points[t[0]], soup.points[t[2]] - soup.points[t[0]]).z;
  return area;
}

TEST(SurfaceObj, SpellingsOfAFace) {
  const SurfaceSoup soup = read_surface_text("a.obj", k_square + "f 1 2 3 4\n");
  EXPECT_EQ(soup.triangles.size(), 2u);
  EXPECT_DOUBLE_EQ(area_z(soup), 1.0);
  EXPECT_FALSE(soup.has_names);
  for (const char* face :
       {"f -4 -3 -2 -1\n", "f 1/1 2/1 3/1 4/1\n", "f 1//1 2//1 3//1 4//1\n", "f 1/1/1 2/2/2 3/3/3 4/4/4 # comment\n", "f 1 2 \\\n 3 4\n", "fo 1 2 3 4\n"})
    expect_same_soup(read_surface_text("a.obj", k_square + face), soup);
  expect_same_soup(read_surface_text("a.obj", "f 1 2 3 4\n" + k_square), soup);  // positive numbers may come first
  expect_same_soup(read_surface_text("a.obj", "mtllib a.mtl\n" + replaced(k_square, "v 1 1 0", "v 1 1 0 1.0") + "vt 0 0\nvn 0 0 1\ns off\nl 1 2\nf 1 2 3 4\n"),
                   soup);
}

TEST(SurfaceObj, GroupsThenObjectsThenMaterialsNameThePatches) {
  const auto patches = [](const std::string& text) { return triangles_by_patch(read_surface_text("a.obj", k_square + text)); };
  using Patches = std::map<std::string, int>;
  EXPECT_EQ(patches("f 1 2 3\ng left wing\nf 1 3 4\ng\nf 1 2 4\n"), (Patches{{"default", 2}, {"left wing", 1}}));
  EXPECT_EQ(patches("g all\no a\nf 1 2 3\no b\nf 1 3 4\n"), (Patches{{"a", 1}, {"b", 1}}));
  EXPECT_EQ(patches("o all\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\nusemtl red\nf 1 2 4\n"), (Patches{{"red", 2}, {"blue", 1}}));
  EXPECT_EQ(patches("g all\no all2\nf 1 2 3\n"), (Patches{{"all", 1}}));
}

TEST(SurfaceObj, MistakesAreToldWithTheirLine) {
  obj_refused(k_square + "f 1 2 5\n", {"line 5", "vertex number 5", "4 vertices"});
  obj_refused(k_square + "f 1 2 0\n", {"line 5", "\"0\""});
  obj_refused(k_square + "f 1 2 -5\n", {"line 5", "-5", "only 4 vertices precede"});
  obj_refused(k_square + "f 1 2\n", {"line 5", "a face of 2 corners"});
  obj_refused(k_square + "f 1 2 3x\n", {"line 5", "\"3x\""});
  obj_refused(k_square + "face 1 2 3\n", {"line 5", "\"face\""});
  obj_refused("v 0 0\n", {"line 1", "end of the line"});
}

TEST(SurfaceOff, HandWrittenCase) {
  std::vector<std::string> warnings;
  const auto path = corpus() / "io" / "quad_and_pentagon.off";
  const SurfaceSoup soup = read_surface(path, &warnings);
  EXPECT_EQ(soup.triangles.size(), 5u);
  EXPECT_DOUBLE_EQ(area_z(soup), 3.5);  // the square 1, the pentagon 2.5 by the shoelace formula
  ASSERT_EQ(warnings.size(), 1u);       // the segment
  expect_same_soup(read_surface_text("a.off", with_crlf(bytes_of(path))), soup);
}

TEST(SurfaceOff, HeadersOfGeomview) {
  const std::string body = "3 1 0\n0 0 0\n2 0 0\n0 2 0\n3 0 1 2\n";
  const SurfaceSoup soup = read_surface_text("a.off", "OFF\n" + body);
  EXPECT_DOUBLE_EQ(area_z(soup), 2.0);
  expect_same_soup(read_surface_text("a.off", "OFF " + body), soup);
  expect_same_soup(read_surface_text("a.off", body), soup);
  expect_same_soup(read_surface_text("a.off", "\n# first\nOFF\n\n" + replaced(body, "3 1 0", "3 1")), soup);
  expect_same_soup(read_surface_text("a.off", "COFF\n3 1 0\n0 0 0 1 0 0 1\n2 0 0 1 0 0 1\n0 2 0 1 0 0 1\n3 0 1 2 4 1 0 0 1\n"), soup);
  expect_same_soup(read_surface_text("a.off", "NOFF\n3 1 0\n0 0 0 0 0 1\n2 0 0 0 0 1\n0 2 0 0 0 1\n3 0 1 2\n"), soup);
  expect_same_soup(read_surface_text("a.off", "4OFF\n3 1 0\n0 0 0 1\n1 0 0 0.5\n0 4 0 2\n3 0 1 2\n"), soup);
}

TEST(SurfaceOff, MistakesAreToldWithTheirLine) {
  const std::string whole = "OFF\n3 1 0\n0 0 0\n2 0 0\n0 2 0\n3 0 1 2\n";
  off_refused(replaced(whole, "3 0 1 2", "3 0 1 3"), {"line 6", "found 3", "0 to 2"});
  off_refused(replaced(whole, "3 0 1 2", "3 0 1"), {"end of the file"});
  off_refused(replaced(whole, "3 1 0", "3 2 0"), {"end of the file"});
  off_refused(replaced(whole, "3 1 0", "2 1 0"), {"line 6", "after the last of 1 faces"});  // the third vertex is read as a face without corners
  off_refused(replaced(whole, "3 1 0", "3000 1 0"), {"line 2", "3000", "cut short"});
  off_refused(replaced(whole, "OFF", "OOF"), {"line 1", "\"OOF\""});
  expect_refused("a.off", "nOFF\n3\n3 1 0\n", ErrorCode::unsupported_format, {"any dimension"});
}

const std::string k_ply =
    "ply\nformat ascii 1.0\ncomment x\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
    "element face 2\nproperty list uchar int vertex_indices\nproperty int patch\nend_header\n0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n3 0 1 2 7\n3 0 2 3 8\n";

TEST(SurfacePly, PropertiesBeyondTheSurfaceArePassedOver) {
  const SurfaceSoup soup = read_surface_text("a.ply", k_ply);
  EXPECT_DOUBLE_EQ(area_z(soup), 1.0);
  EXPECT_EQ(soup.patch_names, (std::vector<std::string>{"patch_7", "patch_8"}));
  EXPECT_TRUE(soup.single_precision);
  expect_same_soup(read_surface_text("a.ply", replaced(k_ply, "vertex_indices", "vertex_index")), soup);
  std::string camera = replaced(k_ply, "element vertex 4\n", "element camera 1\nproperty list int float view\nelement vertex 4\n");
  expect_same_soup(read_surface_text("a.ply", replaced(camera, "end_header\n", "end_header\n2 0.5 0.5\n")), soup);
  EXPECT_FALSE(read_surface_text("a.ply", replaced(k_ply, "property int patch", "property int other")).has_names);
}

TEST(SurfacePly, BytesOfEitherOrder) {
  const auto file = [](bool is_big) {
    std::string bytes = "ply\nformat binary_" + std::string(is_big ? "big" : "little") +
                        "_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar uint "
                        "vertex_indices\nend_header\n";
    const auto add = [&](std::uint32_t bits) {
      for (int i = 0; i < 4; ++i) bytes += static_cast<char>(bits >> (8 * (is_big ? 3 - i : i)) & 0xffu);
    };
    for (const float value : {0.f, 0.f, 0.f, 2.f, 0.f, 0.f, 0.f, 2.f, 0.f}) add(std::bit_cast<std::uint32_t>(value));
    bytes += '\3';
    for (const std::uint32_t corner : {0u, 1u, 2u}) add(corner);
    return bytes;
  };
  const SurfaceSoup soup = read_surface_text("a.ply", file(false));
  EXPECT_DOUBLE_EQ(area_z(soup), 2.0);
  expect_same_soup(read_surface_text("a.ply", file(true)), soup);
  std::string cut = file(true);
  cut.pop_back();
  ply_refused(cut, {"byte", "corner of a face"});
}

TEST(SurfacePly, MistakesAreToldWithTheirLine) {
  ply_refused(replaced(k_ply, "3 0 1 2 7", "3 0 1 4 7"), {"line 17", "found 4"});
  ply_refused(replaced(k_ply, "3 0 1 2 7", "3 0 -1 2 7"), {"line 17", "found -1"});
  ply_refused(replaced(k_ply, "element vertex 4", "element vertex 400"), {"400"});
  ply_refused(replaced(k_ply, "property float z\n", ""), {"no property \"z\""});
  ply_refused(replaced(k_ply, "float x", "half x"), {"line 5", "\"half\""});
  ply_refused(replaced(k_ply, "end_header\n", ""), {"line 12"});
  ply_refused(replaced(k_ply, "format ascii", "format utf8"), {"line 2", "\"utf8\""});
  ply_refused(k_ply + "3 0 1 2 7\n", {"line 19", "expected the end of the file"});
}

}  // namespace
}  // namespace sterna::test
