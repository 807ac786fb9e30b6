// Flag-dependent Jacobi smoothing of heights, growth directions and the envelope itself (docs/method/envelope.md, "Smoothing"; [ET15 §3.2.2]).
#pragma once

#include "volmesh/envelope/classify.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// log h <- log h + 0.5 (mean - log h), weights 1/|e|; kept between height_floor and all of the target; only downwards at concave vertices. The smoothed
/// heights become the caps, so that later stages do not grow the roughness back.
void smooth_heights(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);

/// d <- d + 0.5 (mean - d), normalised, pulled back into the visibility cone; a ridge vertex sees only its neighbours on the ridge, corners stay.
/// With `region`, only marked vertices move.
void smooth_directions(const LayerBase& base, const Classification& classes, int sweeps, Envelope& envelope, const RunContext& context,
                       const Column<VertexId, std::uint8_t>* region = nullptr);

/// Vertices at and around concave features.
Column<VertexId, std::uint8_t> concave_region(const LayerBase& base, const Classification& classes, const RunContext& context);

/// Further direction sweeps where, at the present heights, macro-elements are invalid: the layer may be several edges thick there, so the turn of the
/// directions must be spread wider than the first sweeps did.
void smooth_tangled_regions(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope,
                            const RunContext& context);

/// Adds `rings` rings of neighbours to the marked vertices.
void grow_region(const LayerBase& base, int rings, Column<VertexId, std::uint8_t>& region, const RunContext& context);

/// One Laplacian sweep of the envelope's points, less that of the wall's, at smooth vertices of the region; a proposal, not tested. Heights do not fall below
/// their present value or a few percent below the target, whichever is lower.
Envelope relaxed(const LayerBase& base, const Classification& classes, const Column<VertexId, std::uint8_t>& region, const Envelope& envelope,
                 const RunContext& context);

/// Laplacian of the envelope's points, less that of the wall's, at smooth vertices, accepted only where macro-elements stay valid; heights stay near their
/// target.
void smooth_envelope(const LayerBase& base, const Classification& classes, int sweeps, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
