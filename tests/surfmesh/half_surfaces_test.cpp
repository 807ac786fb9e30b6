// Halves of real full models: geom/mesh/half.h on surfaces from files.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "geom/math/measures.h"
#include "geom/mesh/half.h"
#include "geom/mesh/topology.h"
#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"

namespace sterna {
namespace {

using test::k_context;

TriMesh read(const char* file) {
  return surfmesh::stitch_surface({io::read_surface_file(test::shared_data() / "surfaces" / "clean" / file, k_context)}, {.check_intersections = false},
                                  k_context)
      .mesh;
}

struct Sizes {
  double area = 0.0, volume = 0.0;
  double least_height = 1e300;  ///< smallest triangle height over the triangle's longest edge
};
/// Computes the volume as flux of the distance from the plane, to which the plane contributes nothing.
Sizes sizes_of(const TriMesh& mesh, double at) {
  Sizes sizes;
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto [a, b, c] = corners(mesh, t);
    const Vec3 area = area_vector(a, b, c);
    const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
    sizes.area += norm(area);
    sizes.volume += area.y * (a.y + b.y + c.y - 3.0 * at) / 3.0;
    sizes.least_height = std::min(sizes.least_height, 2.0 * norm(area) / (longest * longest));
  }
  return sizes;
}

void expect_border(const TriMesh& half, double at) {
  const Topology topology(half, k_context);
  std::vector<int> n_from(half.n_vertices(), 0), n_to(half.n_vertices(), 0);
  std::size_t n_off = 0;
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (!topology.is_boundary(h)) continue;
    n_off += half.points[topology.from(h)].y != at || half.points[topology.to(h)].y != at ? 1 : 0;
    ++n_from[topology.from(h).index()];
    ++n_to[topology.to(h).index()];
  }
  EXPECT_GT(topology.n_boundary_halfedges(), 0u);
  EXPECT_EQ(n_off, 0u);
  EXPECT_EQ(n_from, n_to);
  EXPECT_LE(*std::max_element(n_from.begin(), n_from.end()), 1);
}

constexpr std::array k_full_models = {"dlr_f6_184k.stl",
                                      "derived_crm_wb_dpw_coarse_full.off",
                                      "wing_body_79k.stl",
                                      "flow360_airplane_airplaneGeometry.stl",
                                      "flowpanel_cessna_cessna.msh",
                                      "vspgeom_geom2_geom2.stl",
                                      "pymeshlab_airplane_airplane.obj",
                                      "meshpy_ka6d_ka-6d.ply",
                                      "pygeo_bwb.stl"};

/// Sum of both sides of a plane, relative to the whole, minus one.
struct Missing {
  double area = 0.0, volume = 0.0;
};
Missing cut_in_two(const TriMesh& full, const HalfOptions& options) {
  const Sizes whole = sizes_of(full, options.at);
  Missing missing{-1.0, -1.0};
  for (const char* keep : {"+", "-"}) {
    HalfOptions of_side = options;
    of_side.keep = keep;
    const TriMesh half = half_of(full, of_side, k_context);
    expect_border(half, options.at);
    const Sizes sizes = sizes_of(half, options.at);
    missing.area += sizes.area / whole.area;
    missing.volume += sizes.volume / whole.volume;
    if (options.snap > 0.0) {
      EXPECT_GT(sizes.least_height, 0.1 * std::min(whole.least_height, 0.4));
    }
  }
  return missing;
}

TEST(HalfOfRealSurfaces, HaveTheWholeTogether) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* file : k_full_models) {
    SCOPED_TRACE(file);
    const TriMesh full = read(file);
    for (const double share : {0.0, 0.0137}) {  // of the longest side: the symmetry plane of most models, and a plane through triangles
      const double at = share * bounding_box(full).longest_side();
      const Missing exact = cut_in_two(full, {.at = at, .snap = 0.0});
      EXPECT_NEAR(exact.area, 0.0, 1e-9);
      EXPECT_NEAR(exact.volume, 0.0, 1e-9);
      const Missing snapped = cut_in_two(full, {.at = at});
      EXPECT_NEAR(snapped.area, 0.0, 1e-4);  // measured: 3e-5 at most (meshpy_ka6d, 1818 triangles)
      EXPECT_NEAR(snapped.volume, 0.0, 1e-4);
    }
  }
}

TEST(HalfOfRealSurfaces, OfSymmetricTriangulationsCutsNothing) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* file : {"dlr_f6_184k.stl", "derived_crm_wb_dpw_coarse_full.off", "flowpanel_cessna_cessna.msh", "meshpy_ka6d_ka-6d.ply"}) {
    SCOPED_TRACE(file);
    const TriMesh full = read(file);
    const TriMesh half = half_of(full, {}, k_context);
    EXPECT_EQ(2 * half.n_triangles(), full.n_triangles());
    EXPECT_NEAR(sizes_of(half, 0.0).area / sizes_of(full, 0.0).area, 0.5, 1e-9);
    EXPECT_NEAR(sizes_of(half, 0.0).volume / sizes_of(full, 0.0).volume, 0.5, 1e-9);
    const TriMesh again = half_of(half, {}, k_context);
    EXPECT_EQ(again.points.raw(), half.points.raw());
    EXPECT_EQ(again.triangles.raw(), half.triangles.raw());
  }
}

}  // namespace
}  // namespace sterna
