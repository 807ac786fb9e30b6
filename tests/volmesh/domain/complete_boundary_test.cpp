#include "volmesh/domain/complete_boundary.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/half.h"
#include "geom/mesh/topology.h"
#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/domain/farfield.h"

namespace sterna::volmesh {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

using test::k_context;

TriMesh moved(TriMesh mesh, const Vec3& by) {
  for (Point& p : mesh.points) p += by;
  return mesh;
}
TriMesh turned(TriMesh mesh) {
  for (TriangleVertices& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}
TriMesh scaled(TriMesh mesh, double by) {
  for (Point& p : mesh.points) p *= by;
  return mesh;
}
TriMesh both(TriMesh mesh, const TriMesh& other) {
  append(mesh, other);
  return mesh;
}

using test::volume_of;

ErrorInfo completion_error(const TriMesh& surface, const OuterOptions& options) {
  try {
    complete_boundary(surface, options, k_context);
  } catch (const Error& error) {
    return error.info();
  }
  return {};
}

std::vector<std::string> names_of(const TriMesh& mesh) {
  std::vector<std::string> names;
  for (const Patch& patch : mesh.patches) names.push_back(patch.name + ":" + std::string(to_string(patch.kind)));
  return names;
}

/// Checks the postconditions in the header of complete_boundary. `fluid` is the volume of the fluid, with opposite sign.
void expect_complete(const TriMesh& surface, const TriMesh& whole, double fluid, double tolerance) {
  const Topology topology(whole, k_context);
  EXPECT_EQ(topology.n_boundary_halfedges(), 0u);
  ASSERT_GE(whole.n_vertices(), surface.n_vertices());
  for (const TriangleId t : surface.triangles.ids()) {
    EXPECT_EQ(whole.triangles[t], surface.triangles[t]);
    EXPECT_EQ(whole.patches[whole.triangle_patch[t]], surface.patches[surface.triangle_patch[t]]);
  }
  const double length = body_length(surface);
  for (const VertexId v : surface.points.ids()) EXPECT_LE(distance(whole.points[v], surface.points[v]), 3e-6 * length);
  for (const TriangleId t : whole.triangles.ids()) EXPECT_GT(std::apply(triangle_area, corners(whole, t)), 0.0);
  for (const VertexId v : whole.points.ids()) EXPECT_FALSE(topology.outgoing(v).empty()) << v.value();
  EXPECT_NEAR(-volume_of(whole), fluid, tolerance * fluid);
}

/// Checks that every triangle of the patches with this name lies in the plane, with its normal towards the side `inward`.
void expect_plane(const TriMesh& whole, const std::string& name, std::size_t axis, double at, double inward) {
  std::size_t n = 0;
  for (const TriangleId t : whole.triangles.ids()) {
    if (whole.patches[whole.triangle_patch[t]].name != name) continue;
    const auto [a, b, c] = corners(whole, t);
    EXPECT_TRUE(a[axis] == at && b[axis] == at && c[axis] == at);
    EXPECT_GT(inward * area_vector(a, b, c)[axis], 0.0);
    ++n;
  }
  EXPECT_GT(n, 2u);
}

using test::k_pi;

TEST(CompleteBoundary, OfBodiesIsTheSphereAsItWas) {
  const TriMesh bodies = both(test::cube(2), moved(test::sphere(2, 0.3), {3, 0, 0}));
  const FarfieldOptions options{.farfield_radius = 20.0, .farfield_edge = 4.0};
  const TriMesh whole = complete_boundary(bodies, {options, {}}, k_context);
  const TriMesh sphere = farfield_sphere(bodies, options, k_context);
  const TriMesh around = both(bodies, sphere);
  EXPECT_EQ(whole.points.raw(), around.points.raw());
  EXPECT_EQ(whole.triangles.raw(), around.triangles.raw());
  EXPECT_EQ(whole.patches.raw(), around.patches.raw());
  expect_complete(bodies, whole, -volume_of(sphere) - volume_of(bodies), 1e-12);
}

TEST(CompleteBoundary, KeepsCavitiesAndSeveralBodies) {
  TriMesh bodies = both(test::cube(3), moved(turned(test::sphere(1, 0.2)), {0.5, 0.5, 0.5}));
  bodies = both(bodies, moved(test::cube(1), {2, 2, 2}));
  expect_complete(bodies, complete_boundary(bodies, {}, k_context), -volume_of(farfield_sphere(bodies, {}, k_context)) - volume_of(bodies), 1e-12);
}

TEST(CompleteBoundary, MakesBoxesOfAnyEdgeLengths) {
  const TriMesh cube = test::cube(2);
  FarfieldOptions options{.farfield_shape = "box",
                          .farfield_edge = 2.0,
                          .farfield_from_x = -10,
                          .farfield_from_y = -5,
                          .farfield_from_z = -4,
                          .farfield_to_x = 20,
                          .farfield_to_y = 5,
                          .farfield_to_z = 6};
  for (const char* sides : {"", "x_min=inflow x_max=outflow,edge:0.5", "y_min=slip,name:floor,edge:0.3 y_max=slip,edge:7"}) {
    options.farfield_sides = parse_sides(sides);
    const TriMesh whole = complete_boundary(cube, {options, {}}, k_context);
    expect_complete(cube, whole, 3000.0 - 1.0, 1e-12);
    // Angles of the added triangles.
    double least = 4.0;
    for (std::size_t i = cube.n_triangles(); i < whole.n_triangles(); ++i) {
      const auto p = corners(whole, TriangleId(i));
      for (std::size_t k = 0; k < 3; ++k) least = std::min(least, corner_angle(p[k], p[(k + 1) % 3], p[(k + 2) % 3]));
    }
    EXPECT_GT(least, 15.0 * k_pi / 180.0) << sides;
  }
  options.farfield_sides = parse_sides("x_min=inflow x_max=outflow,name:exit z_min=slip z_max=slip");
  EXPECT_THAT(names_of(complete_boundary(cube, {options, {}}, k_context)),
              UnorderedElementsAre("cube:wall", "inflow:inflow", "exit:outflow", "farfield:farfield", "slip:slip"));
}

TEST(CompleteBoundary, MakesCylindersAlongAnyAxis) {
  const TriMesh cube = test::cube(2);
  for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0.6, 0.48, -0.64}}) {
    const Vec3 from = Vec3{0.5, 0.5, 0.5} - 9.0 * axis, to = Vec3{0.5, 0.5, 0.5} + 11.0 * axis;
    const FarfieldOptions options{.farfield_shape = "cylinder",
                                  .farfield_radius = 6.0,
                                  .farfield_edge = 1.0,
                                  .farfield_from_x = from.x,
                                  .farfield_from_y = from.y,
                                  .farfield_from_z = from.z,
                                  .farfield_to_x = to.x,
                                  .farfield_to_y = to.y,
                                  .farfield_to_z = to.z,
                                  .farfield_sides = parse_sides("start=inflow end=outflow,edge:0.4")};
    const TriMesh whole = complete_boundary(cube, {options, {}}, k_context);
    expect_complete(cube, whole, 36.0 * k_pi * 20.0 - 1.0, 0.02);
    EXPECT_THAT(names_of(whole), UnorderedElementsAre("cube:wall", "inflow:inflow", "outflow:outflow", "farfield:farfield"));
  }
}

