// Finds the leading and trailing edges of wings, which get bands of stretched triangles, and the bases of blunt trailing edges, which are meshed as strips of a
// given number of cells. Determines how these edges are cut, and which other sizes they override. Rules: docs/method/surface.md, "Wing edges and bands".
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "surfmesh/face/band_rows.h"
#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/model_topology.h"
#include "surfmesh/model/wing_edges.h"

namespace sterna::surfmesh {

/// The edges of one band bend by less than this angle where they meet. Kinks of swept wings at the plane of symmetry do not end the band.
inline constexpr double k_largest_kink = 70.0 * std::numbers::pi / 180.0;

/// Smallest sine of the angle between a band and the edges that leave it.
inline constexpr double k_steep_sine = 0.42;

/// An edge with rows of triangles on the faces beside it.
struct BandEdge {
  BandKind kind = BandKind::leading;
  double first = 0.0;  ///< m, height of the first row
  double growth = 1.2;
  double longest = 0.0;             ///< m: upper limit of the segment length
  std::vector<double> spacing{};    ///< m, target lengths at the edge's samples
  std::vector<double> reach{};      ///< m: height of all rows above the edge's samples
  std::array<bool, 2> is_ending{};  ///< true if the band ends at the edge's start / its end; the stretch decreases towards that end
};

/// End of an edge that leaves a band, where the band continues beyond the edge. The edge is a column of the band, so near this end it is cut into the heights
/// of the band's rows.
struct CrossingEnd {
  RowLaw law;
  double longest = 0.0;       ///< m, largest length of the band's segments there
  std::array<Vec3, 2> along;  ///< unit vectors of the band's edges at the corner: rows run parallel to them
  bool is_any = false;        ///< true if a band continues here
};

/// A trailing edge base between two long sides.
struct BaseStrip {
  std::size_t n_cells = 0;
  std::array<EdgeId, 2> long_edge;  ///< the second edge is cut at the same length fractions as the first
  bool is_against = false;          ///< true if the parameters of the two edges run against each other
  std::vector<EdgeId> short_edges{};
  double width = 0.0;  ///< m, mean width
};

struct WingBands {
  Column<EdgeId, std::optional<BandEdge>> edges;
  Column<EdgeId, std::array<CrossingEnd, 2>> crossings;  ///< ends of edges that bands cross, at the edge's start and end
  Column<FaceId, std::optional<BaseStrip>> strips;
  Column<EdgeId, std::size_t> n_short;           ///< number of cells across a short side of a strip; 0: the edge is no short side
  Column<EdgeId, std::uint8_t> is_short_ending;  ///< true if no strip continues beyond this short side
  std::vector<std::string> notes;                ///< requirements that could not be met, with the faces' names

  bool is_empty() const { return is_unused; }
  bool is_strip_in_band(FaceId f) const { return strips[f] && edges[strips[f]->long_edge[0]]; }
  /// Returns true if the size that face f requires at p (a location on or beside the face) is ignored because the rows of a band determine the size there.
  bool covers(const Column<EdgeId, EdgeSamples>& samples, FaceId f, const Point& p) const;

  /// Replaces the sizes at the samples of an edge by those of the bands.
  void overrule(const Column<EdgeId, EdgeSamples>& samples, const std::vector<EdgeUseLocation>& uses, EdgeId e, double largest,
                std::vector<double>& sizes) const;

  bool is_unused = true;
  Column<FaceId, std::vector<EdgeId>> bands_of_face;
};

/// \pre sizes.faces are resolved, small parts have been absorbed into the topology
WingBands find_wing_bands(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelSizes& sizes, const ModelTopology& topology);

}  // namespace sterna::surfmesh
