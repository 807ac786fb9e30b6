// Real surfaces with the settings of baselines.md (without the optimiser). The large ones are measured by tools/measure_surfaces.
#include <gtest/gtest.h>

#include <numbers>

#include "io/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

struct Case {
  const char* file;       ///< below shared/data/surfaces
  double least_coverage;  ///< share of the area with h >= 0.9 h_target: what issue 2 asks, or what was measured less 0.02 where that is not reached
};

class RealSurface : public testing::TestWithParam<Case> {};

TEST_P(RealSurface, GivesAValidMeshWithItsLayers) {
  STERNA_NEEDS_SHARED_DATA();
  const RunContext context({.threads = 2});
  const SurfaceSoup soup = io::read_surface_file(test::shared_data() / "surfaces" / GetParam().file, context);
  const TriMesh wall = surfmesh::stitch_surface({soup}, {}, context).mesh;
  MeshCase options;
  const double length = body_length(wall);
  options.envelope.layers = 35;
  options.envelope.feature_angle = 35.0 * std::numbers::pi / 180.0;
  options.envelope.first_height = 1e-6 * length;
  options.envelope.max_thickness = 0.1 * length;
  options.farfield.farfield_radius = 20 * length;
  const VolumeMeshResult result = volume_mesh(wall, options, context);
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_GE(result.layer.coverage, GetParam().least_coverage);
  EXPECT_LE(result.layer.collapsed.size(), 3u);
}

INSTANTIATE_TEST_SUITE_P(Clean, RealSurface,
                         testing::Values(Case{"clean/caturbs_wing_wing.stl", 0.9}, Case{"clean/cgal_data_anchor_dense.off", 0.84},
                                         Case{"clean/cgal_data_couplingdown.off", 0.9}, Case{"clean/flowpanel_duct_duct_remeshed_refined.msh", 0.9},
                                         Case{"clean/gmsh_stl_TwoObjects.stl.gz", 0.9}, Case{"clean/meshpy_ka6d_ka-6d.ply", 0.2},
                                         Case{"clean/pmp_fandisk.off", 0.9}, Case{"clean/pygeo_bwb.stl", 0.9},
                                         Case{"clean/pymeshlab_airplane_airplane.obj", 0.9}, Case{"clean/vspgeom_geom2_geom2.stl", 0.98}));

// hinge and part1 had 0.70 and 0.91 before the extrusion lowered prisms with a dual sub-volume that is not positive (G4): 0.57 and 0.86.
INSTANTIATE_TEST_SUITE_P(NastyButClean, RealSurface,
                         testing::Values(Case{"nasty/axom_surf_cap.stl", 0.9}, Case{"nasty/nasty_admesh_normal-directions-bad.stl", 0.9},
                                         Case{"nasty/nasty_trimesh_busted.STL", 0.9}, Case{"nasty/netgen_parts_hinge.stl", 0.55},
                                         Case{"nasty/netgen_parts_part1.stl", 0.7}, Case{"nasty/netgen_plane_plane.stl", 0.86}));

}  // namespace
}  // namespace sterna::volmesh
