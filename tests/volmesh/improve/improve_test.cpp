#include "volmesh/improve/improve.h"

#include <gmock/gmock.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>

#include "geom/math/measures.h"
#include "geom/math/predicates.h"
#include "geom/mesh/computed_volumes.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/improve/forcing.h"
#include "volmesh/improve/improver.h"
#include "volmesh/improve/region.h"
#include "volmesh/improve/tet_quality.h"
#include "volmesh/tetra/verify.h"

namespace sterna::volmesh {
namespace {

using test::k_degree;

/// A domain with tetrahedra in it, which owns its points.
struct Filled {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Vec3> holes;
  TetraResult tets;
  TetraBoundary boundary() const { return {points, triangles, holes}; }
  void add(const TriMesh& mesh, bool is_outer) {
    const auto shift = static_cast<std::uint32_t>(points.size());
    for (const Vec3& p : mesh.points) points.push_back(p);
    for (const TriangleVertices& v : mesh.triangles) {
      triangles.push_back({v[0].value() + shift, v[1].value() + shift, v[2].value() + shift});
      if (is_outer) std::swap(triangles.back()[1], triangles.back()[2]);
    }
  }
  Vec3 location(std::uint32_t v) const { return v < points.size() ? points[v] : tets.new_points[v - points.size()]; }
  std::array<Vec3, 4> corners(std::size_t t) const {
    const auto& c = tets.tetrahedra[t];
    return {location(c[0]), location(c[1]), location(c[2]), location(c[3])};
  }
  double volume() const {
    double sum = 0.0;
    for (std::size_t t = 0; t < tets.tetrahedra.size(); ++t) {
      const auto p = corners(t);
      sum += tet_volume(p[0], p[1], p[2], p[3]);
    }
    return sum;
  }
  double worst(double obtuse_weight) const {
    double worst = 1.0;
    for (std::size_t t = 0; t < tets.tetrahedra.size(); ++t) {
      const auto p = corners(t);
      worst = std::min(worst, tet_quality(p[0], p[1], p[2], p[3], obtuse_weight));
    }
    return worst;
  }
};

/// A spherical shell, filled by TetGen with the poorest quality that its radius-edge ratio allows.
Filled shell(int f, double radius_edge) {
  Filled filled;
  filled.add(test::sphere(f), false);
  filled.add(test::sphere(4, 8.0), true);
  filled.holes = {{0.0, 0.0, 0.0}};
  filled.tets = fill(filled.boundary(), nullptr, {.engine = "tetgen", .radius_edge = radius_edge}, RunContext());
  return filled;
}

/// A cube with six tetrahedra per cell; inner vertices are displaced randomly by a share of the cell.
Filled shaken_cube(int n, double shake) {
  Filled filled;
  filled.add(test::cube(n), true);
  std::map<std::array<int, 3>, std::uint32_t> number;
  for (std::uint32_t v = 0; v < filled.points.size(); ++v) {
    const Vec3& p = filled.points[v];
    number[{static_cast<int>(std::lround(p.x * n)), static_cast<int>(std::lround(p.y * n)), static_cast<int>(std::lround(p.z * n))}] = v;
  }
  std::mt19937_64 random(3);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5; };
  const auto vertex = [&](int i, int j, int k) {
    const auto [it, is_new] = number.try_emplace({i, j, k}, static_cast<std::uint32_t>(filled.points.size() + filled.tets.new_points.size()));
    if (is_new) filled.tets.new_points.push_back((Vec3{i + shake * unit(), j + shake * unit(), k + shake * unit()}) / n);
    return it->second;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        std::array<int, 3> axes = {0, 1, 2};
        do {  // Kuhn's subdivision: one path from corner to corner for each order of the axes
          std::array<int, 3> at = {i, j, k};
          std::array<std::uint32_t, 4> c{};
          c[0] = vertex(at[0], at[1], at[2]);
          for (std::size_t s = 0; s < 3; ++s) {
            ++at[static_cast<std::size_t>(axes[s])];
            c[s + 1] = vertex(at[0], at[1], at[2]);
          }
          if (orient3d(filled.location(c[0]), filled.location(c[1]), filled.location(c[2]), filled.location(c[3])) < 0) std::swap(c[2], c[3]);
          filled.tets.tetrahedra.push_back(c);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
  // The triangles of the cube are faces of the tetrahedra.
  std::map<std::array<std::uint32_t, 3>, std::pair<int, std::array<std::uint32_t, 3>>> faces;
  constexpr std::uint8_t k_faces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  for (const auto& c : filled.tets.tetrahedra)
    for (const auto& f : k_faces) {
      const std::array<std::uint32_t, 3> face = {c[f[0]], c[f[1]], c[f[2]]};
      std::array<std::uint32_t, 3> key = face;
      std::sort(key.begin(), key.end());
      auto& entry = faces[key];
      ++entry.first;
      entry.second = face;
    }
  filled.triangles.clear();
  for (const auto& [key, entry] : faces)
    if (entry.first == 1) filled.triangles.push_back(entry.second);
  return filled;
}

void expect_improved(Filled filled, const ImproveOptions& options, double bad_share_left) {
  ASSERT_NO_THROW(verify_tetrahedra(filled.boundary(), filled.tets, RunContext()));
  const double weight = quality_limits(options.improve_min_angle, options.improve_max_angle).obtuse_weight;
  const double volume = filled.volume(), worst = filled.worst(weight);
  const ImproveReport report = improve_tetrahedra(filled.boundary(), filled.tets, options, RunContext());
  EXPECT_NO_THROW(verify_tetrahedra(filled.boundary(), filled.tets, RunContext()));
  EXPECT_NEAR(filled.volume(), volume, 1e-12 * volume);
  EXPECT_GE(filled.worst(weight), worst);
  EXPECT_GT(report.n_bad_before, 0);
  EXPECT_LE(static_cast<double>(report.n_bad_after), bad_share_left * static_cast<double>(report.n_bad_before));
  EXPECT_EQ(report.n_bad_free_after, 0);
  EXPECT_EQ(static_cast<std::int64_t>(report.remaining.size()), report.n_bad_after);
  EXPECT_LE(report.n_forced, report.n_bad_after);
  // The report matches the mesh.
  std::int64_t n_bad = 0;
  double low = 4.0, high = 0.0;
  for (std::size_t t = 0; t < filled.tets.tetrahedra.size(); ++t) {
    const auto [min, max] = tet_dihedral_range(filled.corners(t));
    n_bad += min < options.improve_min_angle || max > options.improve_max_angle;
    low = std::min(low, min);
    high = std::max(high, max);
  }
  EXPECT_EQ(report.n_bad_after, n_bad);
  EXPECT_NEAR(report.min_angle_after, low, 1e-6);
  EXPECT_NEAR(report.max_angle_after, high, 1e-6);
}

/// Smallest volume in double precision, divided by the largest product of three edges at a corner.
double least_relative_volume(const Filled& filled) {
  double least = 1.0;
  for (std::size_t t = 0; t < filled.tets.tetrahedra.size(); ++t) least = std::min(least, least_computed_jacobian(CellKind::tetrahedron, filled.corners(t)));
  return least;
}

/// Moves an inner vertex to within 1e-15 of the opposite face of one tetrahedron, such that all others around the vertex stay positive. Returns false if there
/// is no such vertex.
bool flatten_one(Filled& filled) {
  const auto n_fixed = static_cast<std::uint32_t>(filled.points.size());
  for (const auto& tet : filled.tets.tetrahedra)
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t v = tet[k];
      if (v < n_fixed) continue;
      Vec3& location = filled.tets.new_points[v - n_fixed];
      const Vec3 before = location;
      const Vec3 a = filled.location(tet[(k + 1) % 4]), b = filled.location(tet[(k + 2) % 4]), c = filled.location(tet[(k + 3) % 4]);
      const Vec3 normal = normalized(cross(b - a, c - a));
      const double height = dot(location - a, normal);
      location -= (height - std::copysign(1e-15, height)) * normal;
      const bool is_positive = std::ranges::all_of(filled.tets.tetrahedra, [&](const auto& other) {
        return std::ranges::find(other, v) == other.end() ||
               orient3d(filled.location(other[0]), filled.location(other[1]), filled.location(other[2]), filled.location(other[3])) > 0;
      });
      if (is_positive && least_relative_volume(filled) < k_solver_margin) return true;
      location = before;
    }
  return false;
}

TEST(Improve, RepairsVolumesWithinRoundingOfDoublePrecision) {
  Filled filled = shaken_cube(3, 0.3);
  ASSERT_TRUE(flatten_one(filled));
  improve_tetrahedra(filled.boundary(), filled.tets, {}, RunContext());
  EXPECT_GT(least_relative_volume(filled), 1e3 * k_solver_margin);
  // A thin tetrahedron has good angles, but too little volume for a solver.
  EXPECT_LT(tet_quality({0, 0, 0}, {1, 0, 0}, {1, 1e-8, 0}, {1, 0.5e-8, 0.8e-8}, 1.0), k_solver_margin);
  EXPECT_GT(tet_quality({0, 0, 0}, {1, 0, 0}, {1, 1e-4, 0}, {1, 0.5e-4, 0.8e-4}, 1.0), 0.1);
}

TEST(TetQuality, IsTheSmallestWeightedSine) {
  std::mt19937_64 random(1);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  int n_positive = 0;
  for (int i = 0; i < 1000; ++i) {
    std::array<Vec3, 4> p;
    for (Vec3& x : p) x = {unit(), unit(), unit()};
    const double quality = tet_quality(p[0], p[1], p[2], p[3], 0.6);
    if (tet_volume(p[0], p[1], p[2], p[3]) <= 0.0) {
      EXPECT_EQ(quality, -1.0);
      continue;
    }
    ++n_positive;
    // The smallest sine belongs to the largest obtuse or to the smallest acute angle.
    const auto [min, max] = tet_dihedral_range(p);
    const double expected = std::min(min > std::numbers::pi / 2 ? 1.0 : std::sin(min), max > std::numbers::pi / 2 ? 0.6 * std::sin(max) : 1.0);
    if (max > std::numbers::pi / 2) {
      EXPECT_NEAR(quality, expected, 1e-9);
    }
    const auto [of_smallest, of_largest] = dihedral_cosines(p[0], p[1], p[2], p[3]);
    EXPECT_NEAR(std::acos(of_smallest), min, 1e-6);
    EXPECT_NEAR(std::acos(of_largest), max, 1e-6);
  }
  EXPECT_GT(n_positive, 300);
  const double regular = tet_quality({1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}, 1.0);
  EXPECT_NEAR(regular, std::sqrt(8.0) / 3.0, 1e-12);
}

TEST(TetQuality, BothLimitsAreOneThreshold) {
  const QualityLimits limits = quality_limits(12 * k_degree, 160 * k_degree);
  // Wedges about the z axis with a given angle there; the other angles are uncritical.
  const auto wedge = [&](double angle) {
    return tet_quality({0, 0, -0.5}, {0, 0, 0.5}, {1, 0, 0}, {std::cos(angle), std::sin(angle), 0}, limits.obtuse_weight);
  };
  EXPECT_NEAR(wedge(12 * k_degree), limits.target, 1e-12);
  EXPECT_NEAR(wedge(160 * k_degree), limits.target, 1e-12);
  EXPECT_LT(wedge(11 * k_degree), limits.target);
  EXPECT_GT(wedge(100 * k_degree), limits.target);
  // Hard limits are 5 and 170 degrees.
  EXPECT_LT(wedge(4.9 * k_degree), limits.hard);
  EXPECT_LT(wedge(170.1 * k_degree), limits.hard);
  EXPECT_GT(wedge(165 * k_degree), limits.hard);
  EXPECT_LE(quality_limits(3 * k_degree, 175 * k_degree).hard, std::sin(3 * k_degree));
}

/// Returns tetrahedra around the edge 0-1 with a ring of n vertices.
std::vector<Region::Corners> around_edge(int n) {
  std::vector<Region::Corners> tets;
  for (int i = 0; i < n; ++i) tets.push_back({0, 1, static_cast<std::uint32_t>(2 + i), static_cast<std::uint32_t>(2 + (i + 1) % n)});
  return tets;
}

bool improve_all(Region& region) {
  std::vector<std::uint32_t> all(region.tets().size());
  std::iota(all.begin(), all.end(), 0u);
  return region.improve(all, std::vector<std::uint8_t>(all.size(), 0));
}

double region_volume(const Region& region) {
  double sum = 0.0;
  for (const Region::Tet& t : region.tets())
    if (t.is_alive)
      sum += tet_volume(region.points()[t.corners[0]], region.points()[t.corners[1]], region.points()[t.corners[2]], region.points()[t.corners[3]]);
  return sum;
}

TEST(Region, RemovesEdgeWithRingOfAnySize) {
  for (int n = 3; n <= 7; ++n) {
    // The edge passes the ring off its centre, near one side: the tetrahedron there is flat at the edge.
    const double half_side = std::numbers::pi / n;
    std::vector<Vec3> points = {{0.95 * std::cos(half_side), 0, -1.0}, {0.95 * std::cos(half_side), 0, 1.0}};
    for (int i = 0; i < n; ++i) points.push_back({std::cos(half_side * (2 * i - 1)), std::sin(half_side * (2 * i - 1)), 0.0});
    const std::vector<VertexRole> fixed(points.size(), VertexRole::boundary);
    Region region(quality_limits(12 * k_degree, 160 * k_degree));
    region.assign(points, fixed, around_edge(n));
    const double volume = region_volume(region);
    ASSERT_TRUE(improve_all(region)) << n;
    EXPECT_NEAR(region_volume(region), volume, 1e-12);
    std::int64_t n_alive = 0;
    for (const Region::Tet& t : region.tets()) {
      if (!t.is_alive) continue;
      ++n_alive;
      EXPECT_GE(t.quality, std::sin(12 * k_degree)) << n;
      EXPECT_FALSE(std::ranges::count(t.corners, 0u) && std::ranges::count(t.corners, 1u)) << n;
    }
    EXPECT_EQ(n_alive, 2 * (n - 2));
  }
}

TEST(Region, OnlyAttemptsWithAllNeighboursCount) {
  // A flat tetrahedron at the edge 0-1, which is removed if all three around the edge are given; if one is missing, no operation helps.
  const std::vector<Vec3> points = {{0.45, 0, -1.0}, {0.45, 0, 1.0}, {0.5, -0.87, 0.0}, {0.5, 0.87, 0.0}, {-1.0, 0.0, 0.0}};
  const std::vector<Region::Corners> tets = around_edge(3);
  const auto tries = [&](std::size_t n_tets, VertexRole role) {
    Region region(quality_limits(12 * k_degree, 160 * k_degree));
    region.assign(points, std::vector<VertexRole>(points.size(), role), std::span(tets).first(n_tets));
    EXPECT_EQ(improve_all(region), n_tets == 3);
    return region.tets()[0].n_failures;
  };
  EXPECT_EQ(tries(2, VertexRole::kept_boundary), 0);
  EXPECT_EQ(tries(2, VertexRole::kept), 0);
  EXPECT_GT(tries(2, VertexRole::boundary), 0);
  EXPECT_EQ(tries(3, VertexRole::kept_boundary), 0);
}

TEST(Region, TwoThreeFlipOpensAFlatPair) {
  // Two tetrahedra over a triangle, with apexes close to it: three around the new edge are better.
  const std::vector<Vec3> points = {{1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}, {0, 0, 0.15}, {0, 0, -0.15}};
  const std::vector<VertexRole> fixed(points.size(), VertexRole::boundary);
  Region region(quality_limits(30 * k_degree, 120 * k_degree));
  region.assign(points, fixed, std::vector<Region::Corners>{{0, 1, 2, 3}, {0, 2, 1, 4}});
  ASSERT_TRUE(improve_all(region));
  const auto alive = std::ranges::count_if(region.tets(), [](const Region::Tet& t) { return t.is_alive; });
  EXPECT_EQ(alive, 3);
  EXPECT_NEAR(region_volume(region), 0.3 * 0.5 * 1.6 * 1.5 / 3.0, 1e-12);
}

TEST(Region, SmoothsAFreeVertexToTheMiddle) {
  // An octahedron around a vertex that lies almost on a face.
  const std::vector<Vec3> points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0.32, 0.33, 0.33}};
  std::vector<Region::Corners> tets;
  for (const std::uint32_t x : {0u, 1u})
    for (const std::uint32_t y : {2u, 3u})
      for (const std::uint32_t z : {4u, 5u}) {
        tets.push_back({x, y, z, 6});
        if (orient3d(points[x], points[y], points[z], points[6]) < 0) std::swap(tets.back()[0], tets.back()[1]);
      }
  std::vector<VertexRole> roles(7, VertexRole::kept);
  roles[6] = VertexRole::free;
  Region region(quality_limits(40 * k_degree, 110 * k_degree));
  region.assign(points, roles, tets);
  ASSERT_TRUE(improve_all(region));
  double worst = 1.0;
  for (const Region::Tet& t : region.tets())
    if (t.is_alive) worst = std::min(worst, t.quality);
  EXPECT_GT(worst, std::sin(40 * k_degree));
  EXPECT_NEAR(region_volume(region), 4.0 / 3.0, 1e-12);
}

