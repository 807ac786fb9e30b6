// Boundary recovery on bodies without crossing triangles: bit-identical boundary, no hole, no tetrahedron outside.
#include "geom/tets/recover.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "tests/geom/tets/grids.h"

namespace sterna::tets {
namespace {

/// A closed surface. Its normals point into the body, so its inside is the domain.
struct Shell {
  std::vector<Vec3> points;
  std::vector<Facet> facets;

  /// Adds another shell, beside this one or around it.
  void add(const Shell& other) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), other.points.begin(), other.points.end());
    for (const Facet& f : other.facets) facets.push_back({f[0] + first, f[1] + first, f[2] + first});
  }
  Shell inside_out() const {
    Shell turned = *this;
    for (Facet& f : turned.facets) std::swap(f[1], f[2]);
    return turned;
  }
  Shell moved(const Vec3& by, double factor = 1.0) const {
    Shell other = *this;
    for (Vec3& p : other.points) p = factor * p + by;
    return other;
  }
};

/// Returns a star with n parallels and 2 n meridians on the unit sphere; `radius` gives the radius of each point.
Shell star(std::uint32_t n, const std::function<double(const Vec3&)>& radius) {
  Shell shell;
  const std::uint32_t around = 2 * n;
  const auto add = [&](const Vec3& p) { shell.points.push_back(radius(p) * p); };
  add({0, 0, 1});
  for (std::uint32_t i = 1; i < n; ++i) {
    const double polar = std::numbers::pi * i / n;
    for (std::uint32_t j = 0; j < around; ++j) {
      const double azimuth = 2.0 * std::numbers::pi * j / around;
      add({std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)});
    }
  }
  add({0, 0, -1});
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return 1 + (i - 1) * around + j % around; };
  const auto last = static_cast<std::uint32_t>(shell.points.size() - 1);
  for (std::uint32_t j = 0; j < around; ++j) {
    shell.facets.push_back({0, at(1, j + 1), at(1, j)});
    shell.facets.push_back({last, at(n - 1, j), at(n - 1, j + 1)});
    for (std::uint32_t i = 1; i + 1 < n; ++i) {
      const bool is_turned = (i * 7 + j * 13) % 3 == 0;  // mixed diagonals, so that the Delaunay mesh does not always have the required ones
      if (is_turned) {
        shell.facets.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
        shell.facets.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
      } else {
        shell.facets.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
        shell.facets.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
      }
    }
  }
  return shell;
}

Shell ball(std::uint32_t n) {
  return star(n, [](const Vec3&) { return 1.0; });
}

std::set<std::array<std::array<double, 3>, 3>> locations_of(const Shell& shell) {
  std::set<std::array<std::array<double, 3>, 3>> faces;
  for (const Facet& f : shell.facets) {
    std::array<std::array<double, 3>, 3> face;
    for (std::size_t k = 0; k < 3; ++k) face[k] = {shell.points[f[k]].x, shell.points[f[k]].y, shell.points[f[k]].z};
    std::ranges::rotate(face, std::ranges::min_element(face));
    faces.insert(face);
  }
  return faces;
}

/// Returns the volume by the divergence theorem.
double volume_of(const Shell& shell) {
  double sum = 0.0;
  for (const Facet& f : shell.facets) sum -= dot(shell.points[f[0]], cross(shell.points[f[1]], shell.points[f[2]])) / 6.0;
  return sum;
}

Recovery recovered(const Shell& shell, int threads = 1) { return recover(shell.points, shell.facets, {}, RunContext({.threads = threads})); }

/// Checks that the mesh fills exactly the domain bounded by the shell, and that the shell's points are unchanged.
void expect_filled(const Shell& shell, const Recovery& recovery, const std::string& what) {
  SCOPED_TRACE(what);
  ASSERT_EQ(recovery.failure.problem, "");
  const TetMesh& mesh = recovery.mesh;
  EXPECT_TRUE(test::is_sound(mesh));
  EXPECT_EQ(test::boundary_of(mesh), locations_of(shell));
  EXPECT_NEAR(test::volume_of(mesh) / volume_of(shell), 1.0, 1e-11);
  ASSERT_GE(mesh.points.size(), shell.points.size());
  for (std::size_t i = 0; i < shell.points.size(); ++i) EXPECT_EQ(mesh.points[i], shell.points[i]);
  EXPECT_EQ(mesh.points.size(), shell.points.size() + static_cast<std::size_t>(recovery.report.n_points));
}

