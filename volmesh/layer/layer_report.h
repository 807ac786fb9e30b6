// Report of the layer, compared with h_target (docs/method/envelope.md, "Heights").
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "volmesh/envelope/envelope.h"
#include "volmesh/layer/extrude.h"
#include "volmesh/layer/first_node.h"
#include "volmesh/layer/visibility_report.h"

namespace sterna::volmesh {

/// Fractions of a patch's area, determined at the corners of its triangles. On the remaining area the layer does not have its full height, but has its first
/// height.
struct PatchLayerReport {
  std::string name;
  double area = 0.0;        ///< m^2
  double full = 0.0;        ///< height along the wall's normal of at least 0.9 h_target
  double compressed = 0.0;  ///< height less than the first cell needs, so h0 is not met
  double collapsed = 0.0;   ///< no layer
  double attainable = 0.0;  ///< the geometry permits the full height (geom/mesh/layer_room.h)
  double attained = 0.0;    ///< at least 0.9 of the height that the geometry permits
  double truncated = 0.0;   ///< fewer layers than requested (truncate.h)
  int least_layers = 0;     ///< smallest number of layers on growth lines that are not collapsed; 0: all growth lines are collapsed
  std::vector<std::pair<std::string, double>> lost_area;  ///< fraction below 0.9 h_target for each reason, largest first
};

/// Ratio of the height of the last prism to that of a regular tetrahedron on its top, which is 0.816 times the mean edge there. The values are fractions of the
/// envelope's area.
struct InterfaceReport {
  double within = 0.0;          ///< ratio in [1/3, 3]
  double below = 0.0;           ///< ratio below 1/3
  double above = 0.0;           ///< ratio above 3
  double within_of_full = 0.0;  ///< `within` for the triangles with full height at all corners, because the layer is compressed elsewhere
};

/// Report of the layer; see docs/method/envelope.md, "Heights", for h_target.
struct LayerReport {
  double body_length = 0.0;        ///< m
  double coverage = 0.0;           ///< fraction of the wall area with a height along the wall's normal of at least 0.9 h_target
  double attainable = 0.0;         ///< fraction of the wall area on which the geometry permits this height (geom/mesh/layer_room.h)
  double attained = 0.0;           ///< fraction of the wall area with at least 0.9 of the height that the geometry permits
  double target_over_eq1 = 0.0;    ///< mean over the area of the ratio of h_target to eq. (1)
  double mean_height_share = 0.0;  ///< mean over the area of the height along the normal, relative to that of h_target
  double mean_height = 0.0;        ///< m, mean over the area of the height along the normal
  double feature_angle = 0.0;      ///< rad, given by the user or detected
  VisibilityReport visibility;
  std::int64_t n_vertices = 0;
  std::int64_t n_compressed = 0;                          ///< number of vertices whose height is too low for their first cells, so h0 is not met
  std::vector<std::pair<std::string, double>> lost_area;  ///< fraction of the wall area below 0.9 h_target for each reason, largest first
  double compressed_area = 0.0;                           ///< fraction of the wall area
  double collapsed_area = 0.0;                            ///< fraction of the wall area
  double truncated_area = 0.0;                            ///< fraction of the wall area with fewer layers than requested
  std::vector<PatchLayerReport> patches;                  ///< patches in the order of the wall
  std::vector<ErrorLocation> collapsed;                   ///< each collapsed vertex: location, patch and reason
  /// The lowest vertices below n h0 that are not collapsed (at most k_listed_compressed): location, patch, height and reason.
  std::vector<ErrorLocation> compressed;
  FirstNodeReport first_node;  ///< distances of the first nodes from the wall
  InterfaceReport interface;
  /// Numbers of growth lines with less than wall_perpendicularity, by the fraction of it: 0, up to 1/4, 1/2, 3/4, below 1.
  std::array<std::int64_t, 5> reduced_curving{};
  std::vector<std::string> warnings;  ///< probable mistakes in the settings, one sentence each; also written to the log
};

inline constexpr std::size_t k_listed_compressed = 20;

/// Reports the layer. `outer` (may be null) is the boundary without layers, which may be opposite to walls.
LayerReport report_layer(const LayerBase& base, const EnvelopeOptions& options, const Envelope& envelope, const Extrusion& extrusion, const TriMesh* outer,
                         const RunContext& context);

/// Returns the layer targets of each growth line, for the gates of `check`. \p layers layer whose first growth lines are those of the base's vertices
LayerRequest layer_request(const LayerBase& base, const EnvelopeOptions& options, const Envelope& envelope, const LayerBlock& layers);

}  // namespace sterna::volmesh