TEST(Improve, ShakenCubesLoseTheirSlivers) {
  Filled filled = shaken_cube(10, 0.55);
  // If displaced too far, some cells are inverted; such a mesh is not a valid input.
  if (filled.worst(1.0) <= 0.0) filled = shaken_cube(10, 0.3);
  expect_improved(filled, {.improve_min_angle = 18 * k_degree, .improve_max_angle = 150 * k_degree}, 0.02);
}

TEST(Improve, EngineMeshesReachTheLimits) { expect_improved(shell(12, 2.0), {}, 0.0); }

TEST(Improve, EngineMeshesReachStricterLimitsExceptAtBoundary) {
  expect_improved(shell(12, 1.4), {.improve_min_angle = 17 * k_degree, .improve_max_angle = 150 * k_degree}, 0.02);
}

TEST(Improve, PassesWithLittleGainAreTheLast) {
  // Limits that cannot be reached: nearly all tetrahedra are bad and stay bad, as on walls full of needles. The improver stops after three passes that cost
  // more than they gain; without that rule it makes all allowed passes (measured).
  Filled filled = shell(4, 2.0);
  const QualityLimits limits = quality_limits(50 * k_degree, 100 * k_degree);
  const double worst = filled.worst(limits.obtuse_weight);
  std::vector<std::uint32_t> bad;
  for (std::uint32_t t = 0; t < filled.tets.tetrahedra.size(); ++t) {
    const auto p = filled.corners(t);
    if (tet_quality(p[0], p[1], p[2], p[3], limits.obtuse_weight) < limits.target) bad.push_back(t);
  }
  const RunContext context;
  Improver improver(filled.boundary(), filled.tets, limits, context);
  improver.work_on(bad);
  constexpr int k_passes = 16;  // the number of attempts for a tetrahedron away from the boundary
  EXPECT_LT(improver.run(k_passes), k_passes);
  improver.finish(filled.tets);
  EXPECT_GT(improver.effort(), 0u);
  EXPECT_NO_THROW(verify_tetrahedra(filled.boundary(), filled.tets, RunContext()));
  EXPECT_GE(filled.worst(limits.obtuse_weight), worst);
}

