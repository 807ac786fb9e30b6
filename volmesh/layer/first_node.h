// Actual distances of the first nodes from the wall.
#pragma once

#include "geom/base/error.h"
#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/envelope/classify.h"
#include "volmesh/layer/extrude.h"

namespace sterna::volmesh {

/// Compares the first nodes with h0, with a tolerance of 2 %. Growth lines that are collapsed, or compressed by normal_height, are excluded from both fractions
/// and counted separately.
struct FirstNodeReport {
  std::int64_t n_lines = 0, n_compressed = 0, n_collapsed = 0;
  double vertex_share = 1.0;  ///< fraction of the full growth lines on which the distance along the vertex's wall normal is within 2 % of h0
  double facet_share = 1.0;  ///< fraction of the area of triangles without ridge, corner, compressed or collapsed vertex on which all three distances along the
                             ///< triangle's normal are within 2 % of h0
  double facet_mean_share = 1.0;  ///< the same fraction for the mean of the three distances
  double ridge_area = 0.0;        ///< fraction of the wall's area in triangles with a ridge or corner vertex
  double worst_vertex = 0.0;      ///< largest deviation, relative to h0
  double worst_facet = 0.0;
  Point worst_vertex_location, worst_facet_location;
};

FirstNodeReport first_node_report(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, const Envelope& envelope,
                                  const Extrusion& extrusion, const RunContext& context);

}  // namespace sterna::volmesh