TEST(CompleteBoundary, HalvesEveryShape) {
  const TriMesh full = test::sphere(8);
  for (const char* axis : {"x", "y", "z"})
    for (const char* keep : {"+", "-"}) {
      const auto k = static_cast<std::size_t>(*axis - 'x');
      const TriMesh half = moved(half_of(full, {.axis = axis, .keep = keep}, k_context), {0, 0, 0});
      for (const char* shape : {"automatic", "box", "cylinder"}) {
        SCOPED_TRACE(std::string(axis) + keep + shape);
        const TriMesh whole =
            complete_boundary(half, {{.farfield_shape = shape, .farfield_radius = std::string(shape) == "box" ? k_automatic : 30.0}, {}}, k_context);
        const TriMesh around_full =
            complete_boundary(full, {{.farfield_shape = shape, .farfield_radius = std::string(shape) == "box" ? k_automatic : 30.0}, {}}, k_context);
        expect_complete(half, whole, -0.5 * volume_of(around_full), 0.01);
        expect_plane(whole, "symmetry", k, 0.0, *keep == '+' ? 1.0 : -1.0);
        EXPECT_THAT(names_of(whole), ElementsAre("sphere:wall", "farfield:farfield", "symmetry:symmetry"));
      }
    }
}

TEST(CompleteBoundary, MovesRimsIntoTheirPlane) {
  TriMesh half = half_of(test::sphere(8), {}, k_context);
  for (Point& p : half.points)
    if (p.y == 0.0 && p.x > 0.2) p.y = 1.5e-6 * p.x;
  const TriMesh whole = complete_boundary(half, {}, k_context);
  expect_complete(half, whole, -0.5 * volume_of(farfield_sphere(test::sphere(8), {}, k_context)), 0.02);
  expect_plane(whole, "symmetry", 1, 0.0, 1.0);
}

