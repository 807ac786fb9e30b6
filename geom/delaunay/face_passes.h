// The passes of mesh_face that insert and that improve vertices.
#pragma once

#include "geom/delaunay/face_state.h"

namespace sterna::delaunay {

/// Inserts vertices by the empty circle of the plane until the triangles follow the surface well enough for measures in space to mean something: within
/// k_unfolded_angle of its normals, or small. Afterwards flips to the criterion of space.
void unfold(FaceState& state, FaceMeshReport& report, const RunContext& context);

/// First pass: edges of the wanted length. New vertices complete triangles on edges that are done, front by front (Rebay 1993), then wherever one is still too
/// large.
void refine_by_size(FaceState& state, FaceMeshReport& report, const RunContext& context);

/// Second pass: triangles with a small angle get their circumcentre, where it is not too near to something.
void refine_by_quality(FaceState& state, FaceMeshReport& report, const RunContext& context);

/// Joins inner vertices at the end of edges much shorter than wanted to their neighbour.
void collapse_short_edges(FaceState& state, FaceMeshReport& report, const RunContext& context);

/// Removes inner vertices with three or four neighbours, which have a large angle, where that makes it better.
void remove_poor_vertices(FaceState& state, FaceMeshReport& report);

/// Moves vertices on the surface towards where their triangles are equilateral, only where the worst of them gets better; flips after each sweep.
void smooth(FaceState& state, FaceMeshReport& report, const RunContext& context);

}  // namespace sterna::delaunay
