#include "surfmesh/model/surface_sizes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "geom/model/analytic_surfaces.h"
#include "geom/model/components.h"
#include "geom/model/curves.h"
#include "geom/model/model_builder.h"
#include "geom/model/shapes.h"
#include "surfmesh/model/surface_mesh.h"
#include "tests/support/model_meshes.h"
#include "tests/support/test_constants.h"

namespace sterna::surfmesh {
namespace {

using std::numbers::pi;
using test::k_context;
constexpr double k_growth = 0.2;

/// Returns a repeatable number in [0, 1).
double share_of(int i, double by) { return std::abs(std::sin(by * (i + 1.0))) * 1e4 - std::floor(std::abs(std::sin(by * (i + 1.0))) * 1e4); }

/// The size field of a model whose faces have the target size `largest`, with the sizes required by edges changed by `request`.
struct Field {
  const Model& model;
  Column<EdgeId, EdgeSamples> edges;
  ModelSizes sizes;
  ModelTopology topology;

  Field(const Model& m, double largest, double angle) : model(m), edges(sample_edges(m, k_context)) {
    SurfaceMeshOptions options;
    options.sizes.max_edge = largest;
    options.sizes.curvature_angle = angle;
    options.sizes.growth = 1.0 + k_growth;
    options.sizes.min_edge = 1e-4 * largest;
    options.sizes.narrow = 100.0;
    sizes = sizes_of_faces(model, edges, options, {}, k_context);
    add_local_sizes(model, edges, options, {}, sizes);
    std::vector<AbsorbedPart> absorbed;
    topology = absorb_small_parts(model, edges, sizes, absorbed);
    add_sources(model, edges, topology, options, sizes, k_context);
    for (auto& requested : sizes.edge_sizes)  // lengths of short edges are not tested here
      for (double& size : requested) size = largest;
  }
  void request(EdgeId e, std::size_t sample, double size) {
    sizes.edge_sizes[e][sample] = size;
    sizes.sources.push_back({edges[e].samples[sample].point, size});
  }
  /// Sets one size along a whole edge.
  void request_along(EdgeId e, double size) {
    for (double& s : sizes.edge_sizes[e]) s = size;
    const ModelEdge& edge = model.edges[e];
    const auto n = static_cast<int>(std::ceil(edges[e].length / size));
    for (int i = 0; i <= n; ++i) sizes.sources.push_back({edge.curve->point(edge.range.from + edge.range.length() * i / n), size});
  }
  SurfaceSizes made(std::vector<SizePoint> in_space = {}) const { return SurfaceSizes(model, edges, topology, sizes, std::move(in_space), k_context); }
};

/// Largest and mean of |field / exact - 1| over a face.
struct Difference {
  double largest = 0.0;
  double mean = 0.0;
  std::string location;  ///< where `largest` occurs
};
Difference difference_on(const Model& model, FaceId f, const ParameterBox& box, const SurfaceSizes& field,
                         const std::function<double(Uv, const Point&)>& exact) {
  constexpr int n = 5000;
  Difference result;
  for (int i = 0; i < n; ++i) {
    const Uv at{box.u.from + share_of(i, 12.9898) * box.u.length(), box.v.from + share_of(i, 78.233) * box.v.length()};
    const Point p = model.faces[f].surface->point(at);
    if (model.faces[f].surface->kind() == "plane" && (std::min(p.x, p.y) < 0.0 || std::max(p.x, p.y) > 1.0)) continue;  // beyond the face
    const double off = std::abs(field.on_face(f, at, p) / exact(at, p) - 1.0);
    if (off > result.largest) {
      result.largest = off;
      result.location = std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + ": " + std::to_string(field.on_face(f, at, p)) + " for " +
                        std::to_string(exact(at, p));
    }
    result.mean += off / n;
  }
  return result;
}

Model plate(const std::string& name, double z) {
  ModelBuilder builder({.name = name, .kind = ComponentKind::unknown});
  const CornerId a = builder.corner({0, 0, z}), b = builder.corner({1, 0, z}), c = builder.corner({1, 1, z}), d = builder.corner({0, 1, z});
  builder.plane({builder.straight_edge(a, b), builder.straight_edge(b, c), builder.straight_edge(c, d), builder.straight_edge(d, a)}, FaceRole::skin, name);
  return builder.model();
}

/// Returns the outside of a tube along z: edges are the lower circle, the seam, the upper circle.
Model open_tube(double radius, double length) {
  ModelBuilder builder({.name = "tube", .kind = ComponentKind::unknown});
  const ParameterBox box{k_full_turn, {0.0, length}};
  const auto surface = std::make_shared<CylinderSurface>(Frame{}, radius, box);
  const CornerId low = builder.corner({radius, 0, 0}), high = builder.corner({radius, 0, length});
  const EdgeId lower = builder.edge(std::make_shared<EllipseCurve>(Point{}, Vec3{radius, 0, 0}, Vec3{0, radius, 0}, k_full_turn), k_full_turn, low, low);
  const EdgeId seam = builder.edge(std::make_shared<LineCurve>(Point{radius, 0, 0}, Vec3{0, 0, 1}, box.v), box.v, low, high);
  const EdgeId upper =
      builder.edge(std::make_shared<EllipseCurve>(Point{0, 0, length}, Vec3{radius, 0, 0}, Vec3{0, radius, 0}, k_full_turn), k_full_turn, high, high);
  builder.patch(surface, box, {lower, seam, upper, seam}, FaceRole::skin, "tube");
  return builder.model();
}

constexpr FaceId k_first_face(0);

TEST(SurfaceSizes, GrowFromAFineEdgeOverAPlane) {
  const Model model = plate("plate", 0.0);
  Field field(model, 0.3, 0.2);
  const EdgeId e = model.faces[k_first_face].borders[0][0].edge;
  field.request_along(e, 0.002);
  const SurfaceSizes made = field.made();
  const ParameterBox box = model.faces[k_first_face].surface->domain();
  const EdgeSamples& line = field.edges[e];
  const auto exact = [&](Uv, const Point& p) {
    return std::min(0.3, 0.002 + k_growth * distance_to_segment(p, line.samples.front().point, line.samples.back().point));
  };
  const Difference off = difference_on(model, k_first_face, box, made, exact);
  EXPECT_LT(off.largest, 0.06) << off.location;
  EXPECT_LT(off.mean, 0.01);
  for (int i = 0; i <= 10; ++i) EXPECT_NEAR(made.on_edge(e, model.edges[e].range.from + 0.1 * i * model.edges[e].range.length()), 0.002, 1e-12);
}

TEST(SurfaceSizes, GrowFromEdgePointOverPlane) {
  const Model model = plate("plate", 0.0);
  Field field(model, 0.3, 0.2);
  const EdgeId e = model.faces[k_first_face].borders[0][1].edge;
  field.request(e, 12, 0.001);
  const Point source = field.edges[e].samples[12].point;
  const Difference off = difference_on(model, k_first_face, model.faces[k_first_face].surface->domain(), field.made(),
                                       [&](Uv, const Point& p) { return std::min(0.3, 0.001 + k_growth * distance(p, source)); });
  EXPECT_LT(off.largest, 0.08) << off.location;
  EXPECT_LT(off.mean, 0.01);
}

TEST(SurfaceSizes, SourcesInSpaceAreMetOnTheFace) {
  const Model model = plate("plate", 0.0);
  const Field field(model, 0.3, 0.2);
  const Point source{0.317, 0.691, 0.0};
  const SurfaceSizes made = field.made({{source, 0.002}});
  const Difference off = difference_on(model, k_first_face, model.faces[k_first_face].surface->domain(), made,
                                       [&](Uv, const Point& p) { return std::min(0.3, 0.002 + k_growth * distance(p, source)); });
  EXPECT_LT(off.largest, 0.15) << off.location;  // within a cell of the location itself
  EXPECT_LT(off.mean, 0.01);
}

TEST(SurfaceSizes, DistancesOnACylinderRunAroundIt) {
  constexpr double radius = 0.5, length = 3.0;
  const Model model = open_tube(radius, length);
  Field field(model, 2.0, 1.5);
  const EdgeId lower = model.faces[k_first_face].borders[0][0].edge;
  const std::size_t at = field.edges[lower].samples.size() / 2;
  field.request(lower, at, 0.004);
  const double around = std::atan2(field.edges[lower].samples[at].point.y, field.edges[lower].samples[at].point.x);
  const double by_curvature = 2.0 * std::sin(0.75) * radius;
  const Difference off = difference_on(model, k_first_face, model.faces[k_first_face].surface->domain(), field.made(), [&](Uv uv, const Point&) {
    const double turn = std::abs(std::remainder(uv.u - around, 2.0 * pi));
    return std::min(by_curvature, 0.004 + k_growth * std::hypot(radius * turn, uv.v));
  });
  EXPECT_LT(off.largest, 0.08) << off.location;
  EXPECT_LT(off.mean, 0.02);
}

TEST(SurfaceSizes, DistancesOnASphereRunAroundIt) {
  const Model model = test::make_ball(1.0);
  Field field(model, 2.0, 1.5);
  const EdgeId seam = model.faces[k_first_face].borders[0][1].edge;
  field.request(seam, field.edges[seam].samples.size() - 1, 0.01);  // the north pole
  const double by_curvature = 2.0 * std::sin(0.75);
  const Difference off = difference_on(model, k_first_face, model.faces[k_first_face].surface->domain(), field.made(),
                                       [&](Uv uv, const Point&) { return std::min(by_curvature, 0.01 + k_growth * (0.5 * pi - uv.v)); });
  EXPECT_LT(off.largest, 0.08) << off.location;
  EXPECT_LT(off.mean, 0.02);
}

TEST(SurfaceSizes, NothingCrossesAGap) {
  Model model = plate("fine", 0.0);
  append(model, plate("coarse", 0.01));
  Field field(model, 0.3, 0.2);
  field.request_along(model.faces[k_first_face].borders[0][0].edge, 0.002);
  const SurfaceSizes made = field.made();
  const FaceId coarse(1);
  const Difference off = difference_on(model, coarse, model.faces[coarse].surface->domain(), made, [](Uv, const Point&) { return 0.3; });
  EXPECT_LT(off.largest, 1e-6) << off.location;
  for (const EdgeUse& use : model.faces[coarse].borders[0])
    EXPECT_EQ(made.on_edge(use.edge, 0.5 * (model.edges[use.edge].range.from + model.edges[use.edge].range.to)), 0.3);
}

TEST(SurfaceSizes, SizesSpreadAroundBoxEdgesNotThroughBox) {
  const Model model = make_box("box", {0, 0, 0}, {1, 1, 0.02});
  Field field(model, 0.3, 0.2);
  // The middle of an edge of the face z = 0.02 at x = 0; from the face below, the path is 0.02 longer.
  for (const EdgeId e : model.edges.ids()) {
    const auto& samples = field.edges[e].samples;
    const Point& p = samples[samples.size() / 2].point;
    if (distance(p, {0.0, 0.5, 0.02}) < 1e-9) field.request(e, samples.size() / 2, 0.002);
  }
  const SurfaceSizes made = field.made();
  for (const FaceId f : model.faces.ids()) {
    const ParameterBox box = model.faces[f].surface->domain();
    for (int i = 0; i < 2000; ++i) {
      const Uv at{box.u.from + share_of(i, 12.9898) * box.u.length(), box.v.from + share_of(i, 78.233) * box.v.length()};
      const Point p = model.faces[f].surface->point(at);
      if (p.z > 1e-9 || p.x < 0.1 || p.x > 1.0 || p.y < 0.0 || p.y > 1.0) continue;
      const double exact = std::min(0.3, 0.002 + k_growth * std::hypot(p.x + 0.02, p.y - 0.5));
      EXPECT_NEAR(made.on_face(f, at, p), exact, 0.06 * exact) << p.x << " " << p.y;
    }
  }
}

TEST(SurfaceSizes, ChangeNoFasterThanTheGrowthSays) {
  const Model model = test::make_ball(1.0);
  Field field(model, 0.3, 0.2);
  field.request(model.faces[k_first_face].borders[0][1].edge, 3, 0.004);
  const SurfaceSizes made = field.made({{{0.0, 0.8, 0.6}, 0.01}});
  const Surface& surface = *model.faces[k_first_face].surface;
  for (int i = 0; i < 5000; ++i) {
    const Uv a{2.0 * pi * share_of(i, 12.9898), 0.95 * pi * (share_of(i, 78.233) - 0.5)};
    const Point p = surface.point(a);
    const double size = made.on_face(k_first_face, a, p);
    const double turn = 2.0 * pi * share_of(i, 37.719);
    const Uv b{std::clamp(a.u + 2.0 * size * std::cos(turn) / std::cos(a.v), 0.0, 2.0 * pi), a.v + 2.0 * size * std::sin(turn)};
    if (std::abs(b.v) > 0.5 * pi) continue;
    const Point q = surface.point(b);
    // Bilinear values deviate by up to 5 % in both directions.
    EXPECT_LE(made.on_face(k_first_face, b, q), (size + k_growth * 2.0 * size) * 1.12);
  }
}

TEST(SurfaceSizes, FamiliesOfMeshesAreSimilar) {
  Wing wing{.name = "W", .is_symmetric = true, .is_cubic = true};
  for (const double y : {3.0, 1.5, 0.0}) {
    WingSection s{.name = "y", .leading_edge = {0.05 * y * y, y, 0.0}, .chord = 2.0 - 0.05 * y * y};
    for (int i = 0; i <= 100; ++i) s.points.push_back({0.5 + 0.5 * std::cos(2 * pi * i / 100), 0.1 * std::sin(2 * pi * i / 100)});
    wing.sections.push_back(s);
  }
  wing.right_tip = wing.left_tip = {CapShape::strip, 1.0};
  const Model model = make_wing(wing);
  double before = 0.0;
  for (const double refinement : {1.0, 1.5, 2.25}) {
    SurfaceMeshOptions options;
    options.sizes.refinement = refinement;
    options.crossings = "ignore";
    const auto n = static_cast<double>(mesh_model(model, options, {}, k_context).mesh.n_triangles());
    if (before > 0.0) {
      EXPECT_NEAR(n / before, 2.25, 0.15 * 2.25) << refinement;
    }
    before = n;
  }
}

TEST(SurfaceSizes, NarrowFacesBelongToFamiliesToo) {
  const Model plate = make_box("plate", {}, {1.0, 1.0, 0.01});  // its sides are narrower than all edges
  double before = 0.0;
  for (const double refinement : {1.0, 1.5, 2.25}) {
    SurfaceMeshOptions options;
    options.sizes.max_edge = 0.2;
    options.sizes.refinement = refinement;
    const auto n = static_cast<double>(mesh_model(plate, options, {}, k_context).mesh.n_triangles());
    if (before > 0.0) {
      EXPECT_NEAR(n / before, 2.25, 0.15 * 2.25) << refinement;
    }
    before = n;
  }
}

}  // namespace
}  // namespace sterna::surfmesh
