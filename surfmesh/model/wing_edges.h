// Criteria for leading and trailing edges, for CAD models and triangulations. Rules: docs/method/surface.md, "Wing edges and bands".
#pragma once

#include <cstddef>

#include "geom/math/constants.h"

namespace sterna::surfmesh {

enum class BandKind { leading, trailing };

/// An edge is classified by its normals at k_looks locations. One location may disagree (a nick at a junction).
inline constexpr std::size_t k_looks = 9, k_agreeing = 8;
/// Edges with a larger turn are "sharp" as defined in docs/method/envelope.md, "Vertex classes".
inline constexpr double k_sharp_turn = 120.0 * k_degree;
/// Range of the angle between a base and the sides of the wing.
inline constexpr double k_base_turn_from = 40.0 * k_degree, k_base_turn_to = 140.0 * k_degree;
/// Smallest x component (along the flow) of the outward direction of an edge. Wings may therefore be swept by 78 degrees.
inline constexpr double k_looks_along = 0.2;
/// Largest ratio of the nose radius to the width of the adjacent surface. RAE 2822 has 0.008, a half cylinder has 0.32.
inline constexpr double k_nose_radius = 0.125;
/// A base is at least k_strip_length times as long as wide, and narrower than the fraction k_strip_width of the adjacent surface.
inline constexpr double k_strip_length = 3.0, k_strip_width = 0.1;
/// Fraction of the distance to the opposite border that rows of one edge may take.
inline constexpr double k_share_of_chord = 0.4;

}  // namespace sterna::surfmesh
