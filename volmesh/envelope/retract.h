// Collision avoidance between opposing layers (method.md §5, [ET15 §3.2.5]).
#pragma once

#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Shares the gap between opposing walls: where a growth line meets a wall that faces it, both heights keep together below the gap, in proportion to
/// what each asks for.
void share_gaps(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);

/// Lowers heights until the envelope is free of self-intersection by the exact triangle-triangle test, re-establishing valid macro-elements after each
/// sweep; places that still collide after max_retract_sweeps collapse. \post no crossing pair among envelope triangles.
void retract_collisions(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);

/// Raises heights that were lowered more than needed towards min(target, cap) where macro-elements stay valid and the envelope stays clear of itself.
/// \pre, \post envelope free of self-intersection.
void regrow_clear(const LayerBase& base, Envelope& envelope, const RunContext& context);

/// As apply_where_valid, and besides no vertex moves whose triangles would come nearer to another part of the envelope than a clearance of 6 % of the
/// height: all at once, then vertices of crossing or invalid elements go back until nothing crosses. Directions and heights of `proposal` count alone.
/// Cost: one crossing pass over the triangles that moved, then cheap passes around what went back.
/// \pre, \post envelope valid and free of self-intersection.
void apply_where_clear(const LayerBase& base, Envelope& envelope, const Envelope& proposal, const RunContext& context);

/// The envelope as an indexed triangle set: points = wall points, then one envelope point per vertex; corners of collapsed vertices refer to the wall.
struct EnvelopeSurface {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
EnvelopeSurface envelope_surface(const LayerBase& base, const Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