/// Returns a cube of n^3 cells whose squares are split by diagonals of mixed direction; the inside is the domain.
Shell random_grid(int n) {
  const test::TetSoup soup = test::cube_of_tets(n);
  const TetMesh grid = connect(soup.points, soup.tetrahedra, RunContext{});
  Shell shell;
  std::mt19937 generator(5);
  std::map<std::uint32_t, std::uint32_t> number;
  const auto number_of = [&](std::uint32_t v) {
    const auto [it, is_new] = number.try_emplace(v, static_cast<std::uint32_t>(shell.points.size()));
    if (is_new) shell.points.push_back(grid.points[v]);
    return it->second;
  };
  std::map<std::array<double, 3>, std::vector<Facet>> squares;  // by the middle of the diagonal
  for (std::uint32_t t = 0; t < grid.nodes.size(); ++t) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (grid.neighbours[t][i] != k_none) continue;
      Facet f;
      for (std::size_t k = 0; k < 3; ++k) f[k] = number_of(grid.nodes[t][k_face[i][k]]);
      std::size_t longest = 0;
      const auto length = [&](std::size_t k) { return norm2(shell.points[f[k]] - shell.points[f[(k + 1) % 3]]); };
      for (std::size_t k = 1; k < 3; ++k)
        if (length(k) > length(longest)) longest = k;
      std::ranges::rotate(f, f.begin() + static_cast<std::ptrdiff_t>(longest));
      const Vec3 middle = 0.5 * (shell.points[f[0]] + shell.points[f[1]]);
      squares[{middle.x, middle.y, middle.z}].push_back(f);
    }
  }
  for (const auto& [middle, two] : squares) {
    const std::uint32_t a = two[0][0], b = two[0][1], c = two[0][2], d = two[1][2];
    if (generator() % 2 == 0) shell.facets.insert(shell.facets.end(), two.begin(), two.end());
    else shell.facets.insert(shell.facets.end(), {{c, a, d}, {d, b, c}});
  }
  return shell;
}

/// Every square has four points on one circle, every cell eight on one sphere. From n = 16 on, some diagonals need points on both sides, once nearer than the
/// first attempt (found by filling a cube of uniform tetrahedra, which 2.6 edges of 10 000 prevented).
TEST(TetRecover, GridFacesWithDiagonalsEitherWay) {
  for (const int n : {4, 16, 25}) {
    const Shell cube = random_grid(n);
    const Recovery recovery = recovered(cube);
    EXPECT_GT(recovery.report.n_missing_edges, 0);
    expect_filled(cube, recovery, "cube of " + std::to_string(n));
  }
  // The same grid from outside.
  Shell room = random_grid(2).moved({-1.0, -1.0, -1.0}, 3.0);
  room.add(random_grid(16).inside_out());
  expect_filled(room, recovered(room), "around a cube");
}

TEST(TetRecover, RoughStars) {
  // Random radii, so that a third of the edges are missing in the Delaunay mesh; all triangles are visible from the centre.
  for (const double roughness : {0.02, 0.2, 0.6}) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
      std::mt19937 generator(seed);
      std::uniform_real_distribution<double> at(1.0 - roughness, 1.0);
      const Shell shell = star(8 + 2 * seed, [&](const Vec3&) { return at(generator); });
      const std::string what = "roughness " + std::to_string(roughness) + ", seed " + std::to_string(seed);
      expect_filled(shell, recovered(shell), what + ", inside");
      Shell room = ball(6).moved({}, 5.0);
      room.add(shell.inside_out());
      expect_filled(room, recovered(room), what + ", outside");
    }
  }
}

TEST(TetRecover, BodyThatNeedsAnAddedPoint) {
  // A prism whose top is rotated by 30 degrees, with its sides folded inwards (Schoenhardt 1928).
  Shell shell;
  for (const double z : {0.0, 1.0})
    for (int i = 0; i < 3; ++i) {
      const double angle = 2.0 * std::numbers::pi / 3.0 * i - (z > 0.5 ? std::numbers::pi / 6.0 : 0.0);
      shell.points.push_back({std::cos(angle), std::sin(angle), z});
    }
  shell.facets = {{0, 1, 2}, {3, 5, 4}};
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t j = (i + 1) % 3;
    shell.facets.push_back({i, i + 3, j});
    shell.facets.push_back({j, i + 3, j + 3});
  }
  ASSERT_GT(volume_of(shell), 0.0);
  const Recovery recovery = recovered(shell);
  EXPECT_GT(recovery.report.n_points, 0);
  expect_filled(shell, recovery, "Schoenhardt's");
}