TEST(CompleteBoundary, TakesTwoPlanes) {
  // A quarter model: its two planes meet.
  const TriMesh quarter = half_of(half_of(test::sphere(8), {}, k_context), {.axis = "z", .keep = "-"}, k_context);
  for (const char* shape : {"sphere", "box", "cylinder"}) {
    SCOPED_TRACE(shape);
    const TriMesh whole = complete_boundary(quarter, {{.farfield_shape = shape}, {}}, k_context);
    EXPECT_EQ(Topology(whole, k_context).n_boundary_halfedges(), 0u);
    expect_plane(whole, "symmetry_y", 1, 0.0, 1.0);
    expect_plane(whole, "symmetry_z", 2, 0.0, -1.0);
    EXPECT_THAT(names_of(whole), ElementsAre("sphere:wall", "farfield:farfield", "symmetry_y:symmetry", "symmetry_z:symmetry"));
    EXPECT_LT(volume_of(whole), 0.0);
  }
  // A wing between two walls.
  TriMesh strut = half_of(half_of(moved(test::sphere(8), {0, 0.5, 0}), {.at = 0.1}, k_context), {.at = 1.1, .keep = "-"}, k_context);
  for (const char* shape : {"box", "cylinder"}) {
    const TriMesh whole = complete_boundary(
        strut, {{.farfield_shape = shape, .farfield_sides = parse_sides("symmetry_y_min=slip symmetry_y_max=wall,name:floor")}, {}}, k_context);
    EXPECT_EQ(Topology(whole, k_context).n_boundary_halfedges(), 0u);
    EXPECT_THAT(names_of(whole), ElementsAre("sphere:wall", "farfield:farfield", "slip:slip", "floor:wall"));
    expect_plane(whole, "slip", 1, 0.1, 1.0);
    expect_plane(whole, "floor", 1, 1.1, -1.0);
  }
}