TEST(Improve, AnglesForcedBySharpBoundaryAreListed) {
  // A wedge of 5 degrees: a single tetrahedron, no operation applies.
  const double angle = 5 * k_degree;
  Filled wedge;
  wedge.points = {{0, 0, -0.5}, {0, 0, 0.5}, {1, 0, 0}, {std::cos(angle), std::sin(angle), 0}};
  wedge.triangles = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  wedge.tets.tetrahedra = {{0, 1, 2, 3}};
  ASSERT_NO_THROW(verify_tetrahedra(wedge.boundary(), wedge.tets, RunContext()));
  const ImproveReport report = improve_tetrahedra(wedge.boundary(), wedge.tets, {}, RunContext());
  EXPECT_EQ(report.n_bad_after, 1);
  EXPECT_EQ(report.n_forced, 1);
  ASSERT_EQ(report.remaining.size(), 1u);
  EXPECT_THAT(report.remaining[0].what, testing::HasSubstr("forced: boundary triangles meet at 5 deg"));
}

/// The boundary of one tetrahedron, oriented inwards.
Filled one_tetrahedron(std::vector<Vec3> points) {
  Filled filled;
  filled.points = std::move(points);
  filled.triangles = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  filled.tets.tetrahedra = {{0, 1, 2, 3}};
  return filled;
}

