// Renumbers a triangulation that was generated front by front, so that neighbours are close in memory for the following passes.
#pragma once

#include "geom/delaunay/surface_triangulation.h"

namespace sterna::delaunay {

/// Numbers inner vertices along a Hilbert curve in the plane and triangles by their lowest vertex; drops removed vertices and dead slots. The border keeps its
/// numbers. \return the former id of every vertex
Column<VertexId, VertexId> renumber(SurfaceTriangulation& surface);

}  // namespace sterna::delaunay
