// Report of the layer, measured against h_target (docs/method/envelope.md, "Heights").
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

/// Shares of a patch's area, by its triangles' corners. The remaining area has less than its full height, but its first height.
struct PatchLayerReport {
  std::string name;
  double area = 0.0;                                      ///< m^2
  double full = 0.0;                                      ///< height along the wall's normal >= 0.9 h_target
  double compressed = 0.0;                                ///< below the height needed by its first cell: h0 not met
  double collapsed = 0.0;                                 ///< no layer
  double attainable = 0.0;                                ///< where the geometry permits the full height (geom/mesh/layer_room.h)
  double attained = 0.0;                                  ///< at least 0.9 of the height that the geometry permits
  double truncated = 0.0;                                 ///< fewer layers than requested (truncate.h)
  int least_layers = 0;                                   ///< least number on growth lines that are not collapsed; 0: all are collapsed
  std::vector<std::pair<std::string, double>> lost_area;  ///< share below 0.9 h_target by reason, largest first
};

/// Height of the last prism over that of a regular tetrahedron on its top, 0.816 times the mean edge there: shares of the envelope's area.
struct InterfaceReport {
  double within = 0.0;          ///< ratio in [1/3, 3]
  double below = 0.0;           ///< thinner
  double above = 0.0;           ///< thicker
  double within_of_full = 0.0;  ///< `within` of the triangles with full height at all corners: elsewhere the layer is compressed
};

/// Report of the layer; see docs/method/envelope.md, "Heights", for h_target.
struct LayerReport {
  double body_length = 0.0;        ///< m
  double coverage = 0.0;           ///< share of wall area with a height along the wall's normal >= 0.9 h_target
  double attainable = 0.0;         ///< share of wall area on which the geometry permits that (geom/mesh/layer_room.h)
  double attained = 0.0;           ///< share of wall area with at least 0.9 of the height that the geometry permits
  double target_over_eq1 = 0.0;    ///< area mean of h_target over eq. (1)
  double mean_height_share = 0.0;  ///< area mean of the height along the normal over that of h_target
  double mean_height = 0.0;        ///< m, along the normal, area-weighted
  double feature_angle = 0.0;      ///< rad, user-defined or detected
  VisibilityReport visibility;
  std::int64_t n_vertices = 0;
  std::int64_t n_compressed = 0;                          ///< too low for their first cells: h0 not met
  std::vector<std::pair<std::string, double>> lost_area;  ///< share of wall area below 0.9 h_target by reason, largest first
  double compressed_area = 0.0;                           ///< share of the wall area
  double collapsed_area = 0.0;                            ///< share of the wall area
  double truncated_area = 0.0;                            ///< share of the wall area with fewer layers than requested
  std::vector<PatchLayerReport> patches;                  ///< in the wall's order
  std::vector<ErrorPlace> collapsed;                      ///< each collapsed vertex: location, patch and reason
  std::vector<ErrorPlace> compressed;  ///< the lowest standing vertices below n h0 (k_listed_compressed at most): location, patch, height and reason
  FirstNodeReport first_node;          ///< distances of the first nodes from the wall
  InterfaceReport interface;
  std::array<std::int64_t, 5> reduced_curving{};  ///< growth lines with less than wall_perpendicularity, by share of it: 0, up to 1/4, 1/2, 3/4, below 1
  std::vector<std::string> warnings;              ///< probable mistakes in the settings, each a sentence; logged too
};

inline constexpr std::size_t k_listed_compressed = 20;

/// Reports the layer. `outer`: the boundary without layers, which may oppose walls; may be null.
LayerReport report_layer(const LayerBase& base, const EnvelopeOptions& options, const Envelope& envelope, const Extrusion& extrusion, const TriMesh* outer,
                         const RunContext& context);

/// Returns the layer targets of each growth line, for the gates of `check`. \p layers: growth lines 0 .. of the base's vertices
LayerRequest layer_request(const LayerBase& base, const EnvelopeOptions& options, const Envelope& envelope, const LayerBlock& layers);

}  // namespace sterna::volmesh
