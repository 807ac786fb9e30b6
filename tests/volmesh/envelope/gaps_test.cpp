// Gaps between opposing walls: the remaining gap, and its distribution between the two layers.
#include <gtest/gtest.h>

#include <cmath>

#include "geom/mesh/bvh.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/retract.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

EnvelopeOptions bounded_layers_of(double h0, int n, double thickness) {
  EnvelopeOptions options;
  options.first_height = h0;
  options.max_growth = 1.4;  // the law of eq. (1); uniform growth has separate tests
  options.growth = "local";
  options.layers = n;
  options.max_thickness = thickness;
  return options;
}

/// A box of n x n x n cells with the given corner and side lengths.
TriMesh block(int n, const Vec3& corner, const Vec3& size) {
  TriMesh mesh = test::cube(n);
  for (Point& p : mesh.points) p = {corner.x + size.x * p.x, corner.y + size.y * p.y, corner.z + size.z * p.z};
  return mesh;
}

/// Wing of constant NACA0012 section along y with flat ends, cosine spacing; leading edge at the origin.
TriMesh naca0012(int n_chord, int n_span, double span) {
  const int n_around = 2 * n_chord;
  TriMesh mesh;
  mesh.patches.push_back({"wing", PatchKind::wall});
  const auto thickness = [](double x) { return 0.6 * (0.2969 * std::sqrt(x) - 0.1260 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x); };
  for (int j = 0; j <= n_span; ++j) {
    for (int i = 0; i < n_around; ++i) {  // from the trailing edge over the upper side to the nose and back along the lower side
      const double x = 0.5 * (1.0 + std::cos(2.0 * M_PI * i / n_around));
      mesh.points.push_back({x, span * j / n_span, i == 0 ? 0.0 : (i <= n_chord ? 1.0 : -1.0) * thickness(x)});
    }
  }
  const auto add = [&](int a, int b, int c) {
    mesh.triangles.push_back({VertexId(a), VertexId(b), VertexId(c)});
    mesh.triangle_patch.push_back(PatchId(0));
  };
  const auto at = [&](int i, int j) { return j * n_around + i % n_around; };
  for (int j = 0; j < n_span; ++j) {
    for (int i = 0; i < n_around; ++i) {
      add(at(i, j), at(i, j + 1), at(i + 1, j));
      add(at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
    }
  }
  for (int i = 0; i < n_chord; ++i) {  // ends: strips between upper and lower side
    const int below = n_around - i;
    for (const int j : {0, n_span}) {
      const auto end = [&](int a, int b, int c) { j == 0 ? add(at(a, j), at(b, j), at(c, j)) : add(at(a, j), at(c, j), at(b, j)); };
      if (i > 0) end(i, i + 1, below);
      if (i + 1 < n_chord) end(i + 1, below - 1, below);
    }
  }
  return mesh;
}

double mean_envelope_edge(const LayerBase& base, const Envelope& envelope, VertexId v) {
  double sum = 0.0;
  for (const VertexId other : base.topology.neighbours(v)) sum += distance(envelope.point(base.wall, v), envelope.point(base.wall, other));
  return sum / static_cast<double>(base.topology.neighbours(v).size());
}

/// Returns the part of the envelope whose wall triangles start at vertex `first` or later, as a mesh.
TriMesh envelope_from(const LayerBase& base, const Envelope& envelope, std::size_t first) {
  TriMesh mesh;
  mesh.patches = base.wall.patches;
  for (const VertexId v : base.wall.points.ids()) mesh.points.push_back(envelope.point(base.wall, v));
  for (const TriangleId t : base.wall.triangles.ids()) {
    if (base.wall.triangles[t][0].index() < first) continue;
    mesh.triangles.push_back(base.wall.triangles[t]);
    mesh.triangle_patch.push_back(PatchId(0));
  }
  return mesh;
}

/// Returns the smallest remaining gap between the layers of the first body (vertices below `n_first`) and those of the others, divided by the local envelope
/// edge of the first body. Only vertices whose layer was lowered for the gap are counted.
double smallest_remaining(const LayerBase& base, const Envelope& envelope, std::size_t n_first, int& n_cut) {
  const TriMesh others = envelope_from(base, envelope, n_first);
  const TriangleTree tree(others, k_context);
  double smallest = 1e300;
  for (std::size_t i = 0; i < n_first; ++i) {
    const VertexId v(i);
    if (envelope.limit[v] != HeightLimit::gap || envelope.is_collapsed(v)) continue;
    ++n_cut;
    smallest = std::min(smallest, tree.nearest(envelope.point(base.wall, v)).distance / mean_envelope_edge(base, envelope, v));
  }
  return smallest;
}

void expect_proved(const LayerBase& base, Collider& collider, const Envelope& envelope) {
  const EnvelopeCertificate certificate = certify_envelope(base, collider, envelope, k_context);
  EXPECT_TRUE(certificate.is_proved()) << to_text(certificate);
}

TEST(ShareGaps, TwoPlatesShareInProportionToRequests) {
  // Lower plate with edges of 1/8, upper plate with edges of 1/4: by eq. (1) the upper plate requests the taller layer.
  TriMesh wall = block(8, {0, 0, -0.2}, {1, 1, 0.2});
  const std::size_t n_first = wall.n_vertices();
  const double gap = 0.4;
  append(wall, block(4, {0, 0, gap}, {1, 1, 0.2}));
  const LayerBase base(wall, k_context);
  Collider collider(base, nullptr, k_context);
  const EnvelopeOptions options = bounded_layers_of(1e-3, 15, 1.0);
  Envelope envelope = initial_envelope(base, options, k_context);
  // Requested heights, constant over each plate.
  const double low = 0.21, high = 0.42;
  for (const VertexId v : wall.points.ids()) envelope.height[v] = envelope.target[v] = envelope.cap[v] = v.index() < n_first ? low : high;
  for (const VertexId v : wall.points.ids()) envelope.direction[v] = {0, 0, v.index() < n_first ? 1.0 : -1.0};
  share_gaps(base, options, collider, envelope, k_context);
  int n_inner = 0;
  for (const VertexId v : wall.points.ids()) {
    const Point& p = wall.points[v];
    if (p.z != 0.0 || p.x < 0.3 || p.x > 0.7 || p.y < 0.3 || p.y > 0.7) continue;
    for (const VertexId w : wall.points.ids()) {
      if (distance(wall.points[w], p + Vec3{0, 0, gap}) > 1e-12) continue;
      ++n_inner;
      const double mine = envelope.height[v], theirs = envelope.height[w];
      EXPECT_NEAR(mine / theirs, low / high, 1e-9);
      // Mean edge of the coarse plate: 4 sides of 1/4 and 2 diagonals of sqrt(2)/4.
      EXPECT_NEAR(gap - mine - theirs, 0.3 * (4 + 2 * std::sqrt(2.0)) / 6 / 4, 1e-9);
      EXPECT_EQ(envelope.limit[v], HeightLimit::gap);
      EXPECT_LE(envelope.height[v], envelope.cap[v]);
    }
  }
  EXPECT_GE(n_inner, 1);
}

TEST(ShareGaps, ANarrowGapIsHalfLeftFree) {
  TriMesh wall = block(4, {0, 0, -0.2}, {1, 1, 0.2});
  append(wall, block(4, {0, 0, 0.02}, {1, 1, 0.2}));  // edges of 0.08
  const LayerBase base(wall, k_context);
  Collider collider(base, nullptr, k_context);
  const EnvelopeOptions options = bounded_layers_of(1e-5, 15, 0.3);
  const Envelope envelope = build_envelope(base, options, collider, k_context);
  expect_proved(base, collider, envelope);
  for (const VertexId v : wall.points.ids()) {
    const Point& p = wall.points[v];
    if (p.z != 0.0 || p.x < 0.3 || p.x > 0.7 || p.y < 0.3 || p.y > 0.7) continue;
    EXPECT_LE(envelope.height[v], 0.5 * 0.5 * 0.02 * (1 + 1e-9));
    EXPECT_GT(envelope.height[v], 0.3 * 0.5 * 0.02);
  }
}

TEST(ShareGaps, WingAboveAPlateKeepsTheirDistance) {
  TriMesh wall = naca0012(24, 6, 0.6);
  const std::size_t n_first = wall.n_vertices();
  append(wall, block(10, {-0.5, -0.5, -0.24}, {2, 1.6, 0.06}));  // its top lies 0.12 below the lower side of the wing
  const LayerBase base(wall, k_context);
  Collider collider(base, nullptr, k_context);
  const Envelope envelope = build_envelope(base, bounded_layers_of(1e-5, 25, 0.3), collider, k_context);
  expect_proved(base, collider, envelope);
  int n_cut = 0;
  EXPECT_GE(smallest_remaining(base, envelope, n_first, n_cut), 0.15);  // 0.2 are left; lines that the optimiser turns use some of this gap
  EXPECT_GT(n_cut, 20);
}

TEST(ShareGaps, TwoSpheresKeepTheirDistance) {
  TriMesh wall = test::sphere(10);
  const std::size_t n_first = wall.n_vertices();
  TriMesh other = test::sphere(7, 0.8);
  for (Point& p : other.points) p += Vec3{1.93, 0.05, 0.02};
  append(wall, other);
  const LayerBase base(wall, k_context);
  Collider collider(base, nullptr, k_context);
  const Envelope envelope = build_envelope(base, bounded_layers_of(1e-5, 25, 0.4), collider, k_context);
  expect_proved(base, collider, envelope);
  int n_cut = 0;
  EXPECT_GE(smallest_remaining(base, envelope, n_first, n_cut), 0.2);
  EXPECT_GT(n_cut, 5);
}

TEST(ShareGaps, AnnulusWithLayersThatWouldCross) {
  TriMesh wall = test::sphere(8);
  TriMesh shell = test::sphere(8, 1.5);
  for (const TriangleId t : shell.triangles.ids()) std::swap(shell.triangles[t][1], shell.triangles[t][2]);  // normals inwards
  append(wall, shell);
  const LayerBase base(wall, k_context);
  Collider collider(base, nullptr, k_context);
  EnvelopeOptions options = bounded_layers_of(0.02, 25, 0.45);
  const Envelope envelope = build_envelope(base, options, collider, k_context);
  expect_proved(base, collider, envelope);
  const std::size_t n = wall.n_vertices() / 2;  // vertex i of the sphere faces vertex n + i of the shell
  for (std::size_t i = 0; i < n; ++i) EXPECT_LT(envelope.height[VertexId(i)] + envelope.height[VertexId(n + i)], 0.5);
}

}  // namespace
}  // namespace sterna::volmesh