TEST(CompleteBoundary, TakesTheUsersSurface) {
  const TriMesh body = test::sphere(4);
  auto tunnel = std::make_shared<TriMesh>(moved(scaled(test::cube(4), 10.0), {-5, -5, -5}));
  const OuterOptions options{{.farfield_shape = "surface"}, tunnel};
  const TriMesh whole = complete_boundary(body, options, k_context);
  expect_complete(body, whole, 1000.0 - volume_of(body), 1e-12);
  EXPECT_THAT(names_of(whole), ElementsAre("sphere:wall", "cube:farfield"));
  EXPECT_EQ(complete_boundary(body, {{.farfield_shape = "surface"}, std::make_shared<TriMesh>(turned(*tunnel))}, k_context).points.raw(), whole.points.raw());
  // The tunnel is cut at the plane of a half model. If a side of the tunnel lies in that plane, its patch is kept there.
  const TriMesh half = half_of(body, {}, k_context);
  const TriMesh in_tunnel = complete_boundary(half, options, k_context);
  expect_complete(half, in_tunnel, 500.0 - 0.5 * volume_of(body), 1e-3);
  auto room = std::make_shared<TriMesh>(moved(*tunnel, {0, 5, 0}));
  room->patches.push_back({"side", PatchKind::slip});
  for (const TriangleId t : room->triangles.ids())
    if (const auto p = corners(*room, t); p[0].y == 0.0 && p[1].y == 0.0 && p[2].y == 0.0) room->triangle_patch[t] = PatchId(1);
  const TriMesh on_side = complete_boundary(half, {{.farfield_shape = "surface"}, room}, k_context);
  expect_complete(half, on_side, 1000.0 - 0.5 * volume_of(body), 1e-3);
  expect_plane(on_side, "side", 1, 0.0, 1.0);
  // A tunnel surface from another program: farfield_sides sets its kind and its name.
  const TriMesh named = complete_boundary(body, {{.farfield_shape = "surface", .farfield_sides = parse_sides("cube=slip,name:tunnel")}, tunnel}, k_context);
  EXPECT_THAT(names_of(named), ElementsAre("sphere:wall", "tunnel:slip"));
  const ErrorInfo beside = completion_error(moved(body, {20, 0, 0}), options);
  EXPECT_THAT(beside.problem, HasSubstr("does not enclose"));
  EXPECT_EQ(beside.locations.size(), 1u);
  EXPECT_THAT(completion_error(body, {{.farfield_shape = "surface"}, {}}).problem, HasSubstr("there is no surface"));
}

TEST(CompleteBoundary, LeavesCompleteDomainsAlone) {
  TriMesh domain = moved(scaled(turned(test::cube(3)), 8.0), {-4, -4, -4});
  domain.patches[PatchId(0)] = {"tunnel", PatchKind::slip};
  append(domain, test::sphere(3));
  append(domain, moved(test::cube(1), {2, 2, 2}));
  for (const char* shape : {"automatic", "none"}) {
    const TriMesh whole = complete_boundary(domain, {{.farfield_shape = shape}, {}}, k_context);
    EXPECT_EQ(whole.points.raw(), domain.points.raw());
    EXPECT_EQ(whole.triangles.raw(), domain.triangles.raw());
    EXPECT_EQ(whole.patches.raw(), domain.patches.raw());
  }
  EXPECT_THAT(completion_error(domain, {{.farfield_radius = 100.0}, {}}).problem, HasSubstr("already encloses its fluid"));
  EXPECT_THAT(completion_error(domain, {{.farfield_shape = "box"}, {}}).problem, HasSubstr("already encloses its fluid"));
  EXPECT_THAT(completion_error(test::cube(1), {{.farfield_shape = "none"}, {}}).problem, HasSubstr("encloses no fluid"));
  // Half a domain: only its plane is added.
  const TriMesh half = half_of(domain, {.axis = "z", .at = 0.3}, k_context);
  const TriMesh whole = complete_boundary(half, {}, k_context);
  EXPECT_EQ(whole.n_vertices(), half.n_vertices());
  expect_plane(whole, "symmetry", 2, 0.3, 1.0);
  EXPECT_EQ(Topology(whole, k_context).n_boundary_halfedges(), 0u);
  // A body outside the domain.
  EXPECT_THAT(completion_error(both(domain, moved(test::cube(1), {20, 0, 0})), {}).problem, HasSubstr("outermost parts"));
}

