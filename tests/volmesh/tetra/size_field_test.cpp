#include "volmesh/tetra/size_field.h"

#include <gmock/gmock.h>
#include <algorithm>
#include <cmath>
#include <random>

#include "geom/base/error.h"
#include "tests/support/test_shapes.h"

namespace sterna::volmesh {
namespace {

/// A unit sphere within a farfield of radius 30; only points, as in the input of the size field.
struct Shells {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  void add(const TriMesh& mesh) {
    const auto shift = static_cast<std::uint32_t>(points.size());
    for (const Vec3& p : mesh.points) points.push_back(p);
    for (const TriangleVertices& v : mesh.triangles) triangles.push_back({v[0].value() + shift, v[1].value() + shift, v[2].value() + shift});
  }
  TetraBoundary boundary() const { return {points, triangles, {}}; }
};

Shells sphere_in_sphere(int f = 20) {
  Shells shells;
  shells.add(test::sphere(f));
  shells.add(test::sphere(4, 30.0));
  return shells;
}

/// Returns the geometric mean of the edges at each vertex, directly from its definition.
std::vector<double> vertex_sizes(const Shells& shells) {
  std::vector<double> logs(shells.points.size(), 0.0), counts(shells.points.size(), 0.0);
  for (const auto& t : shells.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      logs[t[k]] += std::log(distance(shells.points[t[k]], shells.points[t[(k + 1) % 3]]));
      counts[t[k]] += 1.0;
    }
  for (std::size_t i = 0; i < logs.size(); ++i) logs[i] = std::exp(logs[i] / counts[i]);
  return logs;
}

std::vector<Vec3> random_points(std::size_t n, double radius) {
  std::mt19937_64 random(7);
  std::vector<Vec3> points(n);
  const auto unit = [&] { return 2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0; };
  // Equal numbers of points in each shell of doubled radius, so that all sizes occur.
  for (Vec3& p : points) p = radius * std::exp2(-5.0 * std::abs(unit())) * normalized(Vec3{unit(), unit(), unit()});
  return points;
}

TEST(SizeField, IsBoundarySizeGrownWithDistance) {
  const Shells shells = sphere_in_sphere();
  const SizeField field = build_size_field(shells.boundary(), {}, {}, RunContext());
  const std::vector<double> sizes = vertex_sizes(shells);
  double worst = 0.0, sum = 0.0;
  int n = 0;
  for (const Vec3& p : random_points(2000, 30.0)) {
    if (norm(p) < 1.0) continue;
    double exact = 1e300;
    for (std::size_t i = 0; i < sizes.size(); ++i) exact = std::min(exact, sizes[i] + 0.3 * distance(p, shells.points[i]));
    const double error = std::abs(field(p) / exact - 1.0);
    worst = std::max(worst, error);
    sum += error;
    ++n;
  }
  // A leaf is at most twice its size long. Between its corners the field bends by at most slope * sqrt(3)/2 * 2 = 0.52 sizes, along a smooth wall by far less.
  EXPECT_LT(worst, 0.3);
  EXPECT_LT(sum / n, 0.03);
}

TEST(SizeField, GrowthLimitsTheGradient) {
  const Shells shells = sphere_in_sphere();
  const SizeField field = build_size_field(shells.boundary(), {}, {.size_growth = 1.2}, RunContext());
  const std::vector<Vec3> points = random_points(4000, 29.0);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    // Exact at corners, interpolated between them: both ends have the error of the test above.
    const double step = distance(points[i], points[i + 1]);
    EXPECT_LE(field(points[i + 1]), 1.12 * (field(points[i]) + 0.2 * step));
  }
}

TEST(SizeField, SourcesAreMetInsideAndGrowOutside) {
  const Shells shells = sphere_in_sphere(4);
  SizeSource box{.kind = SourceKind::box, .from = {5.0, -1.0, -1.0}, .to = {8.0, 1.0, 1.0}, .size = 0.1};
  SizeSource line{.kind = SourceKind::line, .from = {-8.0, 0.0, 0.0}, .to = {-5.0, 0.0, 0.0}, .radius = 0.5, .size = 0.05};
  SizeSource tiny{.kind = SourceKind::point, .from = {0.0, 12.0, 0.0}, .size = 1e-4};
  SizeSource ball{.kind = SourceKind::sphere, .from = {0.0, -12.0, 0.0}, .radius = 1.0, .size = 0.1};
  SizeSource drum{.kind = SourceKind::cylinder, .from = {0.0, 0.0, 10.0}, .to = {0.0, 0.0, 12.0}, .radius = 1.0, .size = 0.1};
  SizeSource samples{.kind = SourceKind::samples, .points = {{0.0, 0.0, -12.0}}, .sizes = {0.01}};
  const std::vector<SizeSource> sources = {box, line, tiny, ball, drum, samples};
  const SizeField field = build_size_field(shells.boundary(), sources, {}, RunContext());
  const auto expect_size = [&](const Vec3& p, double size) { EXPECT_NEAR(field(p) / size, 1.0, 0.1) << format_point(p); };
  expect_size({6.5, 0.0, 0.0}, 0.1);
  expect_size({9.0, 0.0, 0.0}, 0.4);
  expect_size({-6.5, 0.4, 0.0}, 0.05);
  expect_size({-6.5, 1.5, 0.0}, 0.35);
  expect_size({0.0, -12.9, 0.0}, 0.1);
  expect_size({0.0, -14.0, 0.0}, 0.4);
  expect_size({0.9, 0.0, 11.9}, 0.1);
  expect_size({3.0, 0.0, 11.0}, 0.7);
  expect_size({0.0, 0.0, -13.0}, 0.31);
  // The tip of the cone lies within a leaf of at most twice its size: it is never missed, and the field is never below the source.
  EXPECT_LT(field({0.0, 12.0, 0.0}), 4e-4);
  EXPECT_GE(field({0.0, 12.0, 0.0}), 1e-4);
  expect_size({0.0, 12.1, 0.0}, 0.0301);
}

TEST(SizeField, WakeFollowsItsEdgeAndGrowsDownstream) {
  const Shells shells = sphere_in_sphere(4);
  const SizeSource wake{
      .kind = SourceKind::wake, .from = {4.0, 0.0, 0.0}, .to = {6.0, 4.0, 0.0}, .length = 10.0, .height = 0.4, .spread = 0.1, .size = 0.1, .size_end = 0.3};
  const SizeField field = build_size_field(shells.boundary(), std::span(&wake, 1), {}, RunContext());
  EXPECT_NEAR(field({4.5, 0.1, 0.0}), 0.11, 0.02);
  EXPECT_NEAR(field({14.0, 0.5, 0.0}), 0.295, 0.02);
  EXPECT_NEAR(field({14.0, 0.5, 1.0}), 0.295, 0.03);  // half the height of the source is 0.2 + 0.1 * 9.75 there
  EXPECT_NEAR(field({6.0, 3.9, 0.0}), 0.1, 0.02);
  EXPECT_GT(field({4.5, 3.9, 0.0}), 0.3);  // upstream of the swept edge
}

TEST(SizeField, SizeMaxHoldsEverywhere) {
  const Shells shells = sphere_in_sphere(4);
  const SizeField field = build_size_field(shells.boundary(), {}, {.size_max = 2.0}, RunContext());
  EXPECT_LE(field.view().header().largest, 2.0);
  EXPECT_DOUBLE_EQ(field({20.0, 0.0, 0.0}), 2.0);
}

TEST(SizeField, IsTheSameForAnyNumberOfThreads) {
  const Shells shells = sphere_in_sphere(12);
  const SizeSource line{.kind = SourceKind::line, .from = {2.0, 0.0, 0.0}, .to = {9.0, 3.0, 1.0}, .radius = 0.1, .size = 0.03};
  std::vector<std::byte> first;
  for (const int threads : {1, 2, 7}) {
    const SizeField field = build_size_field(shells.boundary(), std::span(&line, 1), {}, RunContext({.threads = threads}));
    const std::vector<std::byte> bytes(field.bytes().begin(), field.bytes().end());
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << threads;
  }
}

TEST(SizeField, ItsBufferCanBeReadElsewhere) {
  const Shells shells = sphere_in_sphere(4);
  SizeField field = build_size_field(shells.boundary(), {}, {}, RunContext());
  std::vector<double> copy(field.bytes().size() / 8);
  std::memcpy(copy.data(), field.bytes().data(), field.bytes().size());
  const std::span<const std::byte> bytes = std::as_bytes(std::span(copy));
  const SizeFieldView view(bytes.data(), bytes.size());
  ASSERT_TRUE(view.is_valid());
  EXPECT_EQ(view(3.0, 4.0, 5.0), field({3.0, 4.0, 5.0}));
  EXPECT_EQ(view(1e9, 0.0, 0.0), view(31.0, 0.0, 0.0)) << "outside: the nearest place of the root";
  const SizeField moved = std::move(field);
  EXPECT_EQ(view(3.0, 4.0, 5.0), moved({3.0, 4.0, 5.0}));
  EXPECT_FALSE(SizeFieldView(bytes.data(), bytes.size() - 8).is_valid());
  copy[0] = 0.0;
  EXPECT_FALSE(SizeFieldView(bytes.data(), bytes.size()).is_valid());
}

TEST(SizeField, DoesNotDependOnUnitOrPlace) {
  Shells shells = sphere_in_sphere(6);
  const double before = build_size_field(shells.boundary(), {}, {}, RunContext())({3.0, 1.0, 2.0});
  for (Vec3& p : shells.points) p = 1024.0 * p + Vec3{1e5, 0.0, 0.0};
  const double after = build_size_field(shells.boundary(), {}, {}, RunContext())(1024.0 * Vec3{3.0, 1.0, 2.0} + Vec3{1e5, 0.0, 0.0});
  EXPECT_NEAR(after / 1024.0, before, 1e-6);  // values are floats
}

TEST(SizeField, RejectsInvalidSources) {
  const Shells shells = sphere_in_sphere(2);
  const auto message = [&](const SizeSource& source) -> std::string {
    try {
      build_size_field(shells.boundary(), std::span(&source, 1), {}, RunContext());
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message({.kind = SourceKind::box}), testing::HasSubstr("source 1 (box): size must be positive"));
  EXPECT_THAT(message({.kind = SourceKind::sphere, .size = 1.0}), testing::HasSubstr("a sphere needs a radius"));
  EXPECT_THAT(message({.kind = SourceKind::samples}), testing::HasSubstr("no samples"));
  EXPECT_THAT(message({.kind = SourceKind::wake, .to = {1.0, 0.0, 0.0}, .length = 1.0, .size = 1.0}), testing::HasSubstr("direction"));
  EXPECT_THAT(message({.kind = SourceKind::wake, .to = {0.0, 1.0, 0.0}, .length = 1.0, .size = 1.0, .size_end = 2.0}), testing::HasSubstr("growth"));
  const SizeSource huge{.kind = SourceKind::box, .from = {-30.0, -30.0, -30.0}, .to = {30.0, 30.0, 30.0}, .size = 1e-3};
  EXPECT_THAT(message(huge), testing::HasSubstr("more than"));
}

}  // namespace
}  // namespace sterna::volmesh
