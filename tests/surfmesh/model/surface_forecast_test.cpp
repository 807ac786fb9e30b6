// The predicted number of triangles against the actual number, and the reported cause.
#include "surfmesh/model/surface_forecast.h"

#include <gmock/gmock.h>

#include "geom/model/shapes.h"
#include "io/file/cad_file.h"
#include "surfmesh/model/surface_mesh.h"
#include "tests/support/data.h"
#include "tests/support/test_constants.h"

namespace sterna::surfmesh {
namespace {

using testing::HasSubstr;

using test::k_context;

double made(const Model& model, const SurfaceMeshOptions& options) { return static_cast<double>(mesh_model(model, options, {}, k_context).mesh.n_triangles()); }

TEST(SurfaceForecast, IsNearWhatIsMade) {
  const Model box = make_box("box", {0, 0, 0}, {1, 0.4, 0.2});
  for (const double edge : {0.1, 0.03}) {
    SurfaceMeshOptions options;
    options.sizes.max_edge = edge;
    const double n = forecast_surface(box, options, {}, {}, k_context).n_triangles, made_of_it = made(box, options);
    EXPECT_NEAR(n / made_of_it, 1.0, 0.3) << edge;
  }
  STERNA_NEEDS_SHARED_DATA();
  for (const char* file : {"gmsh_parts_mambo_s34.step", "netgen_parts_screw.step", "netgen_parts_frame.step", "tigl_simplewing_simplewing.brep",
                           "refine_m6_onera-m6-sharp-te.egads.brep"}) {
    const Model model = io::read_cad(test::shared_data() / "cad" / file, {}, k_context).model;
    const double n = forecast_surface(model, {}, {}, {}, k_context).n_triangles, made_of_it = made(model, {});
    RecordProperty(file, std::to_string(n) + " predicted, " + std::to_string(made_of_it) + " made");
    EXPECT_NEAR(n / made_of_it, 1.0, 0.3) << file << ": " << n << " predicted, " << made_of_it << " made";
  }
}

TEST(SurfaceForecast, CauseIsRuleThatRequiresMost) {
  const Model box = make_box("box", {0, 0, 0}, {1, 0.4, 0.2});
  SurfaceMeshOptions options;
  options.sizes.max_edge = 0.001;
  const SurfaceForecast fine = forecast_surface(box, options, {}, {}, k_context);
  EXPECT_GT(fine.n_triangles, 1e6);
  ASSERT_EQ(fine.largest.size(), k_forecast_faces);
  EXPECT_THAT(fine.largest.front().rule, HasSubstr("max_edge = 0.001 m"));
  EXPECT_THAT(fine.largest.front().advice, HasSubstr("max_edge"));
  EXPECT_GE(fine.largest[0].n_triangles, fine.largest[1].n_triangles);

  // A blade as thin as foil: edges along the blade are twice as long as its thickness.
  const SurfaceForecast thin = forecast_surface(make_box("blade", {0, 0, 0}, {1, 0.5, 2e-4}), {}, {}, {}, k_context);
  EXPECT_THAT(thin.largest.front().rule, HasSubstr("0.0002 m")) << thin.n_triangles;
  EXPECT_THAT(thin.largest.front().advice, HasSubstr("min_edge"));
}

}  // namespace
}  // namespace sterna::surfmesh
