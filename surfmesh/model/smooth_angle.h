// Largest turn between triangles where the model is smooth. A feature angle must exceed it (docs/method/envelope.md, "Feature angle").
#pragma once

#include "surfmesh/model/mesh_faces.h"

namespace sterna::surfmesh {

/// The largest angle between the normals of two triangles that share an edge. The edge lies inside a face, or on an edge of the model at which the exact
/// normals of both faces agree (within 5 degrees at both ends). Creases of the model do not count.
struct SmoothAngle {
  double angle = 0.0;  ///< rad
  Point location{};    ///< middle of that edge
  /// The largest such angle without spots. A spot is a group of connected edges that turn by more than 45 degrees, extend over at most 25 edge lengths, and
  /// whose triangles follow the surface. The radius of the model is small compared to the edges there (points of cones, round tips above thin trailing edges).
  /// Spots of a face that together extend over more than 50 edges count.
  double angle_outside_spots = 0.0;  ///< rad
  Point place_outside_spots{};
};
SmoothAngle measure_smooth_angle(const Model& model, const Column<FaceId, MeshedFace>& faces, const RunContext& context);

}  // namespace sterna::surfmesh
