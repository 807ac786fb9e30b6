// The outer boundary around a layer that is known: patches on which it ends are triangulated anew around its footprint.
#pragma once

#include <functional>

#include "volmesh/domain/domain_parts.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/rims/end_surface.h"

namespace sterna::volmesh {

/// The outer boundary of the space for tetrahedra.
struct ClosedOuter {
  TriMesh mesh;                     ///< patches of Domain::outer
  Column<VertexId, VertexId> line;  ///< of each vertex: the wall vertex whose top it is (at a collapsed one the wall's own); invalid elsewhere
};

/// An outer boundary that shares nothing with a wall.
ClosedOuter unlinked(TriMesh outer);

struct CloseEndsOptions {
  EndOptions ends;
  std::function<double(const Point&)> size = {};  ///< longest edge, m; may be empty
};

/// Without rims the outer boundary as it is. Discs that end on walls are left out (rims/slits.h adds them). Of periodic sides the second has the triangles of
/// the first, moved. Common edges of end patches keep their polygon beyond the layer, with new vertices there; end patches whose triangulation has vertices
/// inside keep its edge lengths as an upper limit.
/// Where a fan of an opened ridge stands in an end patch, its tops are part of the footprint.
/// \pre `base` of domain.wall and its constraints; envelope valid, tops of rim vertices on their surfaces
/// \throws Error(self_intersection, envelope_failed) with places and the patch's name where a footprint does not fit into its patch
ClosedOuter close_ends(const Domain& domain, const LayerBase& base, const EnvelopeShape& envelope, const CloseEndsOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
