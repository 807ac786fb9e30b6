// Actual distances of the first nodes from the wall.
#pragma once

#include "geom/base/error.h"
#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/envelope/classify.h"
#include "volmesh/layer/extrude.h"

namespace sterna::volmesh {

/// First nodes against h0, within 2 %. Growth lines that are collapsed, or compressed by normal_height, are excluded from both shares and counted.
struct FirstNodeReport {
  std::int64_t n_lines = 0, n_compressed = 0, n_collapsed = 0;
  double vertex_share = 1.0;  ///< share of the full growth lines: distance along the vertex's wall normal within 2 % of h0
  double facet_share = 1.0;   ///< share of the area of triangles without ridge, corner, compressed or collapsed vertex: all three within 2 % of h0 along the
                              ///< triangle's normal
  double facet_mean_share = 1.0;  ///< as facet_share, for the mean of the three
  double ridge_area = 0.0;        ///< share of the wall's area in triangles with a ridge or corner vertex
  double worst_vertex = 0.0;      ///< largest deviation over h0
  double worst_facet = 0.0;
  Point worst_vertex_place, worst_facet_place;
};

FirstNodeReport first_node_report(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, const Envelope& envelope,
                                  const Extrusion& extrusion, const RunContext& context);

}  // namespace sterna::volmesh
