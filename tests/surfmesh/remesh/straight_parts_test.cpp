// Straight edges and flat faces, continued tangentially by fine arcs as in CAD exports: remeshing must not bend them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "geom/mesh/tri_mesh.h"
#include "surfmesh/remesh/remesh_surface.h"
#include "surfmesh/remesh/remesher.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"

namespace sterna::surfmesh {
namespace {

using test::k_context;

static_assert(std::is_constructible_v<Remesher, Reference&, RemeshSizes&, RunContext>);
static_assert(!std::is_constructible_v<Remesher, Reference, RemeshSizes&, RunContext>);
static_assert(!std::is_constructible_v<Remesher, Reference&, RemeshSizes, RunContext>);
using test::k_degree;
using test::k_pi;

/// Tolerance for "straight" and "flat", relative to the length.
constexpr double k_flat = 1e-12;

/// Builds triangles from points, merging equal points; normals outwards.
class ShapeBuilder {
 public:
  void add(const Point& a, const Point& b, const Point& c) {
    const TriangleVertices t{vertex(a), vertex(b), vertex(c)};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return;
    mesh_.triangles.push_back(t);
    mesh_.triangle_patch.push_back(PatchId(0));
  }
  void quad(const Point& a, const Point& b, const Point& c, const Point& d) {
    add(a, b, c);
    add(a, c, d);
  }
  TriMesh result() {
    mesh_.patches = Column<PatchId, Patch>{{"wall", PatchKind::wall}};
    if (test::volume_of(mesh_) < 0.0)
      for (TriangleVertices& v : mesh_.triangles) std::swap(v[1], v[2]);
    return std::move(mesh_);
  }

