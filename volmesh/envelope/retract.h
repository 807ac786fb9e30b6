// Collision avoidance between opposing layers (docs/method/envelope.md, "Opposing layers"; [ET15 §3.2.5]).
#pragma once

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {

/// A gap between two walls that is too narrow for both layers.
struct WallGap {
  VertexId vertex;
  TriangleId opposite;  ///< invalid: the outer boundary, which carries no layer
  double gap = 0.0;     ///< m, along the vertex's growth line
  double share = 0.0;   ///< share of the heights on both sides for which there is room
};

/// Shares the gap between opposing walls: where a growth line meets an opposing wall, both heights are lowered by the same factor until a gap
/// of k_kept_edges (layer_room.h) of the longer of the two local envelope edges remains (half the gap, where it is narrower). Limits `cap` too. With `group`,
/// only walls of different groups oppose each other, and vertices of group 0 have been tested against the outer boundary: all other gaps were shared before.
/// \post every macro-element valid. Returns the gaps found, by vertex.
std::vector<WallGap> share_gaps(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context,
                                const Column<VertexId, std::uint32_t>* group = nullptr);

/// Lowers heights until the exact triangle tests find top and sides of the layer clear of each other, of the wall and of the outer boundary. Macro-elements
/// are made valid again after each sweep. Vertices that still collide after max_retract_sweeps collapse, so the function terminates. With `suspects`, the top
/// is known to be clear elsewhere. Returns true if a height changed.
/// \pre wall and outer boundary do not cross.
bool retract_collisions(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context,
                        const std::vector<VertexId>* suspects = nullptr);

/// Raises heights that were lowered more than needed towards min(target, cap) where macro-elements stay valid and the top stays clear. With `where`, only at
/// these vertices.
/// \pre, \post clear, as after retract_collisions.
void regrow_clear(const LayerBase& base, Collider& collider, Envelope& envelope, const RunContext& context, const std::vector<VertexId>* where = nullptr);

/// Factor on a changed height up to which the layer must still be clear: room for the tetrahedra.
inline constexpr double k_clearance = 1.06;

/// Applies a change where macro-elements stay valid and the top stays clear of itself, the wall and the outer boundary, at `clearance` times the changed
/// heights and at the heights themselves. All vertices change at once; then vertices of crossing or invalid elements are taken back until none are left.
/// Cost: two exact passes over the triangles that moved (one with clearance 1), then over the surroundings of vertices taken back.
/// \pre, \post valid and clear. Returns the vertices where the change is in force.
std::vector<VertexId> apply_where_clear(const LayerBase& base, Collider& collider, EnvelopeShape& envelope, ShapeChange change, const RunContext& context,
                                        double clearance = k_clearance);
/// Applies a whole shape in the same way.
/// \pre vertices with proposal == envelope are not touched.
std::vector<VertexId> apply_where_clear(const LayerBase& base, Collider& collider, EnvelopeShape& envelope, const EnvelopeShape& proposal,
                                        const RunContext& context, double clearance = k_clearance);

}  // namespace sterna::volmesh