TEST(CompleteBoundary, SaysWhatIsWrong) {
  const TriMesh cube = test::cube(2);
  EXPECT_EQ(completion_error({}, {}).code, ErrorCode::empty_surface);
  TriMesh holed = test::sphere(4);
  holed.triangles.raw().pop_back();
  holed.triangle_patch.raw().pop_back();
  const ErrorInfo open = completion_error(holed, {});
  EXPECT_EQ(open.code, ErrorCode::open_surface);
  EXPECT_THAT(open.problem, HasSubstr("1 open boundaries with 3 edges"));
  EXPECT_FALSE(open.locations.empty());
  const FarfieldOptions box{.farfield_shape = "box",
                            .farfield_from_x = -10,
                            .farfield_from_y = -5,
                            .farfield_from_z = -4,
                            .farfield_to_x = 20,
                            .farfield_to_y = 1.001,
                            .farfield_to_z = 6};
  const ErrorInfo narrow = completion_error(cube, {box, {}});
  EXPECT_THAT(narrow.problem, HasSubstr("y_max at 1.001 m: the wall is inside by 0.001 m but must be inside by 0.02 m"));
  ASSERT_EQ(narrow.locations.size(), 1u);
  EXPECT_EQ(narrow.locations[0].position.y, 1.0);
  EXPECT_THAT(completion_error(cube, {{.farfield_shape = "cylinder", .farfield_radius = 0.5}, {}}).problem, HasSubstr("inside the flat triangles"));
  EXPECT_THAT(completion_error(cube, {{.farfield_shape = "box", .farfield_edge = 1e-4}, {}}).problem, HasSubstr("million triangles"));
  EXPECT_THAT(completion_error(cube, {{.farfield_shape = "box", .farfield_sides = parse_sides("x_mim=inflow")}, {}}).problem,
              HasSubstr("did you mean \"x_min\""));
  test::expect_error(ErrorCode::bad_argument, "\"x_min=inlet\": \"inlet\" is not a patch kind", [] { parse_sides("x_max=slip x_min=inlet"); });
  test::expect_error(ErrorCode::bad_argument, "\"x_min=edge:5q\": \"5q\" is not a length", [] { parse_sides("x_min=edge:5q"); });
  test::expect_error(ErrorCode::bad_argument, "\"x_min=wall\": the side is given twice", [] { parse_sides("x_min=slip x_min=wall"); });
  EXPECT_EQ(sides_text(parse_sides("x_min=slip,edge:10cm")), "x_min=slip,edge:0.1");
}

TEST(CompleteBoundary, OfHalvesOfRealAircraft) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* file :
       {"dlr_f6_184k.stl", "derived_crm_wb_dpw_coarse_full.off", "wing_body_79k.stl", "flow360_airplane_airplaneGeometry.stl", "vspgeom_geom2_geom2.stl"}) {
    SCOPED_TRACE(file);
    const TriMesh full = surfmesh::stitch_surface({io::read_surface_file(test::shared_data() / "surfaces" / "clean" / file, k_context)},
                                                  {.check_intersections = false}, k_context)
                             .mesh;
    const TriMesh half = half_of(full, {}, k_context);
    const TriMesh whole = complete_boundary(half, {}, k_context);
    EXPECT_EQ(Topology(whole, k_context).n_boundary_halfedges(), 0u);
    expect_plane(whole, "symmetry", 1, 0.0, 1.0);
    const TriMesh in_box = complete_boundary(half, {{.farfield_shape = "box"}, {}}, k_context);
    EXPECT_EQ(Topology(in_box, k_context).n_boundary_halfedges(), 0u);
  }
}

TEST(CompleteBoundary, IsTheSameForAnyNumberOfThreads) {
  const TriMesh half = half_of(test::sphere(9), {}, k_context);
  for (const char* shape : {"sphere", "box", "cylinder"}) {
    const OuterOptions options{{.farfield_shape = shape}, {}};
    const TriMesh one = complete_boundary(half, options, RunContext({.threads = 1}));
    for (const int threads : {2, 7}) {
      const TriMesh many = complete_boundary(half, options, RunContext({.threads = threads}));
      EXPECT_EQ(one.points.raw(), many.points.raw());
      EXPECT_EQ(one.triangles.raw(), many.triangles.raw());
    }
  }
}

}  // namespace
}  // namespace sterna::volmesh
