// The outer boundary around a known layer. Adjacent patches, on which the layer ends, are re-meshed around its footprint.
#pragma once

#include <functional>

#include "volmesh/adjacent/adjacent_surface.h"
#include "volmesh/domain/domain_parts.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Outer boundary of the volume for the tetrahedra.
struct ClosedOuter {
  TriMesh mesh;  ///< mesh with the patches of Domain::outer
  /// For each vertex the wall vertex whose top it is (of a collapsed wall vertex: the wall vertex itself); invalid for other vertices.
  Column<VertexId, VertexId> line;
};

/// Returns an outer boundary that has no vertices in common with a wall.
ClosedOuter unlinked(TriMesh outer);

struct CloseBoundaryOptions {
  EndOptions ends;
  std::function<double(const Point&)> size = {};  ///< longest edge at a location, m; may be empty
};

/// Closes the outer boundary. Without open boundaries of the wall the outer boundary is returned unchanged. Discs that end on walls are left out
/// (adjacent/wall_discs.h adds them). On periodic sides, the second side gets the translated triangles of the first. Common edges of adjacent patches keep
/// their polygon beyond the layer, with new vertices on it. If the triangulation of an adjacent patch has inner vertices, its edge lengths stay as an upper
/// limit. Where a multi-normal fan of an opened ridge lies in an adjacent patch, its tops are part of the footprint.
/// \pre `base` belongs to domain.wall and its constraints; the envelope is valid, and the tops of open-boundary vertices are on their surfaces
/// \throws Error(self_intersection, envelope_failed) with locations and the patch's name if a footprint does not fit into its patch
ClosedOuter close_boundary(const Domain& domain, const LayerBase& base, const EnvelopeShape& envelope, const CloseBoundaryOptions& options,
                           const RunContext& context);

}  // namespace sterna::volmesh
