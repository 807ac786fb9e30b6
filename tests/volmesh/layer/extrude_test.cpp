// Growth lines, curving, repair and certificate of the extruded layer on shapes with hand-calculated results.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/case/growth_law.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/layer/extrude.h"
#include "volmesh/layer/first_node.h"
#include "volmesh/layer/layer_cells.h"
#include "volmesh/layer/layer_line.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

/// The layer can be taken only from an extruder that is given up.
template <class T>
concept CanTakeTwice = requires(T& extruder) {
  extruder.take();
};
static_assert(!CanTakeTwice<Extruder>);
static_assert(!std::is_constructible_v<Extruder, LayerBase, EnvelopeOptions, PrismOptions, RunContext>);

EnvelopeOptions layers_of(double h0, int n) {
  EnvelopeOptions options;
  options.first_height = h0;
  options.max_growth = 1.4;  // the law of eq. (1); uniform growth has separate tests
  options.growth = "local";
  options.layers = n;
  return options;
}

/// Returns an envelope of constant height along the vertex normals.
Envelope even_envelope(const LayerBase& base, double height) {
  const std::size_t n = base.wall.n_vertices();
  Envelope envelope;
  envelope.direction = base.vertex_normal;
  envelope.height.assign(n, height);
  envelope.target = envelope.eq1 = envelope.cap = envelope.height;
  envelope.limit.assign(n, HeightLimit::none);
  return envelope;
}

