// Leading and trailing edges of wings that get bands of stretched triangles, and bases of blunt trailing edges that become strips of a stated number of cells:
// which edges of the model they are, how they are cut, and what other sizes they overrule. Rules: docs/method/surface.md, "Wing edges and bands".
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

/// Edges of one band bend by less than this where they meet: kinks of swept wings at the plane of symmetry do not end it.
inline constexpr double k_largest_kink = 70.0 * std::numbers::pi / 180.0;

/// Sine between a band and edges that leave it, at least.
inline constexpr double k_steep_sine = 0.42;

/// An edge with rows of triangles on faces beside it.
struct BandEdge {
  BandKind kind = BandKind::leading;
  double first = 0.0;  ///< m, height of the first row
  double growth = 1.2;
  double longest = 0.0;             ///< m: segments are no longer
  std::vector<double> spacing{};    ///< m, wanted at the edge's samples
  std::vector<double> reach{};      ///< m: so far from its samples rows grow
  std::array<bool, 2> is_ending{};  ///< the band ends at the edge's start, end: stretch decays there
};

/// The end of an edge that leaves a band which goes on beyond it: cut into the heights of its rows there, because it is one of the band's columns.
struct CrossingEnd {
  RowLaw law;
  double longest = 0.0;       ///< m, of the band's segments there
  std::array<Vec3, 2> along;  ///< unit, of the band's edges at the corner: rows run like them
  bool is_any = false;        ///< a band goes on here
};

/// A base between two long sides.
struct BaseStrip {
  std::size_t n_cells = 0;
  std::array<EdgeId, 2> long_edge;  ///< the second is cut at the shares of the first
  bool is_against = false;          ///< the edges' parameters run against each other
  std::vector<EdgeId> short_edges{};
  double width = 0.0;  ///< m, mean
};

struct WingBands {
  Column<EdgeId, std::optional<BandEdge>> edges;
  Column<EdgeId, std::array<CrossingEnd, 2>> crossings;  ///< at start and end
  Column<FaceId, std::optional<BaseStrip>> strips;
  Column<EdgeId, std::size_t> n_short;           ///< cells that a short side of a strip is cut into; 0: none
  Column<EdgeId, std::uint8_t> is_short_ending;  ///< no strip goes on beyond this short side
  std::vector<std::string> notes;                ///< wishes that could not be met, with the faces' names

  bool is_empty() const { return is_unused; }
  bool is_strip_in_band(FaceId f) const { return strips[f] && edges[strips[f]->long_edge[0]]; }
  /// What face f asks for at p, a place on or beside it, does not count: a band's rows answer for it.
  bool covers(const Column<EdgeId, EdgeSamples>& samples, FaceId f, const Point& p) const;

  /// Sizes at the samples of an edge as bands have them.
  void overrule(const Column<EdgeId, EdgeSamples>& samples, const std::vector<EdgeUsePlace>& uses, EdgeId e, double largest, std::vector<double>& sizes) const;

  bool is_unused = true;
  Column<FaceId, std::vector<EdgeId>> bands_of_face;
};

/// \pre sizes.faces resolved, topology absorbed
WingBands find_wing_bands(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelSizes& sizes, const ModelTopology& topology);

}  // namespace sterna::surfmesh
