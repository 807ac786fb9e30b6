// Initial envelope: growth directions and target heights (docs/method/envelope.md, "Growth directions" and "Heights"; [ET15 §3.2.2]).
#pragma once

#include "volmesh/envelope/classify.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

inline constexpr double k_rim_slope = 1.0;  ///< of heights beside rims of sheets, 45 degrees: tetrahedra have three quarters of the way around a rim

/// Directions: the angle-weighted normal, pulled towards the best visible direction where it sees its faces badly. Heights: the target, which is the
/// largest field with h <= eq. (1), h <= max_thickness (default 0.1 body lengths) and slope <= height_gradient along wall edges.
/// Vertices without a direction that sees all their faces start collapsed (HeightLimit::invisible).
Envelope initial_envelope(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context);

/// The direction nearest to `wanted` on the way to the visible one whose worst cosine with the normals of the facets at v is at least `needed`.
/// \pre the visible direction itself satisfies `needed`.
Vec3 pull_towards_visible(const LayerBase& base, VertexId v, const Vec3& wanted, double needed);

/// The direction within v's constraint nearest to `wanted` (on the way to the best visible one) that sees every face of v with at least the cosine
/// min(`cosine`, 0.5 * the best possible).
Vec3 pull_into_cone(const LayerBase& base, VertexId v, const Vec3& wanted, double cosine);

}  // namespace sterna::volmesh
