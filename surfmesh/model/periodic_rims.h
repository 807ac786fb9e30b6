// Pairs of flat sides of a model of which one is the other, moved: the edges of their borders piece by piece, so that all of them are cut alike.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/mesh/size_sites.h"
#include "surfmesh/model/edge_samples.h"
#include "surfmesh/model/model_topology.h"

namespace sterna::surfmesh {

/// Names of two sides.
using SidePair = std::array<std::string, 2>;

/// "left,right; floor,ceiling", as SurfaceMeshOptions::periodic has it, and back.
/// \throws Error(bad_argument) for other text
std::vector<SidePair> side_pairs(std::string_view text);
std::string side_pairs_text(std::span<const SidePair> pairs);

/// "symmetry_y_min": what volume_mesh calls the plane in which the open ends of a wall lie, when there is another at the other end of that axis.
std::string open_plane_name(std::size_t axis, bool is_max);
bool is_open_plane(std::string_view name);

/// A place inside an edge where a vertex has to be: the image of a corner of another border.
struct RimStop {
  double t = 0.0;
  Point point;
};

/// An edge of a border, or the part of it between two stops.
struct RimPiece {
  EdgeId edge;
  Interval range;            ///< of the edge's parameter
  std::size_t like = 0;      ///< number of the piece whose cuts it has, moved; its own for one of each kind
  Vec3 translation;          ///< m, from that one to this
  bool is_reversed = false;  ///< its parameter runs against that one's
};

/// The borders of all pairs. Pieces of an edge follow each other in `pieces`, ascending.
struct PeriodicRims {
  std::vector<RimPiece> pieces;
  Column<EdgeId, std::vector<RimStop>> stops;          ///< ascending, between the pieces of an edge
  Column<EdgeId, std::array<std::size_t, 2>> of_edge;  ///< first piece and number of pieces; none for edges of no border
  std::vector<std::vector<std::size_t>> kinds;         ///< pieces that are cut alike, ascending, two at least

  bool empty() const { return pieces.empty(); }
};

/// Borders may be off their images by this share of the model's box, as volume_mesh takes them.
inline constexpr double k_rim_tolerance = 1e-6;

/// Finds the borders of the sides: all edges that a side shares with other faces, or the free edges in a plane (open_plane_name). The translation of a pair is
/// found from its borders. Where corners were absorbed into one, the image's is the image of the one that is left.
/// \throws Error(bad_argument) for names that no face has (with those there are), for a side in several pairs, and for borders that are not each other's image:
/// with places and distances
PeriodicRims find_periodic_rims(const Model& model, const Column<EdgeId, EdgeSamples>& edges, std::span<const SidePair> pairs, ModelTopology& topology);

/// Parameter within `range` at which the edge is nearest to p.
double nearest_parameter(const ModelEdge& edge, const EdgeSamples& samples, const Interval& range, const Point& p);

/// The place of a piece that is the image of the place at t of the piece that it is like.
double image_parameter(const PeriodicRims& rims, std::size_t piece, double t, const Model& model, const Column<EdgeId, EdgeSamples>& edges);

class SurfaceSizes;

/// What a border asks for where an image of it asks for less: sources for the next SurfaceSizes, which then asks for the same on all.
std::vector<SizeSite> sizes_of_partners(const PeriodicRims& rims, const Model& model, const Column<EdgeId, EdgeSamples>& edges, const SurfaceSizes& field);

}  // namespace sterna::surfmesh
