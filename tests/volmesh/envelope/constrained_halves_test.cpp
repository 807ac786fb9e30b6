// Walls that end on planes: half and quarter bodies grow the same layer as the whole body, flush with the plane to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/envelope_surface.h"
#include "tests/support/error_of.h"
#include "tests/support/halves.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/constrain_borders.h"
#include "volmesh/envelope/keep_inside.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/validity.h"
#include "volmesh/layer/extrude.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

struct ConstrainedLayer {
  LayerBase base;
  Envelope envelope;
  Extrusion extrusion;
};

ConstrainedLayer grow(const TriMesh& wall, Constraints constraints, const EnvelopeOptions& options, double c_t = 0.1) {
  ConstrainedLayer layer{LayerBase(wall, k_context, std::move(constraints)), {}, {}};
  layer.envelope = build_envelope(layer.base, options, k_context);
  PrismOptions prisms;
  prisms.wall_perpendicularity = c_t;
  layer.extrusion = extrude_prisms(layer.base, options, prisms, layer.envelope, k_context);
  return layer;
}

ConstrainedLayer grow(const TriMesh& wall, const EnvelopeOptions& options) {
  return grow(wall, constraints_of_borders(wall, Topology(wall, k_context)), options);
}

EnvelopeOptions thin_layers_of(double h0, int n, double thickness = k_automatic) {
  EnvelopeOptions options;
  options.first_height = h0;
  options.max_growth = 1.4;  // the law of eq. (1); uniform growth has separate tests
  options.growth = "local";
  options.layers = n;
  options.max_thickness = thickness;
  return options;
}

std::int64_t n_invalid_cells(const Extrusion& extrusion) {
  std::int64_t n = 0;
  for (std::size_t c = 0; c < extrusion.layers.n_columns(); ++c) {
    if (extrusion.layers.n_collapsed(c) == 3) continue;
    for (int j = 0; j < extrusion.layers.n_layers; ++j) {
      const Cell cell = extrusion.layers.cell(c, j);
      const auto at = [&](std::size_t i) { return extrusion.points[cell.nodes[i].index()]; };
      const bool is_valid = cell.kind == CellKind::prism     ? is_wedge_valid({at(0), at(1), at(2), at(3), at(4), at(5)})
                            : cell.kind == CellKind::pyramid ? is_pyramid_valid({at(0), at(1), at(2), at(3), at(4)})
                                                             : is_tet_valid({at(0), at(1), at(2), at(3)});
      n += is_valid ? 0 : 1;
    }
  }
  return n;
}

/// Checks all properties that any constrained layer must have; returns the number of checked nodes on the layer boundary.
std::size_t expect_sound(const ConstrainedLayer& layer) {
  const LayerBase& base = layer.base;
  EXPECT_TRUE(invalid_macros(base, layer.envelope, k_context).empty());
  EXPECT_EQ(n_invalid_cells(layer.extrusion), 0);
  const test::EnvelopeSurface surface = test::envelope_surface(base, layer.envelope, k_context);
  EXPECT_EQ(find_crossings(surface.points, surface.triangles, k_context).total, 0);
  std::size_t n_nodes = 0;
  for (const VertexId v : base.wall.points.ids()) {
    EXPECT_TRUE(layer.envelope.is_collapsed(v) || is_inside(base, v, layer.envelope.height[v] * layer.envelope.direction[v]));
    const std::size_t first = layer.extrusion.layers.first_node[v.index()];
    const std::size_t end = first + (layer.extrusion.layers.is_collapsed[v.index()] ? 1 : static_cast<std::size_t>(layer.extrusion.layers.n_layers) + 1);
    for (const std::int32_t k : base.constraint[v].on) {
      if (k < 0 || base.constraint[v].freedom == Freedom::surface) continue;
      const Vec3 normal = base.surfaces[static_cast<std::size_t>(k)]->normal(base.wall.points[v]);
      for (std::size_t i = first; i < end; ++i, ++n_nodes)
        for (std::size_t axis = 0; axis < 3; ++axis)
          if (std::abs(normal[axis]) == 1.0) {
            EXPECT_EQ(layer.extrusion.points[i][axis], base.wall.points[v][axis]) << "layer " << i - first;
          }
    }
  }
  return n_nodes;
}

