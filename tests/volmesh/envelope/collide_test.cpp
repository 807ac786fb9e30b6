// Collisions of the layer with itself, its sides, the wall and the outer boundary: two methods agree, and updates check only what moved.
#include "volmesh/envelope/collide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "geom/base/error.h"
#include "geom/mesh/find_crossings.h"
#include "tests/support/envelope_surface.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

// These refer to their base or wall, so they cannot be made of a temporary.
static_assert(std::is_constructible_v<LayerBase, TriMesh&, RunContext> && !std::is_constructible_v<LayerBase, TriMesh, RunContext>);
static_assert(std::is_constructible_v<EnvelopeScale, LayerBase&, EnvelopeOptions> && !std::is_constructible_v<EnvelopeScale, LayerBase, EnvelopeOptions>);
static_assert(std::is_constructible_v<Collider, LayerBase&, const TriMesh*, RunContext>);
static_assert(!std::is_constructible_v<Collider, LayerBase, const TriMesh*, RunContext>);

/// Directions along the vertex normals, heights drawn from [0, tallest] with a few collapsed vertices: a tangled envelope.
EnvelopeShape tangle(const LayerBase& base, double tallest, unsigned seed) {
  std::mt19937 random(seed);
  EnvelopeShape shape;
  for (const VertexId v : base.wall.points.ids()) {
    const double share = static_cast<double>(random() % 1000) / 1000.0;
    shape.direction.push_back(base.vertex_normal[v]);
    shape.height.push_back(share < 0.1 ? 0.0 : share * tallest);
  }
  return shape;
}

/// Returns the same crossings from find_crossings over one indexed set, without sides; omits pairs of wall and outer boundary triangles among themselves.
std::set<BoundaryCrossing> slow_crossings(const LayerBase& base, const TriMesh* outer, const EnvelopeShape& shape) {
  test::EnvelopeSurface all = test::envelope_surface(base, shape, k_context);
  std::vector<BoundaryTriangle> name;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const TriangleId t : base.wall.triangles.ids()) {
    const TriangleVertices& v = base.wall.triangles[t];
    if (shape.is_collapsed(v[0]) && shape.is_collapsed(v[1]) && shape.is_collapsed(v[2])) continue;
    triangles.push_back(all.triangles[t.index()]);
    name.push_back({BoundaryPart::top, t.value()});
  }
  for (const TriangleId t : base.wall.triangles.ids()) {
    const TriangleVertices& v = base.wall.triangles[t];
    triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
    name.push_back({BoundaryPart::wall, t.value()});
  }
  const std::uint32_t shift = static_cast<std::uint32_t>(all.points.size());
  if (outer) {
    all.points.insert(all.points.end(), outer->points.begin(), outer->points.end());
    for (const TriangleId t : outer->triangles.ids()) {
      const TriangleVertices& v = outer->triangles[t];
      triangles.push_back({v[0].value() + shift, v[1].value() + shift, v[2].value() + shift});
      name.push_back({BoundaryPart::outer, t.value()});
    }
  }
  std::set<BoundaryCrossing> result;
  for (const auto& [i, j] : find_crossings(all.points, triangles, k_context).pairs)
    if (name[i].part == BoundaryPart::top || name[j].part == BoundaryPart::top) result.insert({std::min(name[i], name[j]), std::max(name[i], name[j])});
  return result;
}

std::set<BoundaryCrossing> as_set(const std::vector<BoundaryCrossing>& pairs) { return {pairs.begin(), pairs.end()}; }

TEST(Collider, AgreesWithOneSearchOverAllTriangles) {
  TriMesh wall = test::cube(4);
  TriMesh ball = test::sphere(4, 0.4);
  for (Point& p : ball.points) p += Vec3{1.6, 0.5, 0.5};
  append(wall, ball);
  TriMesh outer = test::sphere(5, 1.7);
  for (Point& p : outer.points) p += Vec3{1.0, 0.5, 0.5};
  const LayerBase base(wall, k_context);
  Collider collider(base, &outer, k_context);
  for (const unsigned seed : {1u, 2u, 3u}) {
    const EnvelopeShape shape = tangle(base, 0.6, seed);
    collider.move_top(shape, k_context);
    const std::vector<BoundaryCrossing> found = collider.crossings(k_context);
    const std::set<BoundaryCrossing> expected = slow_crossings(base, &outer, shape);
    EXPECT_EQ(as_set(found), expected);
    EXPECT_EQ(found.size(), expected.size());  // each pair is found once
    const auto has = [&](BoundaryPart part) {
      return std::any_of(found.begin(), found.end(), [part](const BoundaryCrossing& c) { return c[1].part == part; });
    };
    EXPECT_TRUE(has(BoundaryPart::top) && has(BoundaryPart::wall) && has(BoundaryPart::outer));
  }
}

