// Actuator discs that end on walls with layers. Envelope and columns are made on the closed wall, with the outlines' vertices held in the disc's plane. Then
// the columns are separated along that plane: each outline vertex gets a second growth line, for the columns downstream, and the sides of the columns in the
// plane belong to both sides of the disc.
#pragma once

#include <functional>
#include <vector>

#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/domain/cut_discs.h"
#include "volmesh/domain/domain_parts.h"
#include "volmesh/rims/close_ends.h"
#include "volmesh/rims/end_surface.h"

namespace sterna::volmesh {

struct SlitOptions {
  double size_growth = 1.2;  ///< growth of the size field
  EndOptions ends;
  std::function<double(const Point&)> size = {};  ///< longest edge, in addition to the disc's own limit, m; may be empty
};

/// Finds the outlines on the wall, constrains them to the planes of their discs, and keeps the layers beside them on their sides. Adds one side of each disc
/// as if the layer had no height: layers of other walls keep clear of it. \p size_growth: of the size field
/// \pre `domain` of the cut boundary, its wall2surface too; all other discs are already part of it
/// \throws Error(self_intersection) with locations if a disc intersects anything but its outlines
void add_slits(const TriMesh& boundary, const DiscCuts& cuts, const std::vector<ActuatorDisc>& discs, double size_growth, const RunContext& context,
               Domain& domain);

/// Adds both sides of the discs beyond the layer, after the existing triangles; patches of the downstream sides are added.
/// \pre `base` of domain.wall, envelope valid; `outer` of close_ends()
/// \throws as close_ends()
void close_slits(const Domain& domain, const LayerBase& base, const EnvelopeShape& envelope, const std::vector<ActuatorDisc>& discs, const SlitOptions& options,
                 const RunContext& context, ClosedOuter& outer);

/// An edge between two growth lines at which columns end on a patch, oriented as in the base triangle.
struct LayerSide {
  std::uint32_t from = 0, to = 0;  ///< growth lines
  PatchId patch;                   ///< patch of the outer boundary
};

/// Returns the edges at which columns end on patches without layers: open boundaries of the wall, and outlines of discs on both sides.
std::vector<LayerSide> layer_sides(const Domain& domain);

/// Returns the growth line under a corner of a wall triangle: its vertex, or downstream of a disc the second growth line there.
std::uint32_t line_under(const Domain& domain, TriangleId t, std::size_t corner);

/// Adds the second growth lines, after all existing ones, at the same locations to the bit; columns downstream stand on them.
/// \pre layers and points of the closed wall
void open_slits(const Domain& domain, LayerBlock& layers, std::vector<Point>& points);
/// Adds the layer targets of the second growth lines.
/// \pre `request` of the closed wall
void open_slits(const Domain& domain, LayerRequest& request);

}  // namespace sterna::volmesh
