// Compares a run that is stopped after each step and continued with an uninterrupted run.
#pragma once

#include <gtest/gtest.h>

#include "tests/support/test_constants.h"
#include "volmesh/stages.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {

inline void expect_same_mesh(const VolumeMeshResult& result, const VolumeMeshResult& whole) {
  EXPECT_EQ(result.mesh.points, whole.mesh.points);
  EXPECT_EQ(result.mesh.tetrahedra, whole.mesh.tetrahedra);
  EXPECT_EQ(result.mesh.prisms, whole.mesh.prisms);
  EXPECT_EQ(result.mesh.pyramids, whole.mesh.pyramids);
  EXPECT_EQ(result.mesh.hexahedra, whole.mesh.hexahedra);
  EXPECT_EQ(result.mesh.layers.line_layers, whole.mesh.layers.line_layers);
  EXPECT_EQ(result.mesh.layers.base, whole.mesh.layers.base);
  EXPECT_EQ(result.mesh.layers.first_node, whole.mesh.layers.first_node);
  EXPECT_EQ(result.mesh.layers.is_collapsed, whole.mesh.layers.is_collapsed);
  EXPECT_EQ(result.mesh.request.target_height, whole.mesh.request.target_height);
  EXPECT_EQ(result.mesh.request.reason, whole.mesh.request.reason);
  EXPECT_EQ(to_json(result.check), to_json(whole.check));
  EXPECT_EQ(to_text(result.certificate), to_text(whole.certificate));
  EXPECT_EQ(result.layer.coverage, whole.layer.coverage);
  EXPECT_EQ(result.layer.reduced_curving, whole.layer.reduced_curving);
  EXPECT_EQ(result.layer.feature_angle, whole.layer.feature_angle);
  EXPECT_EQ(result.tetra_engine, whole.tetra_engine);
  EXPECT_EQ(result.n_split_triangles, whole.n_split_triangles);
}

struct Continued {
  VolumeMeshResult whole;
  int n_rounds = 0;  ///< ClosedMultiNormals::n_rounds
};

/// Stops a run after each step and continues it; the envelope is that of the last round in which multi-normal fans were closed.
inline Continued expect_continued(const TriMesh& wall, const MeshCase& options) {
  EnvelopeStage envelope;
  FilledStage filled;
  const VolumeMeshResult whole = watched_volume_mesh(
      wall, options, {}, {.enveloped = [&](const EnvelopeStage& stage) { envelope = stage; }, .filled = [&](const FilledStage& stage) { filled = stage; }},
      test::k_context);
  EXPECT_EQ(filled.split_wall.has_value(), whole.n_split_triangles > 0);
  expect_same_mesh(finish_mesh(wall, filled, options, test::k_context), whole);
  const FilledStage again = make_tetrahedra(wall, envelope, options, {}, test::k_context);
  EXPECT_EQ(again.tets.tetrahedra, filled.tets.tetrahedra);
  expect_same_mesh(finish_mesh(wall, again, options, test::k_context), whole);
  const EnvelopeStage alone = make_envelope(wall, options, {}, test::k_context);
  if (envelope.closed.n_rounds == 0) {
    EXPECT_EQ(alone.envelope.height, envelope.envelope.height);
    EXPECT_EQ(alone.envelope.direction, envelope.envelope.direction);
  } else {  // all rounds again
    expect_same_mesh(finish_mesh(wall, make_tetrahedra(wall, alone, options, {}, test::k_context), options, test::k_context), whole);
  }
  return {whole, envelope.closed.n_rounds};
}

}  // namespace sterna::volmesh