std::vector<std::uint32_t> forcing_of_all(const Filled& filled) {
  std::vector<std::uint32_t> all(filled.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  return forcing_triangles(filled.boundary(), all, 12 * k_degree, 160 * k_degree, RunContext());
}

TEST(Forcing, SlenderTetrahedronWithGoodAnglesForcesNothing) {
  // Corners of 0.6 degrees, dihedral angles of 60 and 90 degrees.
  const Filled needle = one_tetrahedron({{0.01, 0, 0}, {-0.005, 0.00866, 0}, {-0.005, -0.00866, 0}, {0, 0, 1}});
  ASSERT_GT(needle.worst(1.0), std::sin(12 * k_degree));
  EXPECT_THAT(forcing_of_all(needle), testing::Each(k_unforced));
}

TEST(Forcing, FlatTetrahedronIsForcedOnAllTriangles) {
  const Filled flat = one_tetrahedron({{0, 0, 0}, {1, 0, 0.02}, {1, 1, 0}, {0, 1, 0.02}});
  ASSERT_GT(flat.worst(1.0), 0.0);
  EXPECT_THAT(forcing_of_all(flat), testing::Each(testing::Ne(k_unforced)));
}

TEST(Forcing, SheetsForceEachOtherOnlyWhenCoresOverlap) {
  // Two triangles face to face; the height of each core is tan 12 times the radius of the inscribed circle.
  const double core = std::tan(12 * k_degree) * 0.5 / std::sqrt(3.0);
  const auto sheets = [&](double gap) {
    Filled filled;
    const double h = std::sqrt(0.75);
    filled.points = {{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {0, 0, gap}, {1, 0, gap}, {0.5, h, gap}};
    filled.triangles = {{0, 1, 2}, {3, 5, 4}};
    return forcing_of_all(filled);
  };
  EXPECT_THAT(sheets(1.9 * core), testing::ElementsAre(1u, 0u));
  EXPECT_THAT(sheets(2.1 * core), testing::Each(k_unforced));
}

TEST(Improve, ThinSlabIsForcedAndCubeIsNot) {
  Filled slab;
  slab.add(test::cube(4), true);
  for (Vec3& p : slab.points) p.z *= 0.01;
  slab.tets = fill(slab.boundary(), nullptr, {.engine = "tetgen"}, RunContext());
  const ImproveReport report = improve_tetrahedra(slab.boundary(), slab.tets, {}, RunContext());
  EXPECT_NO_THROW(verify_tetrahedra(slab.boundary(), slab.tets, RunContext()));
  EXPECT_GT(report.n_forced, 0);
  EXPECT_EQ(report.n_at_boundary, std::ranges::count_if(slab.tets.tetrahedra, [&](const auto& c) { return std::ranges::min(c) < slab.points.size(); }));
  std::int64_t n_forced = 0;
  for (const ErrorLocation& location : report.remaining) {
    EXPECT_THAT(location.what, testing::HasSubstr("forced"));
    n_forced += location.what.find("not forced") == std::string::npos;
  }
  EXPECT_EQ(n_forced, report.n_forced);

  Filled cube;
  cube.add(test::cube(4), true);
  cube.tets = fill(cube.boundary(), nullptr, {.engine = "tetgen"}, RunContext());
  EXPECT_EQ(improve_tetrahedra(cube.boundary(), cube.tets, {}, RunContext()).n_bad_after, 0);
}

TEST(Improve, GroupBoundariesStopNoFlip) {
  // Some thousand bad tetrahedra, so that groups of them touch; the smooth boundary forces none.
  Filled filled = shell(24, 2.0);
  const ImproveReport report = improve_tetrahedra(filled.boundary(), filled.tets, {.improve_min_angle = 15 * k_degree}, RunContext());
  EXPECT_GT(report.n_bad_before, 1000);
  EXPECT_EQ(report.n_bad_after, 0);
}

/// Returns heights of last prisms: under the inner sphere as tall as fits regular tetrahedra on them; zero elsewhere.
std::vector<double> fitting_layer(const Filled& filled) {
  std::vector<double> volumes;
  for (const auto& t : filled.triangles) {
    const Vec3 &a = filled.points[t[0]], &b = filled.points[t[1]], &c = filled.points[t[2]];
    const double area = 0.5 * norm(cross(b - a, c - a)), edge = std::sqrt(4.0 / std::sqrt(3.0) * area);
    volumes.push_back(norm(a) < 2.0 ? area * std::sqrt(2.0 / 3.0) * edge : 0.0);
  }
  return volumes;
}

struct Wishes {
  int n_steps = 0;       ///< tetrahedra on the layer with a volume below a third or above three times the fitting volume
  int n_hard_steps = 0;  ///< the same with an eighth and eight times
  int n_obtuse = 0;      ///< tetrahedra with an angle above 155 degrees
};
Wishes unmet(const Filled& filled, const std::vector<double>& layer) {
  std::map<std::array<std::uint32_t, 3>, double> fitting;
  for (std::size_t t = 0; t < filled.triangles.size(); ++t) {
    auto corners = filled.triangles[t];
    std::ranges::sort(corners);
    if (layer[t] > 0.0) fitting[corners] = layer[t] / 3.0;
  }
  Wishes unmet;
  for (std::size_t t = 0; t < filled.tets.tetrahedra.size(); ++t) {
    const auto p = filled.corners(t);
    unmet.n_obtuse += tet_dihedral_range(p)[1] > 155 * k_degree;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& c = filled.tets.tetrahedra[t];
      std::array<std::uint32_t, 3> corners = {c[(k + 1) % 4], c[(k + 2) % 4], c[(k + 3) % 4]};
      std::ranges::sort(corners);
      const auto found = fitting.find(corners);
      if (found == fitting.end()) continue;
      const double ratio = tet_volume(p[0], p[1], p[2], p[3]) / found->second, step = std::max(ratio, 1.0 / ratio);
      unmet.n_steps += step > 3.0;
      unmet.n_hard_steps += step > 8.0;
    }
  }
  return unmet;
}

TEST(Improve, VolumeStepsAndObtuseAnglesReachGateTargets) {
  const Filled start = shell(12, 2.0);
  const std::vector<double> layer = fitting_layer(start);
  const Wishes before = unmet(start, layer);
  ASSERT_GT(before.n_steps, 20);
  ASSERT_GT(before.n_obtuse, 20);
  std::optional<TetraResult> first;
  for (const int threads : {1, 2, 7}) {
    Filled filled = start;
    TetraBoundary boundary = filled.boundary();
    boundary.layer_volumes = layer;
    const ImproveReport report = improve_tetrahedra(boundary, filled.tets, {}, RunContext({.threads = threads}));
    if (!first) first = filled.tets;
    EXPECT_TRUE(filled.tets.new_points == first->new_points && filled.tets.tetrahedra == first->tetrahedra) << threads;
    if (threads > 1) continue;
    EXPECT_NO_THROW(verify_tetrahedra(boundary, filled.tets, RunContext()));
    EXPECT_EQ(report.n_bad_after, 0);
    const Wishes after = unmet(filled, layer);
    EXPECT_EQ(after.n_hard_steps, 0);
    EXPECT_LT(10 * after.n_steps, before.n_steps);
    EXPECT_LT(10 * after.n_obtuse, before.n_obtuse);
  }
}

TEST(TetQuality, VolumeStepBeyondLimitIsBeyondTarget) {
  QualityLimits limits = quality_limits(12 * k_degree, 155 * k_degree);
  const TetShape shape = tet_shape({1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}, limits.obtuse_weight);
  EXPECT_NEAR(shape.six_volumes, 16.0, 1e-12);
  const auto among = [&](double mean_volume) {
    const double weight = size_weight(std::log(6.0 * mean_volume));
    return quality_among(shape, weight * weight * weight * weight, limits);
  };
  EXPECT_EQ(among(1e-9), shape.quality);  // no limit
  limits.size_step = 3.0;
  const double volume = shape.six_volumes / 6.0;
  EXPECT_EQ(among(2.9 * volume), shape.quality);
  EXPECT_EQ(among(volume / 2.9), shape.quality);
  EXPECT_LT(among(3.1 * volume), limits.target);
  EXPECT_LT(among(volume / 3.1), limits.target);
  EXPECT_LT(among(100.0 * volume), among(10.0 * volume));
  EXPECT_GT(among(1e9 * volume), 0.0);
}

TEST(Improve, IsTheSameForAnyNumberOfThreads) {
  const Filled start = shell(16, 1.8);
  std::optional<TetraResult> first;
  for (const int threads : {1, 2, 7}) {
    TetraResult tets = start.tets;
    improve_tetrahedra(start.boundary(), tets, {.improve_min_angle = 16 * k_degree}, RunContext({.threads = threads}));
    if (!first) first = tets;
    EXPECT_TRUE(tets.new_points == first->new_points && tets.tetrahedra == first->tetrahedra) << threads;
  }
  EXPECT_NE(first->tetrahedra, start.tets.tetrahedra);
}

TEST(Improve, NoRoundsChangeNothing) {
  const Filled start = shell(6, 1.8);
  TetraResult tets = start.tets;
  const ImproveReport report = improve_tetrahedra(start.boundary(), tets, {.improve_rounds = 0}, RunContext());
  EXPECT_TRUE(tets.new_points == start.tets.new_points && tets.tetrahedra == start.tets.tetrahedra);
  EXPECT_EQ(report.n_bad_before, report.n_bad_after);
}

TEST(Improve, DoesNotDependOnTheUnit) {
  Filled start = shell(6, 1.8);
  TetraResult tets = start.tets;
  improve_tetrahedra(start.boundary(), tets, {}, RunContext());
  for (Vec3& p : start.points) p = 1024.0 * p;
  for (Vec3& p : start.tets.new_points) p = 1024.0 * p;
  improve_tetrahedra(start.boundary(), start.tets, {}, RunContext());
  EXPECT_EQ(start.tets.tetrahedra, tets.tetrahedra);
  for (std::size_t i = 0; i < tets.new_points.size(); ++i) EXPECT_EQ(start.tets.new_points[i], 1024.0 * tets.new_points[i]);
}

}  // namespace
}  // namespace sterna::volmesh