TEST(Collider, SearchAroundMoveFindsAllNewCrossings) {
  const TriMesh wall = test::sphere(8);
  const LayerBase base(wall, k_context);
  Collider collider(base, nullptr, k_context);
  EnvelopeShape shape = tangle(base, 0.0, 1);
  for (const VertexId v : wall.points.ids()) shape.height[v] = 0.1;
  collider.move_top(shape, k_context);
  EXPECT_TRUE(collider.crossings(k_context).empty());
  std::vector<VertexId> moved;
  for (const int i : {3, 77, 400}) {
    moved.push_back(VertexId(i));
    shape.direction[VertexId(i)] = normalized(Vec3{1, 0.3 * i, -1});
    shape.height[VertexId(i)] = 0.7;
  }
  collider.move_top(shape, k_context);
  const std::vector<BoundaryCrossing> around = collider.crossings(k_context, &moved);
  EXPECT_FALSE(around.empty());
  EXPECT_EQ(around, collider.crossings(k_context));
}

TEST(Collider, SidesStandOnTheBoundaryOfTheWall) {
  // One triangle below another; the side of the lower layer runs into the upper triangle.
  TriMesh wall;
  wall.patches.push_back({"two", PatchKind::wall});
  wall.points = Column<VertexId, Point>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, -1, 0.5}, {0.2, 0.2, 0.5}, {0.4, -1, 0.5}});
  wall.triangles = {{VertexId(0), VertexId(1), VertexId(2)}, {VertexId(3), VertexId(5), VertexId(4)}};
  wall.triangle_patch = {PatchId(0), PatchId(0)};
  const LayerBase base(wall, k_context);
  Collider collider(base, nullptr, k_context);
  EXPECT_TRUE(collider.fixed_crossings(k_context).empty());
  EnvelopeShape shape;
  for (int i = 0; i < 6; ++i) {
    shape.direction.push_back({0, 0, 1});
    shape.height.push_back(i < 3 ? 0.8 : 0.05);
  }
  collider.move_top(shape, k_context);
  bool has_side_through_wall = false;
  for (const BoundaryCrossing& pair : collider.crossings(k_context)) {
    EXPECT_TRUE(pair[0].part == BoundaryPart::side || pair[1].part == BoundaryPart::side);
    has_side_through_wall = has_side_through_wall || (pair[0].part == BoundaryPart::side && pair[1].part == BoundaryPart::wall);
    // At the share found, the two are clear of each other; slightly above it they cross.
    if (pair[1].part == BoundaryPart::wall) {
      EXPECT_NEAR(collider.clear_share(pair, shape), 0.5 / 0.8, 2e-3);
    }
  }
  EXPECT_TRUE(has_side_through_wall);
  for (int i = 0; i < 3; ++i) shape.height[VertexId(i)] = 0.4;
  collider.move_top(shape, k_context);
  EXPECT_TRUE(collider.crossings(k_context).empty());
  EXPECT_EQ(collider.n_triangles(), 2 + 2 + 12);
}

TEST(Collider, SamePairsForAnyNumberOfThreads) {
  const TriMesh wall = test::sphere(12);
  const LayerBase base(wall, k_context);
  EnvelopeShape shape = tangle(base, 0.8, 7);
  for (const VertexId v : wall.points.ids()) shape.direction[v] = normalized(shape.direction[v] + Vec3{0.3 * (v.value() % 7), 0, 0.5});
  std::vector<std::vector<BoundaryCrossing>> found;
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    Collider collider(base, nullptr, context);
    collider.move_top(shape, context);
    found.push_back(collider.crossings(context));
  }
  EXPECT_FALSE(found[0].empty());
  EXPECT_EQ(found[1], found[0]);
  EXPECT_EQ(found[2], found[0]);
}

EnvelopeOptions thick_layers() {
  EnvelopeOptions options;
  options.first_height = 1e-4;
  options.layers = 20;
  options.max_thickness = 0.5;
  options.max_growth = 1.6;
  return options;
}

TEST(RetractCollisions, LayersStayInsideACloseOuterBoundary) {
  const TriMesh wall = test::sphere(6);
  const TriMesh outer = test::sphere(6, 1.12);
  const LayerBase base(wall, k_context);
  Collider collider(base, &outer, k_context);
  require_clear_input(collider, k_context);
  const EnvelopeOptions options = thick_layers();
  Envelope envelope = initial_envelope(base, options, k_context);
  share_gaps(base, options, collider, envelope, k_context);
  retract_collisions(base, options, collider, envelope, k_context);
  const EnvelopeCertificate certificate = certify_envelope(base, collider, envelope, k_context);
  EXPECT_TRUE(certificate.is_proved()) << to_text(certificate);
  for (const VertexId v : wall.points.ids()) {
    EXPECT_GT(envelope.height[v], 0.05);
    EXPECT_LT(envelope.height[v], 0.12);
  }
}