/// Returns the share of a half's vertices whose growth differs by more than the relative tolerance (1e-6 by default) from the same vertex of the whole body,
/// whose first vertices are those of the half.
double share_different(const ConstrainedLayer& half, const ConstrainedLayer& whole, double tolerance = 1e-6) {
  double n = 0.0;
  for (const VertexId v : half.base.wall.points.ids()) {
    const Vec3 a = half.envelope.height[v] * half.envelope.direction[v], b = whole.envelope.height[v] * whole.envelope.direction[v];
    n += distance(a, b) > tolerance * std::max(norm(a), norm(b)) ? 1.0 : 0.0;
  }
  return n / static_cast<double>(half.base.wall.n_vertices());
}

TEST(ConstrainRims, FindsPlanesOfHalfAndQuarterCubes) {
  const TriMesh cube = test::cube(4);
  EXPECT_TRUE(constraints_of_borders(cube, Topology(cube, k_context)).vertex.empty());
  const TriMesh half = test::cut_off(cube, 1, 0.5);
  const Constraints one = constraints_of_borders(half, Topology(half, k_context));
  ASSERT_EQ(one.surfaces.size(), 1u);
  EXPECT_EQ(one.surfaces[0]->normal({}), (Vec3{0, 1, 0}));
  std::size_t n_plane = 0;
  for (const VertexId v : half.points.ids()) {
    n_plane += one.vertex[v].freedom == Freedom::plane ? 1 : 0;
    EXPECT_EQ(one.vertex[v].freedom == Freedom::plane, half.points[v].y == 0.5);
  }
  EXPECT_EQ(n_plane, 16u);

  const TriMesh quarter = test::cut_off(half, 2, 0.5);
  const Constraints two = constraints_of_borders(quarter, Topology(quarter, k_context));
  ASSERT_EQ(two.surfaces.size(), 2u);
  std::size_t n_line = 0;
  for (const VertexId v : quarter.points.ids()) {
    if (two.vertex[v].freedom != Freedom::line) continue;
    ++n_line;
    EXPECT_EQ(std::abs(two.vertex[v].axis.x), 1.0);
    EXPECT_EQ(quarter.points[v].y, 0.5);
    EXPECT_EQ(quarter.points[v].z, 0.5);
  }
  EXPECT_EQ(n_line, 2u);
}

TEST(ConstrainRims, ObliquePlanesMayBeGiven) {
  TriMesh half = test::cut_off(test::cube(4), 1, 0.5);
  const double c = std::cos(0.3), s = std::sin(0.3);
  const auto turned = [&](const Vec3& p) { return Vec3{c * p.x - s * p.y, s * p.x + c * p.y, p.z}; };
  for (Point& p : half.points) p = turned(p);
  const Topology topology(half, k_context);
  test::expect_error(ErrorCode::open_surface, "8 edges lie in no plane x, y or z = constant", [&] { (void)constraints_of_borders(half, topology); });
  const ConstraintPlane plane(turned({0, 0.5, 0}), turned({0, -1, 0}));
  const ConstrainedLayer layer = grow(half, constraints_of_planes(half, topology, {&plane, 1}), thin_layers_of(1e-4, 12, 0.1));
  expect_sound(layer);
  for (const VertexId v : half.points.ids())
    if (layer.base.constraint[v].freedom == Freedom::plane) {
      EXPECT_NEAR(plane.inside_distance(layer.envelope.point(half, v)), 0.0, 1e-15);
    }
}

TEST(ConstrainRims, ErrorsSayWhere) {
  // A sphere with one vertex cut out obliquely: its open boundary lies in no plane of constant coordinate.
  TriMesh holed = test::sphere(4);
  std::size_t kept = 0;
  for (const TriangleId t : holed.triangles.ids()) {
    const auto [a, b, c] = corners(holed, t);
    const Vec3 out = normalized(Vec3{1, 2, 3});
    if (dot(out, (a + b + c) / 3.0) > 0.9) continue;
    holed.triangles[TriangleId(kept++)] = holed.triangles[t];
  }
  holed.triangles.resize(kept);
  holed.triangle_patch.resize(kept);
  try {
    constraints_of_borders(holed, Topology(holed, k_context));
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::open_surface);
    const std::string text = error.what();
    EXPECT_NE(text.find("1 open boundaries with"), std::string::npos) << text;
    EXPECT_NE(text.find("lie in no plane x, y or z = constant"), std::string::npos) << text;
    EXPECT_NE(text.find("half model"), std::string::npos) << text;
  }
  // A body that extends beyond the plane on which it ends.
  TriMesh beyond = test::cut_off(test::cube(4), 1, 0.5);
  TriMesh other = test::cube(2);
  for (Point& p : other.points) p.y -= 3.0;
  append(beyond, other);
  try {
    constraints_of_borders(beyond, Topology(beyond, k_context));
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("continues beyond the plane"), std::string::npos) << error.what();
  }
}