/// Returns `d` tilted by `angle` (radians) towards +x, or towards +y if `d` is along x.
Vec3 leant(const Vec3& d, double angle) {
  const Vec3 aside = std::abs(d.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 tangent = normalized(aside - dot(aside, d) * d);
  return std::cos(angle) * d + std::sin(angle) * tangent;
}

VertexId face_centre(const TriMesh& cube) {
  for (const VertexId v : cube.points.ids())
    if (distance(cube.points[v], {0.5, 0.5, 1.0}) < 1e-12) return v;
  ADD_FAILURE();
  return VertexId(0);
}

TEST(LayerLine, NodeDistancesAlongNormalFollowGrowthLaw) {
  const TriMesh cube = test::cube(4);
  const LayerBase base(cube, k_context);
  const VertexId v = face_centre(cube);
  const int n = 12;
  const double h0 = 1e-3, height = 0.1;
  Envelope envelope = even_envelope(base, height);
  for (const double angle : {0.0, 0.3, 1.0}) {
    envelope.direction[v] = leant({0, 0, 1}, angle);
    const double h_n = height * std::cos(angle);
    std::vector<double> t(n + 1);
    layer_parameters(h0, h_n, n, t.data());
    for (const double c_t : {0.0, 0.05, 0.2, 1.0}) {
      LinePlacer placer(base, scale_of(base, layers_of(h0, n)));
      std::vector<Point> p(n + 1);
      placer.place(envelope, v, c_t, p.data());
      EXPECT_EQ(p[0], cube.points[v]);
      EXPECT_EQ(p[n], envelope.point(cube, v));  // to the bit
      EXPECT_NEAR(p[1].z - 1.0, h0, 1e-14);
      for (std::size_t j = 1; j <= n; ++j) EXPECT_NEAR(p[j].z - 1.0, t[j] * h_n, 1e-14);
      // A curved line leaves the wall along the normal, a straight line along the growth direction.
      const double slope = (p[1].x - p[0].x) / (p[1].z - p[0].z);
      if (c_t == 0.0) EXPECT_NEAR(slope, std::tan(angle), 1e-9);
      else EXPECT_LT(slope, 0.4 * std::tan(angle) + 1e-9);
    }
  }
}

TEST(LayerLine, LineWithoutRoomIsEquallySpaced) {
  const TriMesh cube = test::cube(4);
  const LayerBase base(cube, k_context);
  const VertexId v = face_centre(cube);
  Envelope envelope = even_envelope(base, 0.012);
  envelope.direction[v] = leant({0, 0, 1}, 0.9);  // h > n h0, but not along the normal
  EXPECT_LT(normal_height(base, envelope, v), 0.01);
  LinePlacer placer(base, scale_of(base, layers_of(1e-3, 10)));
  std::vector<Point> p(11);
  placer.place(envelope, v, 0.1, p.data());
  for (std::size_t j = 0; j <= 10; ++j) EXPECT_NEAR(p[j].z - 1.0, 0.1 * static_cast<double>(j) * normal_height(base, envelope, v), 1e-14);
}

TEST(LayerLine, LinesOnPlaneKeepItsCoordinateExactly) {
  const TriMesh cube = test::cube(4);
  const VertexId v = face_centre(cube);
  Constraints constraints;
  constraints.vertex.resize(cube.n_vertices());
  constraints.vertex[v] = {Freedom::plane, {0, 1, 0}, {0, -1}};
  constraints.surfaces.push_back(std::make_shared<ConstraintPlane>(Point{0, 0.5, 0}, Vec3{0, 1, 0}));
  const LayerBase base(cube, k_context, std::move(constraints));
  Envelope envelope = even_envelope(base, 0.1);
  envelope.direction[v] = constrained(base.constraint[v], Vec3{0.31, 0.17, 0.93});
  LinePlacer placer(base, scale_of(base, layers_of(1e-3, 12)));
  std::vector<Point> p(13);
  placer.place(envelope, v, 0.1, p.data());
  for (const Point& node : p) EXPECT_EQ(node.y, 0.5);
}

TEST(Curving, StaysBelowLimitsAndIsUnchangedFarAway) {
  const TriMesh sphere = test::sphere(12);
  const LayerBase base(sphere, k_context);
  Curving curving(base, 0.2);
  EXPECT_TRUE(curving.smooth(k_context).empty());
  curving.limit(VertexId(7), 0.01);
  const std::vector<VertexId> changed = curving.smooth(k_context);
  EXPECT_TRUE(std::is_sorted(changed.begin(), changed.end()));
  EXPECT_DOUBLE_EQ(curving[VertexId(7)], 0.01);
  for (const VertexId v : base.topology.neighbours(VertexId(7))) {
    EXPECT_LT(curving[v], 0.2);
    EXPECT_GT(curving[v], 0.01);
  }
  std::int64_t n_reduced = 0;
  for (const std::int64_t n : curving.distribution()) n_reduced += n;
  EXPECT_EQ(n_reduced, static_cast<std::int64_t>(changed.size()));
  EXPECT_LT(changed.size(), 80u);
  std::vector<double> before;
  for (const VertexId v : sphere.points.ids()) before.push_back(curving[v]);
  curving.limit(VertexId(8), 0.0);
  curving.limit(VertexId(7), 0.1);  // not below the present value
  curving.smooth(k_context);
  EXPECT_EQ(curving[VertexId(8)], 0.0);
  for (const VertexId v : sphere.points.ids()) EXPECT_LE(curving[v], before[v.index()]);
  EXPECT_EQ(curving.distribution()[0], 1);
}

TEST(Extrude, EvenLayerOnSphereNeedsNoRepair) {
  const TriMesh sphere = test::sphere(8);
  const LayerBase base(sphere, k_context);
  const EnvelopeOptions options = layers_of(1e-3, 10);
  Envelope envelope = even_envelope(base, 0.05);
  const Extrusion extrusion = extrude_prisms(base, options, {.wall_perpendicularity = 0.1}, envelope, k_context);
  EXPECT_EQ(extrusion.n_straightened, 0);
  ASSERT_EQ(extrusion.points.size(), sphere.n_vertices() * 11);
  const LayerCertificate certificate = certify_layer(extrusion.layers, extrusion.points, k_context);
  EXPECT_EQ(certificate.n_cells, static_cast<std::int64_t>(sphere.n_triangles()) * 10);
  EXPECT_EQ(certificate.n_proved, certificate.n_cells);
  EXPECT_GT(certificate.min_quality, 0.5);
  EXPECT_NEAR(norm(certificate.worst_location), 1.02, 0.05);
  const FirstNodeReport first = first_node_report(base, classify_vertices(base, options, k_context), options, envelope, extrusion, k_context);
  EXPECT_EQ(first.vertex_share, 1.0);
  EXPECT_EQ(first.facet_share, 1.0);
  EXPECT_EQ(first.ridge_area, 0.0);
  EXPECT_EQ(first.n_lines, static_cast<std::int64_t>(sphere.n_vertices()));
  EXPECT_EQ(first.n_compressed + first.n_collapsed, 0);
}

/// On a flat face, one line leans far over the wall point of its neighbour: the layer is valid if straight, but not if both curves start along the wall normal.
struct LeaningCase {
  TriMesh cube = test::cube(8);
  LayerBase base{cube, k_context};
  EnvelopeOptions options = layers_of(1e-3, 16);
  Envelope envelope = even_envelope(base, 0.12);
  LeaningCase() {
    for (const VertexId v : cube.points.ids())
      if (distance(cube.points[v], {0.5, 0.5, 1.0}) < 0.3) envelope.direction[v] = leant({0, 0, 1}, v.value() % 2 == 0 ? 0.7 : -0.2);
  }
};

TEST(Extrude, CurvingIsReducedLocallyBeforeHeights) {
  LeaningCase c;
  const Column<VertexId, double> heights = c.envelope.height;
  const Extrusion straight = extrude_prisms(c.base, c.options, {.wall_perpendicularity = 0.0}, c.envelope, k_context);
  ASSERT_EQ(c.envelope.height, heights) << "the case is meant to be valid with straight lines";
  EXPECT_EQ(straight.n_straightened, 0);
  const Extrusion curved = extrude_prisms(c.base, c.options, {.wall_perpendicularity = 0.5}, c.envelope, k_context);
  EXPECT_EQ(c.envelope.height, heights);
  EXPECT_GT(curved.n_straightened, 0);
  EXPECT_LT(curved.n_straightened, static_cast<std::int64_t>(c.cube.n_vertices()) / 2);
  std::int64_t n = 0;
  for (const std::int64_t part : curved.curving_shares) n += part;
  EXPECT_EQ(n, curved.n_straightened);
  const LayerCertificate certificate = certify_layer(curved.layers, curved.points, k_context);
  EXPECT_EQ(certificate.n_proved, certificate.n_cells);
}

TEST(Extrude, CurvedLinesGrowLittleMoreThanTheirHeights) {
  LeaningCase c;
  const Extrusion curved = extrude_prisms(c.base, c.options, {.wall_perpendicularity = 1.0}, c.envelope, k_context);
  const EnvelopeScale scale = scale_of(c.base, c.options);
  for (const VertexId v : c.cube.points.ids()) {
    const double own = growth_for_height(1e-3, normal_height(c.base, c.envelope, v), 16);
    double worst = 1.0;
    const auto step = [&](int j) {
      return distance(curved.points[curved.layers.node(v.value(), j).index()], curved.points[curved.layers.node(v.value(), j + 1).index()]);
    };
    for (int j = 0; j + 1 < 16; ++j) worst = std::max(worst, step(j + 1) / step(j));
    EXPECT_LE(worst, std::max(1.03 * own, std::min(1.16 * own, 1.46)));
  }
}

TEST(LayerCells, SidesAreCutAlongOneDiagonalOrNone) {
  // A unit square between two prisms; its upper corner is pushed towards one prism and then towards the other.
  const auto can_be_cut = [](double push, bool has_beyond) {
    const std::array<Point, 2> from = {Point{0, 0, 0}, {0, 0, 1}}, to = {Point{1, 0, 0}, {1, push, 1}}, own = {Point{0.5, 1, 0}, {0.5, 1, 1}},
                               beyond = {Point{0.5, -1, 0}, {0.5, -1, 1}};
    return side_shape({from.data(), to.data(), own.data(), has_beyond ? beyond.data() : nullptr}, 0, 1).cut_share >= k_good_cut_share;
  };
  for (const bool has_beyond : {false, true})
    for (const double push : {-0.5, 0.0, 0.5}) EXPECT_TRUE(can_be_cut(push, has_beyond)) << push;
  EXPECT_TRUE(can_be_cut(-3.0, false));
  EXPECT_FALSE(can_be_cut(-3.0, true));
  EXPECT_FALSE(can_be_cut(3.0, true));
}

TEST(Extrude, LeavesFewSidesThatCannotBeCut) {
  LeaningCase c;
  const auto n_uncut = [&](const Extrusion& x) {
    int n = 0;
    for (std::size_t h = 0; h < c.base.topology.n_halfedges(); ++h) {
      const HalfedgeId side(h), twin = c.base.topology.twin(side);
      const auto line = [&](VertexId v) { return x.points.data() + x.layers.first_node[v.index()]; };
      const Topology& topology = c.base.topology;
      const SideLines lines = {line(topology.from(side)), line(topology.to(side)), line(topology.from(previous(side))), line(topology.from(previous(twin)))};
      n += side_shape(lines, 13, 16).cut_share < k_good_cut_share;
    }
    return n;
  };
  const Extrusion straight = extrude_prisms(c.base, c.options, {.wall_perpendicularity = 0.0}, c.envelope, k_context);
  const Extrusion curved = extrude_prisms(c.base, c.options, {.wall_perpendicularity = 1.0}, c.envelope, k_context);
  EXPECT_LE(n_uncut(curved), n_uncut(straight));
}

TEST(Extrude, SameBytesForAnyNumberOfThreads) {
  std::vector<Extrusion> results;
  for (const int threads : {1, 2, 7}) {
    LeaningCase c;
    const RunContext context({.threads = threads});
    results.push_back(extrude_prisms(c.base, c.options, {.wall_perpendicularity = 0.5}, c.envelope, context));
  }
  EXPECT_EQ(results[0].points, results[1].points);
  EXPECT_EQ(results[0].points, results[2].points);
  EXPECT_EQ(results[0].curving_shares, results[2].curving_shares);
}

TEST(Extrude, SecondCallFollowsEnvelopeLikeFirst) {
  LeaningCase c;
  const PrismOptions options{.wall_perpendicularity = 0.0};
  Extruder extruder(c.base, c.options, options, k_context);
  extruder.extrude(c.envelope);
  const EnvelopeScale scale = scale_of(c.base, c.options);
  for (std::uint32_t i = 0; i < 40; ++i) lower(c.envelope, VertexId(i * 3), 0.1 - 0.001 * i, HeightLimit::gap, scale);
  lower(c.envelope, VertexId(50), 0.0, HeightLimit::gap, scale);
  lower(c.envelope, VertexId(51), 0.0, HeightLimit::gap, scale);
  Envelope other = c.envelope;
  extruder.extrude(c.envelope);
  const Extrusion second = std::move(extruder).take();
  const Extrusion first = extrude_prisms(c.base, c.options, options, other, k_context);
  ASSERT_EQ(second.n_straightened, 0) << "else the curving of the first call remains";
  EXPECT_EQ(c.envelope.height, other.height);
  EXPECT_EQ(second.points, first.points);
  EXPECT_EQ(second.layers.first_node, first.layers.first_node);
  EXPECT_EQ(second.layers.is_collapsed, first.layers.is_collapsed);
  const LayerCertificate certificate = certify_layer(second.layers, second.points, k_context);
  EXPECT_EQ(certificate.n_proved, certificate.n_cells);
}

TEST(LayerCertificate, CountsUnprovedElementsAndFindsWorst) {
  const TriMesh sphere = test::sphere(6);
  const LayerBase base(sphere, k_context);
  Envelope envelope = even_envelope(base, 0.05);
  Extrusion extrusion = extrude_prisms(base, layers_of(1e-3, 10), {}, envelope, k_context);
  const std::uint32_t line = 11;
  Point& node = extrusion.points[extrusion.layers.node(line, 4).index()];
  node = 0.9 * base.wall.points[VertexId(line)];  // below the wall
  const LayerCertificate certificate = certify_layer(extrusion.layers, extrusion.points, k_context);
  const std::int64_t n_columns = static_cast<std::int64_t>(base.topology.outgoing(VertexId(line)).size());
  EXPECT_EQ(certificate.n_cells - certificate.n_proved, n_columns);  // the cells below the node
  EXPECT_LT(certificate.min_quality, 0.0);
  EXPECT_EQ(certificate.worst_layer, 3);
  const auto& lines = extrusion.layers.base[static_cast<std::size_t>(certificate.worst_column)];
  EXPECT_TRUE(std::find(lines.begin(), lines.end(), line) != lines.end());
}

TEST(FirstNode, RidgesAreCountedApart) {
  const TriMesh cube = test::cube(4);
  const LayerBase base(cube, k_context);
  const EnvelopeOptions options = layers_of(1e-3, 10);
  Envelope envelope = even_envelope(base, 0.05);
  const Extrusion extrusion = extrude_prisms(base, options, {}, envelope, k_context);
  const FirstNodeReport first = first_node_report(base, classify_vertices(base, options, k_context), options, envelope, extrusion, k_context);
  EXPECT_DOUBLE_EQ(first.vertex_share, 1.0);
  EXPECT_DOUBLE_EQ(first.facet_share, 1.0);   // the inner triangles of each face
  EXPECT_NEAR(first.ridge_area, 0.75, 0.01);  // all but the 2 x 2 inner squares of 4 x 4
}

TEST(FirstNode, WithinTwoPercentOnARealWing) {
  STERNA_NEEDS_SHARED_DATA();
  const TriMesh wall =
      surfmesh::stitch_surface({io::read_surface_file(test::shared_data() / "surfaces/clean/derived_crm_wb_dpw_coarse_full.off", k_context)}, {}, k_context)
          .mesh;
  const LayerBase base(wall, k_context);
  EnvelopeOptions options = layers_of(1e-6 * base.body_length, 20);
  options.max_thickness = 0.1 * base.body_length;
  Envelope envelope = build_envelope(base, options, k_context);
  const Extrusion extrusion = extrude_prisms(base, options, {.wall_perpendicularity = 0.1}, envelope, k_context);
  const FirstNodeReport first = first_node_report(base, classify_vertices(base, options, k_context), options, envelope, extrusion, k_context);
  EXPECT_GE(first.vertex_share, 0.99);
  EXPECT_GE(first.facet_share, 0.96);  // 0.968: normals of this coarse, stretched surface turn by more than 11 degrees
  EXPECT_LT(first.worst_vertex, 1e-9);
  const LayerCertificate certificate = certify_layer(extrusion.layers, extrusion.points, k_context);
  EXPECT_EQ(certificate.n_proved, certificate.n_cells);
  EXPECT_GT(certificate.min_quality, 0.0);
}

}  // namespace
}  // namespace sterna::volmesh
