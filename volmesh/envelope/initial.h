// Initial envelope: growth directions and target heights (docs/method/envelope.md, "Growth directions" and "Heights"; [ET15 §3.2.2]).
#pragma once

#include "volmesh/envelope/classify.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

inline constexpr double k_border_slope = 1.0;  ///< largest slope of heights beside free edges of wake sheets (45 degrees); it may be large, because tetrahedra
                                               ///< occupy three quarters of the turn around such an edge

/// Returns the initial envelope. The direction is the angle-weighted normal. Where the visibility of the faces is low, it is pulled towards the best visible
/// direction. The height is the target: the largest field with h <= eq. (1), h <= max_thickness (default 0.1 body lengths) and slope <= height_gradient along
/// wall edges. Vertices without a direction from which all their faces are visible start collapsed (HeightLimit::invisible).
Envelope initial_envelope(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context);

/// Returns a direction on the way from `preferred` to the visible direction: the one nearest to `preferred` whose smallest cosine with the normals of the
/// facets at v is at least `needed`. \pre the visible direction itself satisfies `needed`
Vec3 pull_towards_visible(const LayerBase& base, VertexId v, const Vec3& preferred, double needed);

/// Returns a direction within v's constraint on the way from `preferred` to the best visible direction. It is the one nearest to `preferred` whose cosine with
/// every face normal at v is at least min(`cosine`, 0.5 * the best possible cosine).
Vec3 pull_into_cone(const LayerBase& base, VertexId v, const Vec3& preferred, double cosine);

}  // namespace sterna::volmesh
