// Passes of mesh_face that insert and improve vertices.
#pragma once

#include "geom/delaunay/face_state.h"

namespace sterna::delaunay {

/// Inserts vertices by the empty circle of the plane until the triangles follow the surface well enough for measures in space to be meaningful: their normals
/// are close to the surface's (k_unfolded_cosine), or they are small. Then flips to the criterion of space.
void unfold(FaceState& state, FaceMeshReport& report, const RunContext& context);

/// First pass: edges of the target length. New vertices complete triangles on edges of sufficient length, front by front (Rebay 1993); then vertices are
/// inserted in any triangle that is still too large.
void refine_by_size(FaceState& state, FaceMeshReport& report, const RunContext& context);

/// Second pass: inserts the circumcentres of triangles with a small angle, unless they are too near to other vertices.
void refine_by_quality(FaceState& state, FaceMeshReport& report, const RunContext& context);

/// Merges inner vertices at the end of edges much shorter than the target length with their neighbour.
void collapse_short_edges(FaceState& state, FaceMeshReport& report, const RunContext& context);

/// Removes inner vertices with three or four neighbours, which have a large angle, if that improves the triangles.
void remove_poor_vertices(FaceState& state, FaceMeshReport& report);

/// Moves vertices on the surface towards positions where their triangles are equilateral, only if the worst of them improves; flips after each sweep.
void smooth(FaceState& state, FaceMeshReport& report, const RunContext& context);

}  // namespace sterna::delaunay
