// Prevents collisions between opposing layers (docs/method/envelope.md, "Opposing layers"; [ET15 §3.2.5]).
#pragma once

#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {

/// A gap between two walls that is too narrow for both layers.
struct WallGap {
  VertexId vertex;
  TriangleId opposite;  ///< triangle of the opposite wall; invalid: the outer boundary, which carries no layer
  double gap = 0.0;     ///< m, width along the vertex's growth line
  double share = 0.0;   ///< fraction of the heights on both sides for which there is room
};

/// Shares the gaps between opposing walls. Where a growth line meets an opposing wall, both heights are lowered by the same factor until a gap remains. It is
/// k_kept_edges (layer_room.h) times the longer of the two local envelope edges, or half the gap if that is less. `cap` is also lowered. With `group`, only
/// walls of different groups count as opposing, and vertices of group 0 have been tested against the outer boundary, because all other gaps were shared before.
/// \post every macro-element is valid. Returns the gaps found, sorted by vertex
std::vector<WallGap> share_gaps(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context,
                                const Column<VertexId, std::uint32_t>* group = nullptr);

/// Lowers heights until the exact triangle tests find that top and sides of the layer do not cross each other, the wall or the outer boundary. Macro-elements
/// are made valid again after each sweep. Vertices that still collide after max_retract_sweeps collapse, so the function terminates. With `suspects`, the top
/// is known to be clear at all other vertices. Returns true if a height changed.
/// \pre wall and outer boundary do not cross
bool retract_collisions(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context,
                        const std::vector<VertexId>* suspects = nullptr);

/// Raises heights that were lowered more than needed towards min(target, cap), if macro-elements stay valid and the top stays clear. With `where`, only the
/// heights of these vertices.
/// \pre, \post the envelope is clear, as after retract_collisions
void regrow_clear(const LayerBase& base, Collider& collider, Envelope& envelope, const RunContext& context, const std::vector<VertexId>* where = nullptr);

/// A changed height must be clear also when multiplied by this factor, to leave room for the tetrahedra.
inline constexpr double k_clearance = 1.06;

/// Applies a change at vertices where macro-elements stay valid and the top stays clear of itself, the wall and the outer boundary, both at the changed heights
/// and at `clearance` times these heights. All vertices change at once; then vertices of crossing or invalid elements are taken back until none are left. Cost:
/// two exact passes over the triangles that moved (one if clearance is 1), then passes around the vertices taken back.
/// \pre, \post the envelope is valid and clear. Returns the vertices at which the change was kept
std::vector<VertexId> apply_where_clear(const LayerBase& base, Collider& collider, EnvelopeShape& envelope, ShapeChange change, const RunContext& context,
                                        double clearance = k_clearance);
/// Applies a whole shape in the same way.
/// \pre vertices with proposal == envelope are not changed
std::vector<VertexId> apply_where_clear(const LayerBase& base, Collider& collider, EnvelopeShape& envelope, const EnvelopeShape& proposal,
                                        const RunContext& context, double clearance = k_clearance);

}  // namespace sterna::volmesh
