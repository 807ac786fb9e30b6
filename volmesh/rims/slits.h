// Actuator discs that end on walls with layers. Envelope and columns are made on the closed wall, the outlines' vertices held in the disc's plane; then the
// columns are parted along that plane: each outline vertex gets a second line of nodes, for the columns downstream, and the sides of the columns in the plane
// belong to both sides of the disc.
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
  double size_growth = 1.2;  ///< of the size field
  EndOptions ends;
  std::function<double(const Point&)> size = {};  ///< longest edge beside the disc's own, m; may be empty
};

/// Finds the outlines on the wall, holds them in their planes, keeps layers beside them on their sides, and adds one side of each disc as if the layer had no
/// height: what layers of other walls keep clear of. \p size_growth: of the size field
/// \pre `domain` of the cut boundary, its wall2surface too; other discs are in it already
/// \throws Error(self_intersection) with places where a disc meets anything but its outlines
void add_slits(const TriMesh& boundary, const DiscCuts& cuts, const std::vector<ActuatorDisc>& discs, double size_growth, const RunContext& context,
               Domain& domain);

/// Both sides of the discs beyond the layer, behind what is there; patches of the downstream sides are added.
/// \pre `base` of domain.wall, envelope valid; `outer` of close_ends()
/// \throws as close_ends()
void close_slits(const Domain& domain, const LayerBase& base, const EnvelopeShape& envelope, const std::vector<ActuatorDisc>& discs, const SlitOptions& options,
                 const RunContext& context, ClosedOuter& outer);

/// An edge between two lines at which columns end on a patch, as the base triangle has it.
struct LayerSide {
  std::uint32_t from = 0, to = 0;  ///< lines
  PatchId patch;                   ///< of the outer boundary
};

/// Where columns end on patches without layers: at rims of the wall, and at outlines of discs on both sides.
std::vector<LayerSide> layer_sides(const Domain& domain);

/// The line of the layer under a corner of a wall triangle: its vertex, or downstream of a disc the second one there.
std::uint32_t line_under(const Domain& domain, TriangleId t, std::size_t corner);

/// Second lines, behind all that are there, at the same places to the bit; columns downstream stand on them.
/// \pre layers and points of the closed wall
void open_slits(const Domain& domain, LayerBlock& layers, std::vector<Point>& points);
/// What is asked of the second lines.
/// \pre of the closed wall
void open_slits(const Domain& domain, LayerRequest& request);

}  // namespace sterna::volmesh