TEST(TetRecover, StripsNeedlesAndNearContacts) {
  // Triangles 2000 times as long as wide, on a body of revolution.
  expect_filled(star(4, [](const Vec3&) { return 1.0; }).moved({}, 1.0), recovered(star(4, [](const Vec3&) { return 1.0; })), "ball");
  Shell strip;
  for (std::uint32_t i = 0; i < 40; ++i)
    for (const double side : {0.0, 1.0}) strip.points.push_back({i * 5e-4, side, 1e-3 * std::sin(0.1 * i)});
  const auto n = static_cast<std::uint32_t>(strip.points.size());
  for (std::uint32_t i = 0; i < n; ++i) strip.points.push_back(strip.points[i] + Vec3{0, 0, -0.1});
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    strip.facets.push_back({a, b, c});
    strip.facets.push_back({a, c, d});
  };
  for (std::uint32_t i = 0; i + 2 < n; i += 2) {
    quad(i, i + 1, i + 3, i + 2);
    quad(n + i, n + i + 2, n + i + 3, n + i + 1);
    quad(i, i + 2, n + i + 2, n + i);
    quad(i + 1, n + i + 1, n + i + 3, i + 3);
  }
  quad(0, n, n + 1, 1);
  quad(n - 2, n - 1, 2 * n - 1, 2 * n - 2);
  if (volume_of(strip) < 0.0) strip = strip.inside_out();
  expect_filled(strip, recovered(strip), "strip");

  // Two balls at a distance of 1e-4 of an edge, with points of one opposite edges of the other.
  Shell room = ball(5).moved({}, 20.0);
  room.add(ball(12).inside_out());
  room.add(ball(13).inside_out().moved({0, 0, 2.0 + 2.5e-5}));
  expect_filled(room, recovered(room), "near contact");
}

/// Corners of a room see half of a ball's 14 000 triangles if they are inserted after the ball: one cavity then has as many tetrahedra. Found on a DLR-F6 of
/// 613 000 triangles, whose boundary HXT had to recover.
TEST(TetRecover, PointsFarFromAllOthers) {
  Shell room = random_grid(1).moved({-25.0, -25.0, -25.0}, 50.0);
  room.add(ball(60).inside_out());
  expect_filled(room, recovered(room), "room");
}

TEST(TetRecover, ManyBodiesAndOneInAnothersHole) {
  Shell room = ball(6).moved({}, 30.0);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (int k = 0; k < 6; ++k) room.add(ball(3).inside_out().moved({3.0 * i - 7.5, 3.0 * j - 7.5, 3.0 * k - 7.5}));
  expect_filled(room, recovered(room), "216 bodies");

  // Two domains: one around a hollow ball, the other in the ball's cavity around a small ball.
  Shell nested = ball(8).moved({}, 4.0);
  nested.add(ball(8).inside_out().moved({}, 2.0));
  nested.add(ball(7));
  nested.add(ball(5).inside_out().moved({0.1, 0.2, 0.1}, 0.3));
  expect_filled(nested, recovered(nested), "nested");
}

TEST(TetRecover, SheetsHaveTheDomainOnBothSides) {
  Shell room = ball(8).moved({}, 3.0);
  const auto first = static_cast<std::uint32_t>(room.points.size());
  std::vector<Facet> sheet;
  room.points.push_back({0.1, 0.2, 0.3});
  for (std::uint32_t j = 0; j < 12; ++j) room.points.push_back({0.1 + std::cos(std::numbers::pi * j / 6), 0.2 + std::sin(std::numbers::pi * j / 6), 0.3});
  for (std::uint32_t j = 0; j < 12; ++j) sheet.push_back({first, first + 1 + j, first + 1 + (j + 1) % 12});
  const Recovery recovery = recover(room.points, room.facets, sheet, RunContext{});
  ASSERT_EQ(recovery.failure.problem, "");
  EXPECT_TRUE(test::is_sound(recovery.mesh));
  EXPECT_EQ(test::boundary_of(recovery.mesh), locations_of(room));
  for (const Facet& f : sheet) {
    int n_tets = 0;
    for (const Corners& v : recovery.mesh.nodes)
      n_tets += std::ranges::all_of(f, [&](std::uint32_t corner) { return std::ranges::find(v, corner) != v.end(); });
    EXPECT_EQ(n_tets, 2);
  }
}

TEST(TetRecover, WhatCannotBeIsToldWithAPlace) {
  // Two balls that cross: a point of one ball lies within a facet of the other, on the room's side.
  Shell room = ball(5).moved({}, 20.0);
  room.add(ball(6).inside_out());
  room.add(ball(6).inside_out().moved({0.9, 0.1, 0.2}));
  const Recovery recovery = recovered(room);
  EXPECT_TRUE(recovery.mesh.nodes.empty());
  EXPECT_NE(recovery.failure.problem, "");
  ASSERT_GT(recovery.failure.n_locations, 0);
  ASSERT_FALSE(recovery.failure.locations.empty());
  EXPECT_LT(norm(recovery.failure.locations[0]), 3.0);
}

TEST(TetRecover, SameMeshForAnyThreads) {
  std::mt19937 generator(9);
  std::uniform_real_distribution<double> at(0.9, 1.0);
  const Shell shell = star(60, [&](const Vec3&) { return at(generator); });
  const Recovery one = recovered(shell, 1);
  ASSERT_EQ(one.failure.problem, "");
  for (const int threads : {2, 7}) {
    const Recovery more = recovered(shell, threads);
    EXPECT_EQ(more.mesh.nodes, one.mesh.nodes) << threads;
    EXPECT_EQ(more.mesh.points, one.mesh.points) << threads;
  }
}

}  // namespace
}  // namespace sterna::tets