/// Disables stage 6, the optimiser: it visits vertices in an order that the mirror image changes, so that halves agree only within its convergence.
EnvelopeOptions without_optimiser(EnvelopeOptions options) {
  options.optimiser = "none";
  return options;
}

TEST(ConstrainedLayer, OptimisedHalfAgreesWithTheWholeCube) {
  const TriMesh half = test::cut_off(test::cube(8), 1, 0.5);
  EnvelopeOptions options = thin_layers_of(1e-4, 15, 0.15);
  options.optimiser_evaluations = 200;
  const ConstrainedLayer own = grow(half, options);
  EXPECT_EQ(expect_sound(own), 32u * 16u);
  const ConstrainedLayer full = grow(test::with_mirror_image(half, 1, 0.5), {}, options);
  double sum = 0.0;
  for (const VertexId v : half.points.ids()) sum += distance(own.envelope.point(half, v), full.envelope.point(half, v)) / full.envelope.height[v];
  EXPECT_LT(sum / static_cast<double>(half.n_vertices()), 0.02);  // the descent skips vertices that move less than 0.002 of their height
}

TEST(ConstrainedLayer, HalfCubeIsHalfOfTheCubesLayer) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const TriMesh half = test::cut_off(test::cube(8), axis, 0.5);
    const TriMesh whole = test::with_mirror_image(half, axis, 0.5);
    const EnvelopeOptions options = without_optimiser(thin_layers_of(1e-4, 15, 0.15));
    const ConstrainedLayer own = grow(half, options);
    EXPECT_EQ(expect_sound(own), 32u * 16u);
    const ConstrainedLayer full = grow(whole, {}, options);
    EXPECT_EQ(share_different(own, full), 0.0);
  }
}

TEST(ConstrainedLayer, QuarterCubeKeepsBothPlanesAndTheirLine) {
  const TriMesh half = test::cut_off(test::cube(8), 1, 0.5);
  const TriMesh quarter = test::cut_off(half, 2, 0.5);
  const TriMesh whole = test::with_mirror_image(test::with_mirror_image(quarter, 1, 0.5), 2, 0.5);
  const EnvelopeOptions options = without_optimiser(thin_layers_of(1e-4, 15, 0.15));
  const ConstrainedLayer own = grow(quarter, options);
  EXPECT_GT(expect_sound(own), 0u);
  const ConstrainedLayer full = grow(whole, {}, options);
  EXPECT_EQ(share_different(own, full), 0.0);
}

TEST(ConstrainedLayer, ConcaveWallsOfAQuarterBoxToo) {
  TriMesh half = test::cut_off(test::cube(8), 1, 0.5);
  for (const TriangleId t : half.triangles.ids()) std::swap(half.triangles[t][1], half.triangles[t][2]);  // the inside of the box
  const EnvelopeOptions options = without_optimiser(thin_layers_of(1e-4, 15, 0.15));
  const ConstrainedLayer own = grow(half, options);
  expect_sound(own);
  const ConstrainedLayer full = grow(test::with_mirror_image(half, 1, 0.5), {}, options);
  EXPECT_EQ(share_different(own, full), 0.0);
}

TEST(ConstrainedLayer, BodiesBesideThePlaneKeepClearOfIt) {
  // Half a cube on the plane, and a small cube whose gap to the plane is smaller than the layer height.
  TriMesh wall = test::cut_off(test::cube(8), 1, 0.5);
  TriMesh pod = test::cube(8);
  for (Point& p : pod.points) p = Vec3{3, 0.55, 0} + p;
  append(wall, pod);
  const ConstrainedLayer layer = grow(wall, thin_layers_of(1e-4, 15, 0.2));
  expect_sound(layer);
  for (const VertexId v : wall.points.ids()) {
    EXPECT_TRUE(wall.points[v].y == 0.5 || layer.envelope.point(wall, v).y > 0.5);
  }
  // The layer on the side towards the plane has the height that it would have beside its mirror image.
  const ConstrainedLayer full = grow(test::with_mirror_image(wall, 1, 0.5), {}, thin_layers_of(1e-4, 15, 0.2));
  for (const VertexId v : wall.points.ids()) {
    if (distance(wall.points[v], {3.5, 0.55, 0.5}) > 1e-9) continue;
    EXPECT_GT(layer.envelope.height[v], 0.5 * 0.05);
    EXPECT_NEAR(layer.envelope.height[v], full.envelope.height[v], 0.1 * 0.05);
  }
}