TEST(RetractCollisions, BodyInsideAnothersLayerIsDetected) {
  TriMesh wall = test::sphere(4);
  TriMesh crumb = test::sphere(1, 0.02);
  for (Point& p : crumb.points) p += Vec3{0, 0, 1.2};
  append(wall, crumb);
  const LayerBase base(wall, k_context);
  Collider collider(base, nullptr, k_context);
  const EnvelopeOptions options = thick_layers();
  Envelope envelope = initial_envelope(base, options, k_context);
  for (const VertexId v : wall.points.ids()) envelope.height[v] = norm(wall.points[v]) < 1.1 ? 0.4 : 0.01;
  retract_collisions(base, options, collider, envelope, k_context);
  const EnvelopeCertificate certificate = certify_envelope(base, collider, envelope, k_context);
  EXPECT_TRUE(certificate.is_proved()) << to_text(certificate);
}

TEST(RequireClearInput, TellsAWallThatReachesTheOuterBoundary) {
  const TriMesh wall = test::cube(3);
  const TriMesh outer = test::sphere(4, 1.2);
  const LayerBase base(wall, k_context);
  Collider collider(base, &outer, k_context);
  try {
    require_clear_input(collider, k_context);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::self_intersection);
    EXPECT_NE(std::string(error.what()).find("outer boundary"), std::string::npos);
    EXPECT_FALSE(error.info().locations.empty());
    EXPECT_FALSE(error.info().geometry.empty());
  }
}

TEST(ApplyWhereClear, TakesWhatFitsAndNothingElse) {
  TriMesh wall = test::cube(5);
  TriMesh other = wall;
  for (Point& p : other.points) p.x += 1.2;
  append(wall, other);
  const LayerBase base(wall, k_context);
  Collider collider(base, nullptr, k_context);
  Envelope envelope = initial_envelope(base, thick_layers(), k_context);
  for (double& h : envelope.height) h = 0.05;
  const EnvelopeShape before = envelope;
  EnvelopeShape proposal = envelope;
  for (double& h : proposal.height) h = 0.15;
  const std::vector<VertexId> moved = apply_where_clear(base, collider, envelope, proposal, k_context);
  const EnvelopeCertificate certificate = certify_envelope(base, collider, envelope, k_context);
  EXPECT_TRUE(certificate.is_proved()) << to_text(certificate);
  Column<VertexId, std::uint8_t> is_moved(wall.n_vertices(), 0);
  for (const VertexId v : moved) is_moved[v] = 1;
  int n_free = 0, n_facing = 0;
  for (const VertexId v : wall.points.ids()) {
    EXPECT_EQ(envelope.height[v], is_moved[v] ? 0.15 : 0.05);
    const double x = wall.points[v].x;
    if (x == 0.0) n_free += is_moved[v];
    if (x == 1.0) n_facing += is_moved[v];
  }
  EXPECT_EQ(n_free, 36);
  EXPECT_EQ(n_facing, 0);  // 0.15 + 0.15 does not fit into 0.2
}

TEST(Certificate, CountsWhatIsWrongAndNamesTheWorst) {
  const TriMesh wall = test::sphere(4);
  const LayerBase base(wall, k_context);
  Collider collider(base, nullptr, k_context);
  Envelope envelope = initial_envelope(base, thick_layers(), k_context);
  EnvelopeCertificate good = certify_envelope(base, collider, envelope, k_context);
  EXPECT_TRUE(good.is_proved());
  EXPECT_EQ(good.n_macro_elements, static_cast<std::int64_t>(wall.n_triangles()));
  EXPECT_EQ(good.n_triangles, 2 * static_cast<std::int64_t>(wall.n_triangles()));
  EXPECT_GT(good.worst_macro_element.quality, 0.3);
  envelope.direction[VertexId(5)] = -envelope.direction[VertexId(5)];
  const EnvelopeCertificate bad = certify_envelope(base, collider, envelope, k_context);
  EXPECT_FALSE(bad.is_proved());
  EXPECT_GT(bad.n_crossings, 0);
  EXPECT_GE(bad.n_invalid_macro_elements, 5);
  EXPECT_LE(bad.worst_macro_element.quality, 0.0);
  EXPECT_LT(distance(bad.worst_macro_element.location, wall.points[VertexId(5)]), 0.5);
  test::expect_error(ErrorCode::envelope_failed, "invalid macro-elements", [&] { (void)require_proved(bad); });
}

}  // namespace
}  // namespace sterna::volmesh
