// Local repairs of the envelope: untangling along edges, reduction of warp by bisection, and increase of heights that were lowered more than needed.
#pragma once

#include "volmesh/envelope/envelope.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {

/// Limits both heights at an edge whose growth lines converge. The limit follows from the law of sines, eq. (2) corrected (docs/method/envelope.md,
/// "Untangling"); it is untangle_share of the height at which the growth lines would meet. Then limits the slope of heights beside limited vertices to that of
/// level_steps(), over three rings.
void untangle_edges(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);

/// Lowers heights so that they rise by at most one edge length per edge beside lower neighbours that are not collapsed, over `sweeps` rings.
void level_steps(const LayerBase& base, const EnvelopeOptions& options, int sweeps, HeightLimit reason, Envelope& envelope, const RunContext& context);

/// Returns the limits of eq. (2) for one edge: the heights at both ends at which the growth lines meet; infinity if they do not converge.
/// \pre directions are unit vectors
std::array<double, 2> edge_height_limits(const Point& p1, const Vec3& d1, const Point& p2, const Vec3& d2);

/// Lowers heights to the largest values for which every macro-element is valid with margin (docs/method/envelope.md, "Warp"). Collapses vertices below h_min,
/// and surrounds collapsed vertices by compressed ones. Always terminates, because elements that are still invalid after a number of rounds collapse. With
/// `suspects`, only elements at these vertices are tested first, because all others are known to be valid.
/// \post invalid_macros() is empty. Returns the vertices whose heights were lowered, ascending
std::vector<VertexId> unwarp(const LayerBase& base, const EnvelopeOptions& options, HeightLimit reason, Envelope& envelope, const RunContext& context,
                             const std::vector<VertexId>* suspects = nullptr);

/// Returns heights raised by one step towards min(target, cap), without steep steps between neighbours. The result is a proposal that is not tested. Steps are
/// smaller where earlier steps failed, and vertices with several failures get no step.
ShapeChange raised(const LayerBase& base, const Envelope& envelope, const Column<VertexId, std::uint8_t>& n_failures, const RunContext& context);
/// Counts the vertices of `tried` that are not in `done`.
/// \pre both lists are ascending
void count_failures(const std::vector<VertexId>& tried, const std::vector<VertexId>& done, Column<VertexId, std::uint8_t>& n_failures);

/// Raises heights towards min(target, cap) where macro-elements stay valid. This corrects excessive reductions of earlier steps.
void regrow(const LayerBase& base, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
