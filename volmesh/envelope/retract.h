// Collision avoidance between opposing layers (docs/method/envelope.md, "Opposing layers"; [ET15 §3.2.5]).
#pragma once

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {

/// Where the gap between two walls is too narrow for both layers.
struct WallGap {
  VertexId vertex;
  TriangleId opposite;  ///< invalid: the outer boundary, which asks for nothing
  double gap = 0.0;     ///< m, along the vertex's growth line
  double share = 0.0;   ///< of the heights asked for on both sides that there is room for
};

/// Shares the gap between opposing walls: where a growth line meets a wall that faces it, both heights are lowered, in proportion to what each asks for,
/// until a gap of k_kept_edges (layer_room.h) of the longer of the two local envelope edges remains (half the gap, where it is narrower). Limits `cap` too.
/// With `group`, only walls of different groups oppose each other, and vertices of group 0 know the outer boundary already: the rest was shared before.
/// \post every macro-element valid. Returns what it found, by vertex.
std::vector<WallGap> share_gaps(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context,
                                const Column<VertexId, std::uint32_t>* group = nullptr);

/// Lowers heights until the exact triangle tests find top and sides of the layer clear of each other, of the wall and of the outer boundary, with
/// macro-elements made valid again after each sweep; what still collides after max_retract_sweeps collapses, so it ends. With `suspects`, the top is known to
/// be clear elsewhere. Returns whether it changed anything.
/// \pre wall and outer boundary do not cross.
bool retract_collisions(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context,
                        const std::vector<VertexId>* suspects = nullptr);

/// Raises heights that were lowered more than needed towards min(target, cap) where macro-elements stay valid and the top stays clear. With `where`, only at
/// these vertices.
/// \pre, \post clear, as after retract_collisions.
void regrow_clear(const LayerBase& base, Collider& collider, Envelope& envelope, const RunContext& context, const std::vector<VertexId>* where = nullptr);

/// How much taller than wanted a changed height must still be clear, as a factor: room for the tetrahedra.
inline constexpr double k_clearance = 1.06;

/// Puts a change in force where macro-elements stay valid and the top stays clear of itself, the wall and the outer boundary, at `clearance` times the changed
/// heights and at the heights themselves: all at once, then vertices of crossing or invalid elements go back until there are none. Cost: two exact passes over
/// what moved (one with clearance 1), then around what went back.
/// \pre, \post valid and clear. Returns the vertices where it is in force.
std::vector<VertexId> apply_where_clear(const LayerBase& base, Collider& collider, EnvelopeShape& envelope, ShapeChange change, const RunContext& context,
                                        double clearance = k_clearance);
/// The same for a whole shape.
/// \pre vertices with proposal == envelope are not touched.
std::vector<VertexId> apply_where_clear(const LayerBase& base, Collider& collider, EnvelopeShape& envelope, const EnvelopeShape& proposal,
                                        const RunContext& context, double clearance = k_clearance);

}  // namespace sterna::volmesh