TEST(ConstrainedLayer, FixedVerticesStayOnTheWall) {
  const TriMesh half = test::cut_off(test::cube(8), 1, 0.5);
  Constraints constraints = constraints_of_borders(half, Topology(half, k_context));
  for (VertexConstraint& c : constraints.vertex)
    if (c.freedom == Freedom::plane) c.freedom = Freedom::fixed;
  const ConstrainedLayer layer = grow(half, std::move(constraints), thin_layers_of(1e-4, 15, 0.15));
  expect_sound(layer);
  for (const VertexId v : half.points.ids()) {
    EXPECT_EQ(layer.envelope.is_collapsed(v), half.points[v].y == 0.5);
    if (layer.envelope.is_collapsed(v)) {
      EXPECT_EQ(layer.envelope.limit[v], HeightLimit::fixed);
    }
  }
}

TEST(ConstrainedLayer, NodesLieOnCylinderWhereWallEnds) {
  // A half cube whose open boundary is bent onto a cylinder about the z axis with radius 3, the tunnel wall at y = -2.5 + 3.
  TriMesh half = test::cut_off(test::cube(8), 1, 0.5);
  const auto tunnel = std::make_shared<ConstraintCylinder>(Point{0.5, 3.0, 0}, Vec3{0, 0, 1}, 2.5);
  Constraints constraints;
  constraints.surfaces = {tunnel};
  constraints.vertex.resize(half.n_vertices());
  for (const VertexId v : half.points.ids()) {
    if (half.points[v].y != 0.5) continue;
    half.points[v] = tunnel->closest(half.points[v]);
    constraints.vertex[v] = {Freedom::surface, tunnel->normal(half.points[v]), {0, -1}};
  }
  const ConstrainedLayer layer = grow(half, constraints, thin_layers_of(1e-4, 15, 0.15));
  expect_sound(layer);
  std::size_t n_nodes = 0;
  for (const VertexId v : half.points.ids()) {
    if (constraints.vertex[v].freedom != Freedom::surface) continue;
    EXPECT_FALSE(layer.envelope.is_collapsed(v));
    EXPECT_GT(layer.envelope.height[v], 0.9 * layer.envelope.target[v]);
    for (std::size_t j = 0; j <= 15; ++j, ++n_nodes)
      EXPECT_NEAR(tunnel->inside_distance(layer.extrusion.points[layer.extrusion.layers.first_node[v.index()] + j]), 0.0, 1e-12) << j;
  }
  EXPECT_EQ(n_nodes, 32u * 16u);
}

TEST(ConstrainedLayer, SameBytesForAnyNumberOfThreads) {
  const TriMesh quarter = test::cut_off(test::cut_off(test::cube(8), 1, 0.5), 2, 0.5);
  std::vector<Envelope> results;
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    const Topology topology(quarter, context);
    results.push_back(build_envelope(LayerBase(quarter, context, constraints_of_borders(quarter, topology)), thin_layers_of(1e-4, 15, 0.15), context));
  }
  for (const Envelope& envelope : results) {
    EXPECT_EQ(envelope.height, results[0].height);
    EXPECT_EQ(envelope.direction, results[0].direction);
  }
}

TEST(ConstrainedLayer, HalfWingHasHalfOfTheLayer) {
  STERNA_NEEDS_SHARED_DATA();
  const SurfaceSoup soup = io::read_surface_file(test::shared_data() / "surfaces/clean/pygeo_bwb.stl", k_context);
  const TriMesh wing = surfmesh::stitch_surface({soup}, {}, k_context).mesh;
  const double cut = 8.0;  // m of 30 along the span: a section with both edges of the wing
  const TriMesh half = test::cut_off(wing, 0, cut);
  const double length = body_length(half);
  const EnvelopeOptions options = thin_layers_of(1e-6 * length, 35, 0.1 * length);
  const ConstrainedLayer own = grow(half, options);
  EXPECT_GT(expect_sound(own), 0u);
  const ConstrainedLayer full = grow(test::with_mirror_image(half, 0, cut), {}, options);
  // The optimiser visits the vertices of the whole body in another order and stops before full convergence, so decisions at a threshold may differ.
  EXPECT_LT(share_different(own, full, 0.01), 0.002);
}

}  // namespace
}  // namespace sterna::volmesh
