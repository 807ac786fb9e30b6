// A run that is stopped after a step and continued gives the mesh of the uninterrupted run, to the bit.
#include "volmesh/stages.h"

#include <gtest/gtest.h>

#include "geom/base/error.h"
#include "tests/support/error_of.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/driver/continued.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

MeshCase options_for(const TriMesh& wall) {
  MeshCase options;
  options.envelope.layers = 8;
  options.envelope.first_height = 1e-4 * body_length(wall);
  options.farfield.farfield_radius = 5.0 * body_length(wall);
  return options;
}

TEST(Stages, ContinuedMeshesAreTheSame) {
  const TriMesh wall = test::cube(4);
  expect_continued(wall, options_for(wall));
}

TEST(Stages, ContinuedMeshesAreTheSameAfterSplits) {
  const TriMesh wall = test::cube(3);
  MeshCase options = options_for(wall);
  options.tetrahedra.boundary_splits = "always";
  options.tetrahedra.radius_edge = 1.6;
  options.sources.push_back({.kind = SourceKind::point, .from = {1.3, 0.4, 0.6}, .size = 0.05});
  expect_continued(wall, options);
}

TEST(Stages, PartsOfDifferentRunsAreRefused) {
  const TriMesh wall = test::cube(3), other = test::cube(2);
  const MeshCase options = options_for(wall);
  const EnvelopeStage envelope = make_envelope(wall, options, {}, k_context);
  const auto expect_refused = [](const std::string& problem, const auto& call) {
    try {
      call();
      FAIL() << "not refused";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      EXPECT_NE(std::string(error.what()).find(problem), std::string::npos) << error.what();
    }
  };
  expect_refused("vertices of the envelope", [&] { make_tetrahedra(other, envelope, options, {}, k_context); });
  const FilledStage filled = make_tetrahedra(wall, envelope, options, {}, k_context);
  expect_refused("vertices of the envelope", [&] { finish_mesh(other, filled, options, k_context); });
  FilledStage wrong = filled;
  wrong.layers.layers.base[0] = {0, 1, 1};
  expect_refused("outer triangles of the layer that are not on", [&] { finish_mesh(wall, wrong, options, k_context); });
  wrong = filled;
  wrong.layers.points[NodeId(0)].x += 1e-9;
  expect_refused("outer triangles of the layer that are not on", [&] { finish_mesh(wall, wrong, options, k_context); });
  wrong = filled;
  wrong.tets.tetrahedra.pop_back();
  test::expect_error(ErrorCode::tetra_result_invalid, "outer faces that are not a boundary triangle",
                     [&] { (void)finish_mesh(wall, wrong, options, k_context); });
}

}  // namespace
}  // namespace sterna::volmesh
