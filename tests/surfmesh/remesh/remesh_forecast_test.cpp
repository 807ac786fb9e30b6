// The predicted number of triangles against the number that remesh_surface() makes.
#include "surfmesh/remesh/remesh_forecast.h"

#include <gtest/gtest.h>

#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"

namespace sterna::surfmesh {
namespace {

using test::k_context;

TEST(RemeshForecast, IsNearWhatIsMade) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* file : {"meshpy_ka6d_ka-6d.ply", "cgal_data_couplingdown.off", "pygeo_bwb.stl", "vspgeom_geom2_geom2.stl", "pmp_fandisk.off",
                           "caturbs_wing_wing.stl", "cgal_data_anchor_dense.off", "flowpanel_sweptwing_sweptwing-openvsp.msh",
                           "flowpanel_duct_duct_remeshed_refined.msh", "pymeshlab_airplane_airplane.obj", "wing_body_79k.stl"}) {
    const TriMesh wall = stitch_surface({io::read_surface_file(test::shared_data() / "surfaces" / "clean" / file, k_context)}, {}, k_context).mesh;
    const double n = forecast_remesh(wall, {}, {}, {}, k_context).n_triangles,
                 made = static_cast<double>(remesh_surface(wall, {}, {}, {}, k_context).mesh.n_triangles());
    EXPECT_NEAR(n / made, 1.0, 0.3) << file << ": " << n << " predicted, " << made << " made";
  }
}

}  // namespace
}  // namespace sterna::surfmesh
