// The z-buffer: covered pixels, occluded polygons, positions of lines.
#include "geom/draw/raster.h"
#include "tests/support/test_constants.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sterna::draw {
namespace {

using test::k_context;
constexpr Rgb k_red{200, 0, 0}, k_blue{0, 0, 200}, k_white{255, 255, 255};

/// Returns a camera that views from above. (0, 0) is the upper left corner of the picture, a metre is a pixel, y of the picture is -y.
Camera from_above() {
  Camera camera = camera_towards({0, 0, 1});
  camera.scale = 1.0;
  return camera;
}

void add(Polygons& polygons, std::initializer_list<Point> corners, Rgb color, bool has_edges = false) {
  polygons.corners.insert(polygons.corners.end(), corners);
  polygons.close({color, color, false, has_edges});
}

TEST(Raster, TrianglesThatShareEdgesCoverEveryPixelOnce) {
  // A triangle fan about a sample's middle, and edges along samples. Neither gaps may occur, where the background would show, nor double coverage, where the
  // second triangle would win if it were nearer.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(4.0, 28.0);
  for (int round = 0; round < 50; ++round) {
    const double x = round % 2 == 0 ? 16.5 : number(random), y = round % 2 == 0 ? -16.5 : -number(random);
    Polygons polygons;
    const std::vector<Point> border = {{0, 0, 0},    {16.5, 0, 0},         {32, 0, 0},  {32, -16.5, 0},
                                       {32, -32, 0}, {10.0 / 3.0, -32, 0}, {0, -32, 0}, {0, -10.0 / 3.0, 0}};
    for (std::size_t k = 0; k < border.size(); ++k) add(polygons, {{x, y, 0}, border[k], border[(k + 1) % border.size()]}, k_red);
    const Image image = rasterise(polygons, from_above(), {32, 32, false}, k_context);
    for (const Rgb& pixel : image.pixels) ASSERT_EQ(pixel, k_red) << round;
  }
}

TEST(Raster, HalfAPixelIsHalfCovered) {
  Polygons polygons;
  add(polygons, {{0, 0, 0}, {2.0 + 1.0 / 3.0, 0, 0}, {2.0 + 1.0 / 3.0, -4, 0}, {0, -4, 0}}, {0, 0, 0});
  const Image image = rasterise(polygons, from_above(), {4, 4, false}, k_context);
  EXPECT_EQ(image.at(1, 1), (Rgb{0, 0, 0}));
  EXPECT_EQ(image.at(2, 1), (Rgb{170, 170, 170}));  // one sample of three in a row
  EXPECT_EQ(image.at(3, 1), k_white);
}

TEST(Raster, TheNearerHidesTheFurtherWhateverTheirOrder) {
  for (const bool is_first : {true, false}) {
    Polygons polygons;
    const auto near = [&] { add(polygons, {{0, 0, 1}, {8, 0, 1}, {8, -8, 1}, {0, -8, 1}}, k_red); };
    if (is_first) near();
    add(polygons, {{0, 0, 0}, {16, 0, 0}, {16, -16, 0}, {0, -16, 0}}, k_blue);
    if (!is_first) near();
    const Image image = rasterise(polygons, from_above(), {16, 16, false}, k_context);
    EXPECT_EQ(image.at(4, 4), k_red);
    EXPECT_EQ(image.at(12, 12), k_blue);
  }
}

TEST(Raster, PolygonsCrossWhereTheyAreEquallyFar) {
  Polygons polygons;  // one polygon rises to the right, the other is level: the depth at the middle decides
  add(polygons, {{0, 0, -10}, {20, 0, 10}, {20, -20, 10}, {0, -20, -10}}, k_red);
  add(polygons, {{0, 0, 0}, {20, 0, 0}, {20, -20, 0}, {0, -20, 0}}, k_blue);
  const Image image = rasterise(polygons, from_above(), {20, 20, false}, k_context);
  EXPECT_EQ(image.at(8, 10), k_blue);
  EXPECT_EQ(image.at(11, 10), k_red);
}

TEST(Raster, LinesAreOnPolygonEdgesNotDiagonals) {
  Polygons polygons;
  add(polygons, {{8, -8, 0}, {56, -8, 0}, {56, -56, 0}, {8, -56, 0}}, k_red, true);
  const Image image = rasterise(polygons, from_above(), {64, 64, true, 2.0}, k_context);
  EXPECT_LT(image.at(8, 30).r, 130);   // the edge
  EXPECT_EQ(image.at(32, 32), k_red);  // the diagonals
  EXPECT_EQ(image.at(20, 20), k_red);
  EXPECT_EQ(image.at(4, 30), k_white);
  const Image without = rasterise(polygons, from_above(), {64, 64, false, 2.0}, k_context);
  EXPECT_EQ(without.at(8, 30), k_red);
}

TEST(Raster, LinesFadeWherePolygonsAreTooSmall) {
  Polygons polygons;
  for (int i = 0; i < 64; ++i) add(polygons, {{1.0 * i, 0, 0}, {i + 1.0, 0, 0}, {i + 1.0, -64, 0}, {1.0 * i, -64, 0}}, k_red, true);
  const Image image = rasterise(polygons, from_above(), {64, 64, true}, k_context);
  EXPECT_EQ(image.at(32, 32), k_red);
}

TEST(Raster, PerspectiveShrinksWithDistanceAndClipsBehindEye) {
  Camera camera = from_above();
  camera.distance = 10.0;
  camera.x = camera.y = 32.0;
  EXPECT_DOUBLE_EQ(camera.project({4, 0, 0}).x, 36.0);
  EXPECT_DOUBLE_EQ(camera.project({4, 0, -10}).x, 34.0);
  EXPECT_GT(camera.project({0, 0, 1}).depth, camera.project({0, 0, 0}).depth);
  Polygons polygons;  // from far below to behind the camera
  add(polygons, {{-1, 1, -30}, {1, 1, -30}, {1, 1, 30}, {-1, 1, 30}}, k_red);
  const Image image = rasterise(polygons, camera, {64, 64, false}, k_context);
  EXPECT_EQ(image.at(32, 5), k_red);
  EXPECT_EQ(image.at(32, 60), k_white);
}

TEST(Raster, FacesTowardsTheLightAreBrighter) {
  Polygons polygons;
  polygons.corners = {{0, 0, 0}, {8, 0, 0}, {8, -8, 0}, {0, -8, 0}, {8, 0, 0}, {16, 0, -30}, {16, -8, -30}, {8, -8, 0}};
  polygons.first = {0, 4, 8};
  polygons.styles.assign(2, {{160, 160, 160}, {160, 160, 160}, true, false});
  const Image image = rasterise(polygons, from_above(), {16, 8, false}, k_context);
  EXPECT_GT(image.at(4, 4).r, image.at(12, 4).r + 20);
}

TEST(Raster, BackAndFrontHaveTheirColours) {
  Polygons polygons;
  polygons.corners = {{0, 0, 0}, {0, -8, 0}, {8, -8, 0}, {8, 0, 0}};
  polygons.first = {0, 4};
  polygons.styles = {{k_red, k_blue, false, false}};
  EXPECT_EQ(rasterise(polygons, from_above(), {8, 8, false}, k_context).at(4, 4), k_red);  // counter-clockwise from above
  std::reverse(polygons.corners.begin(), polygons.corners.end());
  EXPECT_EQ(rasterise(polygons, from_above(), {8, 8, false}, k_context).at(4, 4), k_blue);
}

TEST(Raster, IsTheSameForAnyNumberOfThreads) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(0.0, 200.0);
  Polygons polygons;
  for (int i = 0; i < 20000; ++i) {
    const Point p{number(random), -number(random), number(random)};
    add(polygons, {p, p + Vec3{number(random) / 20, 0, 1}, p + Vec3{0, number(random) / 20, -1}},
        {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i / 7), 90}, true);
  }
  const Image one = rasterise(polygons, from_above(), {200, 200}, RunContext({.threads = 1}));
  for (const int threads : {2, 7}) EXPECT_EQ(rasterise(polygons, from_above(), {200, 200}, RunContext({.threads = threads})).pixels, one.pixels);
}

}  // namespace
}  // namespace sterna::draw
