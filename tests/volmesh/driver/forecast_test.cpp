// The required memory is reported before the mesh is made. Too large a mesh is an error before the work starts, with the figures and a remedy; the figures are
// approximately right.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "io/file/surface_file.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/test_shapes.h"
#include "volmesh/forecast.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

/// Returns the number of tetrahedra in the last line of the form "about 2.77 M prisms and 688 k tetrahedra, 0.33 GB ...".
double told_tetrahedra(const std::vector<std::string>& lines) {
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    const std::size_t at = line->find(" prisms and ");
    if (at == std::string::npos) continue;
    double number = 0.0;
    char unit = ' ';
    if (std::sscanf(line->c_str() + at, " prisms and %lf %c", &number, &unit) == 2) return number * (unit == 'M' ? 1e6 : 1e3);
  }
  return std::nan("");
}

struct Heard {
  std::vector<std::string> lines, warnings;
  RunContext context() {
    return RunContext({.threads = 2, .log = [this](LogLevel level, std::string_view text) {
                         lines.emplace_back(text);
                         if (level == LogLevel::warning) warnings.emplace_back(text);
                       }});
  }
};

MeshCase of_sphere(int n_layers) {
  MeshCase options;
  options.envelope.layers = n_layers;
  options.envelope.first_height = 1e-3;
  options.envelope.max_growth = 1.4;
  options.farfield.farfield_radius = 20.0;
  return options;
}

TEST(Forecast, TooMuchIsAnErrorBeforeTheWork) {
  MeshCase options = of_sphere(20);
  options.limits.max_memory = 62e6;
  Heard heard;
  const TriMesh wall = test::sphere(12);
  test::expect_error(ErrorCode::overflow, "limits.max_memory is 0.062 GB", [&] { volume_mesh(wall, options, heard.context()); });
  test::expect_error(ErrorCode::overflow, "force = true", [&] { volume_mesh(wall, options, heard.context()); });
  for (const std::string& line : heard.lines) EXPECT_EQ(line.find("envelope"), std::string::npos) << line;  // no work was started
}

TEST(Forecast, ForceGoesOnToTheSameMesh) {
  const TriMesh wall = test::sphere(6);
  MeshCase options = of_sphere(8);
  const VolumeMeshResult usual = volume_mesh(wall, options, RunContext({.threads = 2}));
  options.limits = {.max_memory = 1e6, .force = true};
  Heard heard;
  const VolumeMeshResult forced = volume_mesh(wall, options, heard.context());
  EXPECT_EQ(usual.mesh.points.raw(), forced.mesh.points.raw());
  EXPECT_EQ(usual.mesh.tetrahedra, forced.mesh.tetrahedra);
  ASSERT_FALSE(heard.warnings.empty());
  EXPECT_NE(heard.warnings.front().find("are expected"), std::string::npos) << heard.warnings.front();
}

/// Tolerance: the forecast supports the decision whether to start, so a factor of two is sufficient; real meshes are within a third.
TEST(Forecast, CountsTetrahedraAboutRight) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* file : {"clean/vspgeom_geom2_geom2.stl", "clean/pygeo_bwb.stl", "clean/flowpanel_duct_duct_remeshed_refined.msh", "clean/pmp_fandisk.off"}) {
    SCOPED_TRACE(file);
    Heard heard;
    const RunContext context = heard.context();
    const TriMesh wall = surfmesh::stitch_surface({io::read_surface_file(test::shared_data() / "surfaces" / file, context)}, {}, context).mesh;
    MeshCase options;
    const double length = body_length(wall);
    options.envelope = {.layers = 20, .first_height = 1e-4 * length, .max_growth = 1.3};
    options.farfield.farfield_radius = 20.0 * length;
    const VolumeMeshResult result = volume_mesh(wall, options, context);
    const double expected = told_tetrahedra(heard.lines), made = static_cast<double>(result.mesh.tetrahedra.size());
    EXPECT_GT(expected, 0.5 * made) << made;
    EXPECT_LT(expected, 2.0 * made) << made;
  }
}

}  // namespace
}  // namespace sterna::volmesh
