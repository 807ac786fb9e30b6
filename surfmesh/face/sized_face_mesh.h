// Meshes a parametric face with sizes that follow its curvature: geom/delaunay/face_mesh.h with the sizes required by the surface.
#pragma once

#include "geom/delaunay/face_mesh.h"

namespace sterna::surfmesh {

using delaunay::BorderPoint;
using delaunay::FaceBorder;
using delaunay::FaceMesh;
using delaunay::FaceMeshOptions;
using delaunay::FaceMeshReport;
using delaunay::mesh_face;
using delaunay::SizeFunction;

/// Calls delaunay::mesh_face with `size`, reduced where edges of that length would span more than `curvature_angle`.
/// \throws as delaunay::mesh_face
FaceMesh mesh_face(const Surface& surface, const FaceBorder& border, const SizeFunction& size, const FaceMeshOptions& options, const RunContext& context);

}  // namespace sterna::surfmesh
