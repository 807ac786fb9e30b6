// The outer boundary around a known layer: adjacent patches, on which the layer ends, are re-meshed around its footprint.
#pragma once

#include <functional>

#include "volmesh/domain/domain_parts.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/rims/end_surface.h"

namespace sterna::volmesh {

/// Outer boundary of the volume for the tetrahedra.
struct ClosedOuter {
  TriMesh mesh;                     ///< patches of Domain::outer
  Column<VertexId, VertexId> line;  ///< per vertex: the wall vertex whose top is at this vertex (the wall vertex itself if collapsed); invalid elsewhere
};

/// Returns an outer boundary without vertices in common with a wall.
ClosedOuter unlinked(TriMesh outer);

struct CloseEndsOptions {
  EndOptions ends;
  std::function<double(const Point&)> size = {};  ///< longest edge, m; may be empty
};

/// Closes the outer boundary. Without open boundaries of the wall the outer boundary is returned unchanged. Discs that end on walls are excluded
/// (rims/slits.h adds them). Of two periodic sides the second gets the translated triangles of the first. Common edges of adjacent patches keep their polygon
/// beyond the layer, with new vertices on it; adjacent patches whose triangulation has vertices inside keep its edge lengths as an upper limit. Where a
/// multi-normal fan of an opened ridge lies in an adjacent patch, its tops are part of the footprint.
/// \pre `base` of domain.wall and its constraints; envelope valid, tops of open-boundary vertices on their surfaces
/// \throws Error(self_intersection, envelope_failed) with locations and the patch's name if a footprint does not fit into its patch
ClosedOuter close_ends(const Domain& domain, const LayerBase& base, const EnvelopeShape& envelope, const CloseEndsOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
