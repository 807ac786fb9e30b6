// New numbers for a triangulation that grew front by front, so that the passes which follow find neighbours near each other in memory.
#pragma once

#include "geom/delaunay/surface_triangulation.h"

namespace sterna::delaunay {

/// Numbers inner vertices along Hilbert's curve in the plane and triangles by their least vertex; drops removed vertices and dead slots. The border keeps its
/// numbers. \return the former id of every vertex
Column<VertexId, VertexId> renumber(SurfaceTriangulation& surface);

}  // namespace sterna::delaunay
