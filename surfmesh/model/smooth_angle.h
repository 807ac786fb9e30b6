// How far the triangles turn where the model does not: what a feature angle has to exceed (method.md section 1).
#pragma once

#include "surfmesh/model/mesh_faces.h"

namespace sterna::surfmesh {

/// The largest angle between the normals of two triangles that share an edge inside a face, or on an edge of the model across which the exact normals agree
/// (within 5 degrees at both ends). Creases of the model do not count.
struct SmoothAngle {
  double angle = 0.0;  ///< rad
  Point place{};       ///< middle of that edge
};
SmoothAngle measure_smooth_angle(const Model& model, const Column<FaceId, MeshedFace>& faces, const RunContext& context);

}  // namespace sterna::surfmesh
