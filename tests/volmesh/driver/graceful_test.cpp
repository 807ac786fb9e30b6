// Layers far thicker than the surface allows: the layer compresses and collapses where necessary, the mesh is still valid, and the report names the locations.
#include <gtest/gtest.h>

#include "geom/base/error.h"
#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/test_shapes.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

struct Settings {
  const char* name;
  double first_height;  ///< body lengths
  int layers;
};

class TooThick : public testing::TestWithParam<std::tuple<const char*, Settings>> {};

TEST_P(TooThick, EndsInAValidMesh) {
  STERNA_NEEDS_SHARED_DATA();
  const auto& [file, settings] = GetParam();
  std::vector<std::string> warnings;
  const RunContext context({.threads = 2, .log = [&](LogLevel level, std::string_view text) {
                              if (level == LogLevel::warning) warnings.emplace_back(text);
                            }});
  const SurfaceSoup soup = io::read_surface_file(test::shared_data() / "surfaces" / file, context);
  const TriMesh wall = surfmesh::stitch_surface({soup}, {}, context).mesh;
  const double length = body_length(wall);
  MeshCase options;
  options.envelope.layers = settings.layers;
  options.envelope.first_height = settings.first_height * length;
  options.envelope.max_growth = 1.6;
  options.envelope.max_thickness = 0.3 * length;
  options.farfield.farfield_radius = 10 * length;
  const VolumeMeshResult result = volume_mesh(wall, options, context);
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_TRUE(result.certificate.is_proved()) << to_text(result.certificate);

  const LayerReport& layer = result.layer;
  double lost = 0.0, area = 0.0, full = 0.0;
  for (const auto& [reason, share] : layer.lost_area) lost += share;
  EXPECT_NEAR(layer.coverage + lost, 1.0, 1e-9);
  for (const PatchLayerReport& patch : layer.patches) {
    area += patch.area;
    full += patch.area * patch.full;
    EXPECT_LE(patch.full + patch.collapsed, 1.0 + 1e-9);
    EXPECT_LE(patch.compressed + patch.collapsed, 1.0 + 1e-9);
  }
  EXPECT_NEAR(full / area, layer.coverage, 1e-9);
  EXPECT_EQ(layer.collapsed.empty(), layer.collapsed_area == 0.0);
  for (const ErrorLocation& location : layer.collapsed) EXPECT_NE(location.what.find("of patch"), std::string::npos);
  EXPECT_EQ(layer.warnings.empty(), layer.compressed_area <= 0.5);
  for (const std::string& warning : layer.warnings) EXPECT_NE(std::find(warnings.begin(), warnings.end(), warning), warnings.end());
}

constexpr Settings k_thick{"thick", 1e-4, 20};
constexpr Settings k_thicker{"thicker", 1e-2, 30};  // thirty layers of a hundredth of the body

INSTANTIATE_TEST_SUITE_P(Clean, TooThick,
                         testing::Combine(testing::Values("clean/caturbs_wing_wing.stl", "clean/cgal_data_couplingdown.off", "clean/gmsh_stl_TwoObjects.stl.gz",
                                                          "clean/meshpy_ka6d_ka-6d.ply", "clean/pygeo_bwb.stl", "clean/cgal_data_anchor_dense.off"),
                                          testing::Values(k_thick, k_thicker)),
                         [](const auto& info) { return std::string(std::get<1>(info.param).name) + std::to_string(info.index); });
INSTANTIATE_TEST_SUITE_P(Nasty, TooThick,
                         testing::Combine(testing::Values("nasty/nasty_trimesh_featuretype.STL", "nasty/netgen_parts_hinge.stl",
                                                          "nasty/netgen_plane_plane.stl"),
                                          testing::Values(k_thick, k_thicker)),
                         [](const auto& info) { return std::string(std::get<1>(info.param).name) + std::to_string(info.index); });

TEST(WrongUnit, LayerThinnerThanItsCellsGivesWarning) {
  const TriMesh wall = test::sphere(5, 1e-3);  // coordinates in metres that were meant in millimetres
  MeshCase options;
  options.envelope.layers = 10;
  options.envelope.first_height = 1e-3;
  options.envelope.max_thickness = 1e-3;
  const VolumeMeshResult result = volume_mesh(wall, options, RunContext({.threads = 2}));
  ASSERT_EQ(result.layer.warnings.size(), 1u);
  EXPECT_NE(result.layer.warnings[0].find("unit"), std::string::npos);
  EXPECT_GT(result.layer.compressed_area + result.layer.collapsed_area, 0.99);
}

TEST(OuterBoundary, WallThatDoesNotFitIsRefused) {
  const TriMesh wall = test::cube(3);
  MeshCase options;
  options.envelope.first_height = 1e-4;
  options.farfield.farfield_radius = 0.8;  // the corners are at a distance of 0.87 from the centre
  try {
    volume_mesh(wall, options, RunContext({.threads = 2}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_TRUE(error.code() == ErrorCode::self_intersection || error.code() == ErrorCode::bad_argument) << error.what();
  }
}

}  // namespace
}  // namespace sterna::volmesh
