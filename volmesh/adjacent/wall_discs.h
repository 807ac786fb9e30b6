// Actuator discs that end on walls with layers. Envelope and columns are made on the closed wall, and the vertices of the outlines stay in the plane of the
// disc. Then the columns are separated along that plane. Each outline vertex gets a second growth line for the columns downstream. The sides of the columns in
// the plane belong to the two sides of the disc.
#pragma once

#include <functional>
#include <vector>

#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/adjacent/adjacent_surface.h"
#include "volmesh/adjacent/close_boundary.h"
#include "volmesh/domain/cut_discs.h"
#include "volmesh/domain/domain_parts.h"

namespace sterna::volmesh {

struct WallDiscOptions {
  double size_growth = 1.2;  ///< growth of the size field
  EndOptions ends;
  std::function<double(const Point&)> size = {};  ///< longest edge at a location, m, in addition to the disc's own limit; may be empty
};

/// Finds the outlines on the wall, constrains them to the planes of their discs, and keeps the layers beside them on their side of the plane. Adds one side of
/// each disc as if the layer had no height, so that layers of other walls keep clear of it. \p size_growth growth of the size field
/// \pre `domain` and its wall2surface belong to the cut boundary; all other discs are already part of the domain
/// \throws Error(self_intersection) with locations if a disc intersects something other than its outlines
void add_wall_discs(const TriMesh& boundary, const DiscCuts& cuts, const std::vector<ActuatorDisc>& discs, double size_growth, const RunContext& context,
                    Domain& domain);

/// Adds both sides of the discs beyond the layer, after the existing triangles. Adds the patches of the downstream sides.
/// \pre `base` belongs to domain.wall, the envelope is valid, and `outer` was returned by close_boundary()
/// \throws the errors of close_boundary()
void close_wall_discs(const Domain& domain, const LayerBase& base, const EnvelopeShape& envelope, const std::vector<ActuatorDisc>& discs,
                      const WallDiscOptions& options, const RunContext& context, ClosedOuter& outer);

/// An edge between two growth lines at which columns end on a patch. It is oriented as in the base triangle.
struct LayerSide {
  std::uint32_t from = 0, to = 0;  ///< growth lines
  PatchId patch;                   ///< patch of the outer boundary
};

/// Returns the edges at which columns end on patches without layers: open boundaries of the wall, and both sides of the outlines of discs.
std::vector<LayerSide> layer_sides(const Domain& domain);

/// Returns the growth line below a corner of a wall triangle: its vertex, or downstream of a disc the second growth line of the vertex.
std::uint32_t line_under(const Domain& domain, TriangleId t, std::size_t corner);

/// Adds the second growth lines after all existing ones, at bit-exactly the same locations. The columns downstream stand on them.
/// \pre layers and points belong to the closed wall
void open_wall_discs(const Domain& domain, LayerBlock& layers, std::vector<Point>& points);
/// Adds the layer targets of the second growth lines.
/// \pre `request` belongs to the closed wall
void open_wall_discs(const Domain& domain, LayerRequest& request);

}  // namespace sterna::volmesh