 private:
  VertexId vertex(const Point& p) {
    const auto [at, is_new] = vertices_.try_emplace({p.x, p.y, p.z}, VertexId(mesh_.n_vertices()));
    if (is_new) mesh_.points.push_back(p);
    return at->second;
  }
  TriMesh mesh_;
  std::map<std::tuple<double, double, double>, VertexId> vertices_;
};

/// Returns the cosine and sine of a fraction of a quarter turn, exact at both ends.
std::pair<double, double> quarter(int i, int n) {
  if (i == 0) return {1.0, 0.0};
  if (i == n) return {0.0, 1.0};
  return {std::cos(0.5 * k_pi * i / n), std::sin(0.5 * k_pi * i / n)};
}

/// Returns a rectangle about the origin with rounded corners.
std::vector<Point> rounded_ring(double a, double b, double r, int n) {
  std::vector<Point> ring;
  for (int q = 0; q < 4; ++q)
    for (int i = 0; i <= n; ++i) {
      auto [c, s] = quarter(i, n);
      for (int k = 0; k < q; ++k) std::tie(c, s) = std::pair(-s, c);
      const double sx = q == 0 || q == 3 ? 1.0 : -1.0, sy = q < 2 ? 1.0 : -1.0;
      ring.push_back({sx * (0.5 * a - r) + r * c, sy * (0.5 * b - r) + r * s, 0.0});
    }
  return ring;
}

Point raised(Point p, double z) { return {p.x, p.y, z}; }

/// Returns a plate between two rings with equal numbers of points (the inner ring is a through hole), or without the inner one.
TriMesh plate(const std::vector<Point>& outer, const std::vector<Point>& inner, double thickness) {
  ShapeBuilder builder;
  const std::size_t n = outer.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    builder.quad(outer[i], outer[j], raised(outer[j], thickness), raised(outer[i], thickness));
    if (inner.empty()) continue;
    builder.quad(inner[j], inner[i], raised(inner[i], thickness), raised(inner[j], thickness));
    builder.quad(outer[j], outer[i], inner[i], inner[j]);
    builder.quad(raised(outer[i], thickness), raised(outer[j], thickness), raised(inner[j], thickness), raised(inner[i], thickness));
  }
  // The shortest diagonal is used first.
  std::vector<Point> left = outer;
  while (inner.empty() && left.size() > 2) {
    const std::size_t m = left.size();
    std::size_t best = 0;
    const auto diagonal = [&](std::size_t k) { return distance(left[(k + m - 1) % m], left[(k + 1) % m]); };
    for (std::size_t k = 1; k < m; ++k)
      if (diagonal(k) < diagonal(best)) best = k;
    const Point &before = left[(best + m - 1) % m], &here = left[best], &after = left[(best + 1) % m];
    builder.add(before, after, here);
    builder.add(raised(after, thickness), raised(before, thickness), raised(here, thickness));
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  return builder.result();
}

/// Returns a box with all edges and corners rounded; flat faces are two triangles each.
TriMesh rounded_box(double a, double b, double c, double r, int n) {
  ShapeBuilder builder;
  std::vector<std::vector<Point>> rings;
  for (int half = 0; half < 2; ++half)
    for (int i = 0; i <= n; ++i) {
      const auto [up, out] = half == 0 ? quarter(i, n) : quarter(n - i, n);
      std::vector<Point> ring = rounded_ring(a - 2.0 * r + 2.0 * r * out, b - 2.0 * r + 2.0 * r * out, r * out, n);
      for (Point& p : ring) p.z = (half == 0 ? 1.0 : -1.0) * (0.5 * c - r + r * up);
      rings.push_back(std::move(ring));
    }
  const std::size_t m = rings.front().size(), side = m / 4;
  for (std::size_t k = 0; k + 1 < rings.size(); ++k)
    for (std::size_t i = 0; i < m; ++i) builder.quad(rings[k][i], rings[k + 1][i], rings[k + 1][(i + 1) % m], rings[k][(i + 1) % m]);
  for (const auto& [ring, is_top] : {std::pair(&rings.front(), true), std::pair(&rings.back(), false)}) {
    const auto at = [&](std::size_t i) { return (*ring)[i * side]; };
    is_top ? builder.quad(at(0), at(1), at(2), at(3)) : builder.quad(at(3), at(2), at(1), at(0));
  }
  return builder.result();
}

/// Returns a body of revolution about x with `n` sides; its ends are flat where the radius there is not zero.
TriMesh turned(const std::vector<std::pair<double, double>>& profile, int n) {
  ShapeBuilder builder;
  const auto at = [&](std::size_t k, int i) {
    const double angle = 2.0 * k_pi * (i % n) / n;
    return Point{profile[k].first, profile[k].second * std::cos(angle), profile[k].second * std::sin(angle)};
  };
  for (std::size_t k = 0; k + 1 < profile.size(); ++k)
    for (int i = 0; i < n; ++i) builder.quad(at(k, i), at(k, i + 1), at(k + 1, i + 1), at(k + 1, i));
  const std::size_t last = profile.size() - 1;
  for (int i = 1; i + 1 < n; ++i) {
    builder.add(at(0, 0), at(0, i + 1), at(0, i));
    builder.add(at(last, 0), at(last, i), at(last, i + 1));
  }
  return builder.result();
}

void expect_same_box(const TriMesh& before, const TriMesh& after) {
  Box a, b;
  for (const Point& p : before.points) a.add(p);
  for (const Point& p : after.points) b.add(p);
  const double most = k_flat * body_length(before);
  EXPECT_LT(norm(a.min - b.min), most);
  EXPECT_LT(norm(a.max - b.max), most);
}

TriMesh new_triangles(const TriMesh& wall, const RemeshOptions& options = {}) { return remesh_surface(wall, options, {}, {}, k_context).mesh; }

/// Largest deviation of points, separately for flat and curved parts of the shape.
struct PartDeviation {
  double flat = 0.0, curved = 0.0;
  std::int64_t n_flat = 0, n_curved = 0;
  void add(bool is_flat, double off) {
    double& most = is_flat ? flat : curved;
    most = std::max(most, std::abs(off));
    ++(is_flat ? n_flat : n_curved);
  }
};

struct PlateCase {
  double a, b, r, t;
  int n;
};
class RoundedPlate : public testing::TestWithParam<PlateCase> {};

TEST_P(RoundedPlate, StaysStraightAndFlat) {
  const PlateCase c = GetParam();
  const TriMesh wall = plate(rounded_ring(c.a, c.b, c.r, c.n), {}, c.t), made = new_triangles(wall);
  expect_same_box(wall, made);
  const double sagitta = c.r * (1.0 - std::cos(0.25 * k_pi / c.n));
  PartDeviation side, face;
  for (const Point& p : made.points) {
    const double x = std::abs(p.x) - 0.5 * c.a + c.r, y = std::abs(p.y) - 0.5 * c.b + c.r;
    const double off = x > 0.0 && y > 0.0 ? std::hypot(x, y) - c.r : std::max(x, y) - c.r;
    if (p.z > 0.0 && p.z < c.t) side.add(x <= 0.0 || y <= 0.0, off);
    if (off < -2.0 * sagitta) face.add(true, std::min(p.z, c.t - p.z));
  }
  EXPECT_GT(side.n_flat + face.n_flat, 20);
  EXPECT_LT(side.flat, k_flat * c.a);
  EXPECT_LT(face.flat, k_flat * c.a);
  EXPECT_LT(side.curved, 0.5 * sagitta);
}

INSTANTIATE_TEST_SUITE_P(Plates, RoundedPlate,
                         testing::Values(PlateCase{1.0, 0.5, 0.02, 0.02, 8}, PlateCase{1.0, 1.0, 0.3, 0.2, 3}, PlateCase{1.0, 0.5, 0.1, 0.02, 6},
                                         PlateCase{2.0, 0.3, 0.14, 0.05, 12}, PlateCase{1.0, 0.4, 0.05, 0.1, 2}, PlateCase{1.0, 0.9, 0.4, 0.1, 4}));

TEST(StraightParts, SlottedPlateStaysStraightAndFlat) {
  const TriMesh wall = plate(rounded_ring(1.0, 0.5, 0.05, 6), rounded_ring(0.6, 0.1, 0.049, 6), 0.03), made = new_triangles(wall);
  expect_same_box(wall, made);
  PartDeviation side, face;
  for (const Point& p : made.points) {
    if (p.z <= 0.0 || p.z >= 0.03) continue;
    if (std::abs(p.x) < 0.25) side.add(true, std::abs(p.y) > 0.15 ? std::abs(p.y) - 0.25 : std::abs(p.y) - 0.05);
    // No point of the flat faces has left its plane.
    const double x = std::abs(p.x), y = std::abs(p.y);
    if (x < 0.43 && y < 0.18 && (x > 0.32 || y > 0.07)) face.add(true, 1.0);
  }
  EXPECT_GT(side.n_flat, 10);
  EXPECT_LT(side.flat, k_flat);
  EXPECT_EQ(face.n_flat, 0);
}

TEST(StraightParts, RoundedBoxStaysFlat) {
  for (const auto& [r, n] : {std::pair(0.1, 6), std::pair(0.05, 4), std::pair(0.2, 3)}) {
    const TriMesh wall = rounded_box(2.0, 1.0, 0.5, r, n), made = new_triangles(wall, {.sizes = {.max_edge = 0.15}});
    expect_same_box(wall, made);
    PartDeviation all;
    for (const Point& p : made.points) {
      const Vec3 q{std::max(0.0, std::abs(p.x) - 1.0 + r), std::max(0.0, std::abs(p.y) - 0.5 + r), std::max(0.0, std::abs(p.z) - 0.25 + r)};
      all.add((q.x > 0.0) + (q.y > 0.0) + (q.z > 0.0) < 2, norm(q) - r);
    }
    EXPECT_GT(all.n_flat, 100);
    EXPECT_LT(all.flat, k_flat * 2.0) << r << " " << n;
    EXPECT_LT(all.curved, 0.4 * r * (1.0 - std::cos(0.25 * k_pi / n))) << r << " " << n;
  }
}

TEST(StraightParts, TubeBetweenRoundedEndsStaysACylinder) {
  constexpr double k_long = 2.0, k_radius = 0.4, k_round = 0.05;
  constexpr int k_sides = 32, k_chords = 5;
  std::vector<std::pair<double, double>> profile;
  for (int i = 0; i <= k_chords; ++i)
    profile.emplace_back(k_round * (1.0 - quarter(i, k_chords).first), k_radius - k_round + k_round * quarter(i, k_chords).second);
  for (int i = k_chords; i >= 0; --i) profile.emplace_back(k_long - profile[static_cast<std::size_t>(i)].first, profile[static_cast<std::size_t>(i)].second);
  const TriMesh wall = turned(profile, k_sides), made = new_triangles(wall);
  const double end_radius = (k_radius - k_round) * std::cos(k_pi / k_sides);
  PartDeviation ends, side;
  for (const Point& p : made.points) {
    const double r = std::hypot(p.y, p.z), x = std::abs(p.x - 0.5 * k_long);
    if (r < end_radius - 1e-9) ends.add(true, x - 0.5 * k_long);
    if (x < 0.5 * k_long - k_round) side.add(false, r - k_radius);
  }
  EXPECT_GT(ends.n_flat, 50);
  EXPECT_LT(ends.flat, k_flat * k_long);
  EXPECT_GT(side.n_curved, 500);
  EXPECT_LT(side.curved, 0.02 * k_radius * (1.0 - std::cos(k_pi / k_sides)));  // previously 0.0157 m = 8 of these
}

TEST(StraightParts, ConeBesideAFineArcStaysStraight) {
  constexpr double k_radius = 0.5, k_arc = 0.1, k_angle = 20.0 * k_degree, k_cone = 1.2;
  constexpr int k_sides = 60, k_chords = 6;
  std::vector<std::pair<double, double>> profile{{0.0, k_radius}, {1.0, k_radius}};
  for (int i = 1; i <= k_chords; ++i) {
    const double angle = k_angle * i / k_chords;
    profile.emplace_back(1.0 + k_arc * std::sin(angle), k_radius - k_arc + k_arc * std::cos(angle));
  }
  const auto [x_begin, r_begin] = profile.back();
  profile.emplace_back(x_begin + k_cone * std::cos(k_angle), r_begin - k_cone * std::sin(k_angle));
  const TriMesh wall = turned(profile, k_sides), made = new_triangles(wall);
  const double sagitta = k_radius * (1.0 - std::cos(k_pi / k_sides));
  PartDeviation parts;
  for (const Point& p : made.points) {
    const double r = std::hypot(p.y, p.z);
    if (p.x <= 0.0 || p.x >= profile.back().first - 1e-9) continue;
    if (p.x < 1.0) parts.add(false, r - k_radius);
    if (p.x > x_begin) parts.add(false, (r - r_begin) * std::cos(k_angle) + (p.x - x_begin) * std::sin(k_angle));
  }
  EXPECT_GT(parts.n_curved, 500);
  EXPECT_LT(parts.curved, 0.5 * sagitta);
}

}  // namespace
}  // namespace sterna::surfmesh
