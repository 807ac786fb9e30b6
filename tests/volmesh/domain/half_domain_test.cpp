// Layers that end on patches without layers, from closed surfaces with patch kinds to checked meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>

#include "geom/base/error.h"
#include "geom/delaunay/planar.h"
#include "geom/mesh/topology.h"
#include "tests/support/halves.h"
#include "tests/support/test_shapes.h"
#include "tests/support/voxels.h"
#include "tests/volmesh/domain/room.h"
#include "volmesh/domain/domain_parts.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

TriMesh turned_inwards(TriMesh mesh) {
  for (TriangleVertices& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriMesh named(TriMesh mesh, const std::string& name, PatchKind kind) {
  mesh.patches = Column<PatchId, Patch>{{name, kind}};
  mesh.triangle_patch.assign(mesh.n_triangles(), PatchId(0));
  return mesh;
}

/// Closes the open edges of a mesh, which lie in the plane y = 0 with the fluid above, by a patch.
void close_plane(TriMesh& mesh, const std::string& name, PatchKind kind) {
  const Topology topology(mesh, RunContext{});
  std::vector<Vec2> points;
  std::vector<VertexId> vertices;
  std::map<std::uint32_t, std::uint32_t> number;
  std::vector<delaunay::Segment> segments;
  const auto add = [&](VertexId v) {
    const auto [at, is_new] = number.emplace(v.value(), static_cast<std::uint32_t>(vertices.size()));
    if (is_new) {
      vertices.push_back(v);
      points.push_back({mesh.points[v].z, mesh.points[v].x});  // z, x, y is right-handed
    }
    return at->second;
  };
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (!topology.is_boundary(h)) continue;
    const std::uint32_t a = add(topology.from(h)), b = add(topology.to(h));
    segments.push_back({a, b});
  }
  const auto plane = delaunay::triangulate_plane(points, segments, delaunay::Extent::inside, RunContext{});
  const PatchId patch = mesh.patches.push_back({name, kind});
  for (const TriangleVertices& t : delaunay::extract_triangles(plane.mesh)) {
    mesh.triangles.push_back({vertices[t[0].index()], vertices[t[1].index()], vertices[t[2].index()]});
    mesh.triangle_patch.push_back(patch);
  }
}

/// Half a ball of radius 1 in half a ball of radius 10, with the symmetry plane between them.
TriMesh half_ball_domain(int fineness) {
  TriMesh mesh = named(test::cut_off(test::sphere(fineness), 1, 0.0), "ball", PatchKind::wall);
  append(mesh, named(turned_inwards(test::cut_off(test::sphere(4, 10.0), 1, 0.0)), "farfield", PatchKind::farfield));
  close_plane(mesh, "symmetry", PatchKind::symmetry);
  return mesh;
}

TEST(HalfDomain, HalfBallLayersEndOnSymmetryPlane) {
  const TriMesh surface = half_ball_domain(8);
  const VolumeMeshResult result = volume_mesh(surface, layers(12, 1e-4), RunContext({.threads = 2}));
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  const HybridMesh& mesh = result.mesh;
  EXPECT_EQ(mesh.layers.n_columns(), test::cut_off(test::sphere(8), 1, 0.0).n_triangles());
  std::size_t n_border = 0;
  const TriMesh wall = test::cut_off(test::sphere(8), 1, 0.0);
  n_border = Topology(wall, RunContext{}).n_boundary_halfedges();
  EXPECT_EQ(mesh.boundary_quads.size(), 12 * n_border);
  for (const BoundaryQuad& quad : mesh.boundary_quads) {
    EXPECT_EQ(mesh.patches[quad.patch].name, "symmetry");
    for (const NodeId node : quad.nodes) EXPECT_EQ(mesh.points[node].y, 0.0);
  }
  double area = 0.0;
  for (const auto& face : mesh.boundary_triangles) {
    if (mesh.patches[face.patch].kind != PatchKind::symmetry) continue;
    for (const NodeId node : face.nodes) EXPECT_EQ(mesh.points[node].y, 0.0);
    const Vec3 n = cross(mesh.points[face.nodes[1]] - mesh.points[face.nodes[0]], mesh.points[face.nodes[2]] - mesh.points[face.nodes[0]]);
    EXPECT_LT(n.y, 0.0);
    area += 0.5 * norm(n);
  }
  EXPECT_GT(result.layer.coverage, 0.99);
  EXPECT_GT(area, 250.0);
}

VolumeMeshResult meshed(const TriMesh& surface, const MeshCase& options) {
  VolumeMeshResult result = volume_mesh(surface, options, RunContext({.threads = 2}));
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_EQ(result.layer.collapsed_area, 0.0);
  return result;
}

TEST(HalfDomain, FloorLayersEndOnFourSidesAndEdges) {
  const VolumeMeshResult result = meshed(room([](const std::string& name) { return name == "floor" ? PatchKind::wall : PatchKind::slip; }), layers(10, 1e-3));
  EXPECT_EQ(border_edges(result), (Edges{{"inlet", 12}, {"outlet", 12}, {"left", 24}, {"right", 24}}));
  EXPECT_GT(result.layer.coverage, 0.999);
}

TEST(HalfDomain, FloorAndCeilingLayersLeaveEdgeMiddlesFree) {
  const VolumeMeshResult result =
      meshed(room([](const std::string& name) { return name == "floor" || name == "ceiling" ? PatchKind::wall : PatchKind::slip; }), layers(10, 1e-3));
  EXPECT_EQ(border_edges(result), (Edges{{"inlet", 24}, {"outlet", 24}, {"left", 48}, {"right", 48}}));
  EXPECT_GT(result.layer.coverage, 0.999);
}

TEST(HalfDomain, FourLayeredWallsEndOnInletAndOutlet) {
  const VolumeMeshResult result = meshed(room([](const std::string&) { return PatchKind::wall; }), layers(10, 1e-3));
  EXPECT_EQ(border_edges(result), (Edges{{"inlet", 48}, {"outlet", 48}}));
  EXPECT_GT(result.layer.coverage, 0.8);
}

TEST(HalfDomain, StrutOnWallPassesThroughSlipCeiling) {
  const auto strut = [](int i, int j, int) { return i >= 8 && i < 12 && j >= 5 && j < 7; };
  const VolumeMeshResult result =
      meshed(room([](const std::string& name) { return name == "floor" ? PatchKind::wall : PatchKind::slip; }, strut), layers(10, 1e-3));
  EXPECT_EQ(border_edges(result), (Edges{{"ceiling", 12}, {"inlet", 12}, {"outlet", 12}, {"left", 24}, {"right", 24}}));
}

TEST(HalfDomain, AWingOnASlipSideWall) {
  const auto wing = [](int i, int j, int k) { return i >= 8 && i < 14 && j < 7 && k >= 5 && k < 7; };
  const VolumeMeshResult result = meshed(room([](const std::string&) { return PatchKind::slip; }, wing), layers(10, 1e-3));
  EXPECT_EQ(border_edges(result), (Edges{{"left", 16}}));
}

TEST(HalfDomain, BodyAwayFromSlipWallsNeedsNoFarfield) {
  const auto body = [](int i, int j, int k) { return i >= 8 && i < 14 && j >= 4 && j < 8 && k >= 5 && k < 7; };
  const VolumeMeshResult result = meshed(room([](const std::string&) { return PatchKind::slip; }, body), layers(10, 1e-3));
  EXPECT_TRUE(result.mesh.boundary_quads.empty());
  EXPECT_EQ(result.mesh.patches.size(), 7u);
}

/// A square duct in free air with a plug in it; the front of the plug is a fan face, its back a nozzle exit.
TEST(HalfDomain, DuctLayersEndOnFanFaceAndNozzle) {
  const auto is_fluid = [](int i, int j, int k) {
    const bool is_shell = i >= 10 && i < 22 && j >= 10 && j < 18 && k >= 10 && k < 18;
    const bool is_duct = is_shell && j >= 11 && j < 17 && k >= 11 && k < 17;
    const bool is_plug = is_duct && i >= 14 && i < 18;
    return !is_shell || (is_duct && !is_plug);
  };
  const double size = 0.1;
  const TriMesh surface = test::voxel_boundary({32, 28, 28}, size, is_fluid, [](const Point& p, const Vec3& normal) -> Patch {
    if (std::min({p.x, p.y, p.z}) == 0.0 || p.x > 3.19 || p.y > 2.79 || p.z > 2.79) return {"box", PatchKind::farfield};
    if (std::abs(p.x - 1.4) < 1e-9 && normal.x < 0.0) return {"fan", PatchKind::outflow};
    if (std::abs(p.x - 1.8) < 1e-9 && normal.x > 0.0) return {"nozzle", PatchKind::inflow};
    return {"nacelle", PatchKind::wall};
  });
  const VolumeMeshResult result = meshed(surface, layers(8, 1e-3));
  EXPECT_EQ(border_edges(result), (Edges{{"fan", 24}, {"nozzle", 24}}));
}

/// A body in free air whose back is a nozzle: at the edge to the jet the fluid spans 270 degrees.
TriMesh body_with_jet() {
  return test::voxel_boundary(
      {28, 24, 24}, 0.1, [](int i, int j, int k) { return !(i >= 9 && i < 19 && j >= 9 && j < 15 && k >= 9 && k < 15); },
      [](const Point& p, const Vec3& normal) -> Patch {
        if (std::min({p.x, p.y, p.z}) == 0.0 || p.x > 2.79 || p.y > 2.39 || p.z > 2.39) return {"box", PatchKind::farfield};
        if (std::abs(p.x - 1.9) < 1e-9 && normal.x > 0.0) return {"jet", PatchKind::inflow};
        return {"body", PatchKind::wall};
      });
}

double area_of_patch(const VolumeMeshResult& result, const std::string& name) {
  double area = 0.0;
  for (const auto& face : result.mesh.boundary_triangles)
    if (result.mesh.patches[face.patch].name == name)
      area += 0.5 * norm(cross(result.mesh.points[face.nodes[1]] - result.mesh.points[face.nodes[0]],
                               result.mesh.points[face.nodes[2]] - result.mesh.points[face.nodes[0]]));
  return area;
}

/// The side of a layer cannot stand on the jet, so the jet carries the layer as well. Found on scripts/03: cells around vertices of a nozzle's border without a
/// layer made the flow diverge.
TEST(HalfDomain, LayerContinuesOverJetBeyondOuterEdge) {
  const VolumeMeshResult result = volume_mesh(body_with_jet(), layers(8, 1e-3), RunContext({.threads = 2}));
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_TRUE(result.mesh.boundary_quads.empty());
  EXPECT_EQ(count_cells(result.mesh).pyramids, 0u);
  EXPECT_NEAR(area_of_patch(result, "jet"), 0.36, 1e-9);
  EXPECT_EQ(result.layer.coverage, 1.0);
  for (const Patch& patch : result.mesh.patches)
    if (patch.name == "jet") {
      EXPECT_EQ(patch.kind, PatchKind::inflow);
    }
}

/// A rule without layers for the jet: the layer height falls to zero at the edge, where a side of the layer would stand in the fluid.
TEST(HalfDomain, AtAnOuterEdgeTheLayerRunsOut) {
  MeshCase options = layers(8, 1e-3);
  options.patches = {{.names = "jet", .options = {{"layers", 0}}}};
  const VolumeMeshResult result = volume_mesh(body_with_jet(), options, RunContext({.threads = 2}));
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_TRUE(result.mesh.boundary_quads.empty());
  EXPECT_GT(count_cells(result.mesh).pyramids, 0u);
  EXPECT_NEAR(area_of_patch(result, "jet"), 0.36, 1e-9);
  EXPECT_GT(result.layer.coverage, 0.7);
}

TEST(HalfDomain, NonPlanarSymmetryPatchIsAnError) {
  TriMesh surface = half_ball_domain(6);
  const PatchId symmetry(surface.patches.size() - 1);
  for (const TriangleId t : surface.triangles.ids())
    if (surface.triangle_patch[t] == symmetry) surface.points[surface.triangles[t][0]].y += 1e-3;
  try {
    volume_mesh(surface, layers(6, 1e-3), RunContext{});
    FAIL() << "meshed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    EXPECT_NE(error.info().problem.find("\"symmetry\" is not flat"), std::string::npos) << error.what();
    EXPECT_EQ(error.info().locations.size(), 1u);
  }
}

TEST(HalfDomain, SameBytesForAnyNumberOfThreads) {
  const TriMesh surface = room([](const std::string&) { return PatchKind::wall; });
  const VolumeMeshResult first = volume_mesh(surface, layers(6, 1e-3), RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    const VolumeMeshResult other = volume_mesh(surface, layers(6, 1e-3), RunContext({.threads = threads}));
    EXPECT_EQ(first.mesh.points.raw(), other.mesh.points.raw());
    EXPECT_EQ(first.mesh.tetrahedra, other.mesh.tetrahedra);
  }
}

}  // namespace
}  // namespace sterna::volmesh
