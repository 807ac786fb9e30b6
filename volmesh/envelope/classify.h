// Vertex classification from local geometry only (docs/method/envelope.md, "Vertex classes"; [ET15 §3.2.1]).
#pragma once

#include <cstdint>

#include "geom/base/ids.h"
#include "geom/base/run_context.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Flags that can be combined. A vertex without flags is smooth; one with ridge, convex and concave is a saddle.
struct VertexClass {
  bool is_ridge = false;    ///< exactly two feature edges that bend by less than 60 degrees
  bool is_corner = false;   ///< any other number of feature edges, except zero
  bool is_convex = false;   ///< an edge bends by more than the feature angle and is convex
  bool is_concave = false;  ///< an edge bends by more than the feature angle and is concave
  bool is_sharp = false;    ///< a feature edge bends by more than 120 degrees
  bool is_blunt = false;    ///< a feature edge bends by at most 120 degrees
  bool is_smooth() const { return !is_ridge && !is_corner; }
};

struct Classification {
  Column<VertexId, VertexClass> vertex;
  double feature_angle = 0.0;                   ///< rad, the angle used for the classification
  Column<HalfedgeId, std::uint8_t> is_feature;  ///< 1 on both half-edges of a feature edge
};

/// Returns the signed dihedral deviation of an edge in radians: the angle between the normals of its two triangles, positive at convex edges. A boundary edge
/// on a constraint surface counts as if the body were mirrored there, as do the edges at its end vertices. Other boundary edges have the deviation 0.
double dihedral_deviation(const LayerBase& base, HalfedgeId h);

Classification classify_vertices(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
