// Periodic sides: a box whose left and right sides are copies, and the reported errors if they are not.
#include "geom/mesh/periodic.h"

#include <gtest/gtest.h>

#include "geom/base/error.h"
#include "tests/support/error_of.h"

namespace sterna {
namespace {

/// Returns two flat sides x = 0 and x = 2 of n x n squares, normals along +-x; `turn` flips the diagonals of the second side.
TriMesh two_sides(std::uint32_t n, bool turn = false) {
  TriMesh mesh;
  for (const char* name : {"left", "right"}) mesh.patches.push_back({name, PatchKind::slip});
  for (std::uint32_t side = 0; side < 2; ++side) {
    const std::uint32_t first = side * (n + 1) * (n + 1);
    for (std::uint32_t i = 0; i <= n; ++i)
      for (std::uint32_t j = 0; j <= n; ++j) mesh.points.push_back({2.0 * side, static_cast<double>(i) / n, static_cast<double>(j * j) / n / n});
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; j < n; ++j) {
        const VertexId a(first + i * (n + 1) + j), b(first + (i + 1) * (n + 1) + j), c(first + (i + 1) * (n + 1) + j + 1), d(first + i * (n + 1) + j + 1);
        const bool is_other = side == 1 && turn && i == 1 && j == 1;
        std::array<TriangleVertices, 2> t = {{{a, b, c}, {a, c, d}}};
        if (is_other) t = {{{a, b, d}, {b, c, d}}};
        for (TriangleVertices v : t) {
          if (side == 1) std::swap(v[1], v[2]);
          mesh.triangles.push_back(v);
          mesh.triangle_patch.push_back(PatchId(side));
        }
      }
  }
  return mesh;
}

constexpr double k_tolerance = 2.0 * k_periodic_share;

TEST(Periodic, FindsTranslationAndPartners) {
  const TriMesh mesh = two_sides(5);
  const PeriodicMatch match = match_periodic(mesh, PatchId(0u), PatchId(1u), k_tolerance);
  EXPECT_NEAR(distance(match.translation, {2, 0, 0}), 0.0, 1e-15);
  ASSERT_EQ(match.nodes.size(), 36u);
  EXPECT_EQ(match.faces.size(), 50u);
  for (const auto& [a, b] : match.nodes) EXPECT_EQ(b.value(), a.value() + 36u);
  EXPECT_LT(match.worst, 1e-15);
}

TEST(Periodic, WorksFarFromOriginInAnyDirection) {
  TriMesh mesh = two_sides(5);
  for (Point& p : mesh.points) p = Vec3{1e3 + 0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, p.z - 1e3};
  const PeriodicMatch match = match_periodic(mesh, PatchId(1u), PatchId(0u), 1e3 * k_tolerance);
  EXPECT_NEAR(distance(match.translation, {-1.2, -1.6, 0}), 0.0, 1e-12);
}

TEST(Periodic, SaysWhereSidesDiffer) {
  TriMesh moved = two_sides(5);
  moved.points[VertexId(40u)].y += 1e-8;
  const ErrorInfo node = test::error_info_of([&] { match_periodic(moved, PatchId(0u), PatchId(1u), k_tolerance); });
  EXPECT_EQ(node.code, ErrorCode::bad_argument);
  EXPECT_NE(node.problem.find("no partner"), std::string::npos);
  EXPECT_NE(node.attempted.find("left"), std::string::npos);

  const TriMesh turned = two_sides(5, true);
  const ErrorInfo face = test::error_info_of([&] { match_periodic(turned, PatchId(0u), PatchId(1u), k_tolerance); });
  EXPECT_EQ(face.n_locations, 2);
  EXPECT_NE(face.problem.find("2 faces"), std::string::npos);
  EXPECT_NEAR(face.locations[0].position.x, 0.0, 1e-15);

  TriMesh bent = two_sides(5);
  for (const std::uint32_t v : {14u, 50u}) bent.points[VertexId(v)].x += 1e-3;
  const ErrorInfo flat = test::error_info_of([&] { match_periodic(bent, PatchId(0u), PatchId(1u), k_tolerance); });
  EXPECT_NE(flat.problem.find("not flat"), std::string::npos);

  TriMesh empty = two_sides(5);
  empty.patches.push_back({"top", PatchKind::slip});
  EXPECT_NE(test::error_info_of([&] { match_periodic(empty, PatchId(0u), PatchId(2u), k_tolerance); }).problem.find("no faces"), std::string::npos);
}

TEST(Periodic, QuadrilateralsToo) {
  HybridMesh mesh;
  for (const char* name : {"left", "right"}) mesh.patches.push_back({name, PatchKind::slip});
  for (int side = 0; side < 2; ++side)
    for (const auto& [y, z] : {std::pair(0.0, 0.0), {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}, {0.5, 1.8}}) mesh.points.push_back({static_cast<double>(side), y, z});
  const auto node = [](std::uint32_t n) { return NodeId(n); };
  mesh.boundary_quads.push_back({{node(0), node(3), node(2), node(1)}, PatchId(0u)});
  mesh.boundary_quads.push_back({{node(5), node(6), node(7), node(8)}, PatchId(1u)});
  mesh.boundary_triangles.push_back({{node(2), node(3), node(4)}, PatchId(0u)});
  mesh.boundary_triangles.push_back({{node(8), node(7), node(9)}, PatchId(1u)});
  const PeriodicMatch match = match_periodic(mesh, PatchId(0u), PatchId(1u), k_tolerance);
  EXPECT_EQ(match.nodes.size(), 5u);
  ASSERT_EQ(match.faces.size(), 2u);
  EXPECT_EQ(match.faces[0], (std::array<std::uint32_t, 2>{0, 1}));
  EXPECT_EQ(match.faces[1], (std::array<std::uint32_t, 2>{2, 3}));
}

}  // namespace
}  // namespace sterna
