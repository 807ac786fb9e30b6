// Periodic pairs of flat sides of a model. One side is the translated image of the other. The border edges of both sides are matched piece by piece so that
// both are cut in the same way.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/mesh/periodic_names.h"
#include "geom/mesh/size_points.h"
#include "surfmesh/model/edge_samples.h"
#include "surfmesh/model/model_topology.h"

namespace sterna::surfmesh {

/// Returns a name such as "symmetry_y_min". volume_mesh gives this name to the plane that closes the open end of a wall if the other end of that axis has such
/// a plane, too.
std::string open_plane_name(std::size_t axis, bool is_max);
bool is_open_plane(std::string_view name);

/// A location inside an edge that must be a vertex: the image of a corner of another border.
struct BorderStop {
  double t = 0.0;
  Point point;
};

/// An edge of a border, or the part of it between two stops.
struct PeriodicPiece {
  EdgeId edge;
  Interval range;            ///< range of the edge's parameter
  std::size_t like = 0;      ///< number of the piece whose cuts, translated, this piece takes; for the first piece of each kind its own number
  Vec3 translation;          ///< m, from that piece to this one
  bool is_reversed = false;  ///< its parameter runs against that of the other piece
};

/// Borders of all pairs. Pieces of an edge are consecutive in `pieces`, ascending.
struct PeriodicBorders {
  std::vector<PeriodicPiece> pieces;
  Column<EdgeId, std::vector<BorderStop>> stops;       ///< stops between the pieces of an edge, ascending
  Column<EdgeId, std::array<std::size_t, 2>> of_edge;  ///< first piece and number of pieces; zero for edges on no border
  std::vector<std::vector<std::size_t>> kinds;         ///< for each kind the pieces that are cut alike, ascending, at least two

  bool empty() const { return pieces.empty(); }
};

/// Largest distance of borders from their images as a fraction of the model's box, the same limit as in volume_mesh.
inline constexpr double k_border_tolerance = 1e-6;

/// Finds the borders of the sides: all edges that a side shares with other faces, or the free edges in a plane (open_plane_name). The translation of a pair is
/// computed from its borders. If several corners were absorbed into one, the corner of the image is the image of the remaining corner.
/// \throws Error(bad_argument) for names that no face has (the message lists the existing names), for a side in several pairs, and for borders that are not
/// images of each other (with locations and distances)
PeriodicBorders find_periodic_borders(const Model& model, const Column<EdgeId, EdgeSamples>& edges, std::span<const PeriodicNames> pairs,
                                      ModelTopology& topology);

/// Returns the parameter within `range` at which the edge is nearest to p.
double nearest_parameter(const ModelEdge& edge, const EdgeSamples& samples, const Interval& range, const Point& p);

/// Returns the parameter of a piece that is the image of parameter t of its reference piece.
double image_parameter(const PeriodicBorders& periodic_borders, std::size_t piece, double t, const Model& model, const Column<EdgeId, EdgeSamples>& edges);

class SurfaceSizes;

/// Returns sources at locations of borders where an image has a smaller size. The next SurfaceSizes is then equal on all images.
std::vector<SizePoint> sizes_of_partners(const PeriodicBorders& periodic_borders, const Model& model, const Column<EdgeId, EdgeSamples>& edges,
                                         const SurfaceSizes& field);

}  // namespace sterna::surfmesh
