// Jacobi smoothing of heights, growth directions and the envelope itself, depending on the vertex flags (docs/method/envelope.md, "Smoothing"; [ET15 §3.2.2]).
#pragma once

#include "volmesh/envelope/classify.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Smooths heights by log h <- log h + 0.5 (mean - log h), with the weights 1/|e|. Heights stay between height_floor and the full target. At concave vertices
/// they only fall. The smoothed heights become the caps, so that later stages do not restore the roughness.
void smooth_heights(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);

/// Smooths directions by d <- d + 0.5 (mean - d). They are normalised and pulled back into the visibility cone. A ridge vertex uses only its neighbours on the
/// ridge, and corners do not move. With `region`, only marked vertices move.
void smooth_directions(const LayerBase& base, const Classification& classes, int sweeps, Envelope& envelope, const RunContext& context,
                       const Column<VertexId, std::uint8_t>* region = nullptr);

/// Returns the vertices at and around concave features.
Column<VertexId, std::uint8_t> concave_region(const LayerBase& base, const Classification& classes, const RunContext& context);

/// Makes further direction sweeps where macro-elements are invalid at the present heights. The layer may be several edges thick there, so the turn of the
/// directions must be spread over more edges than in the first sweeps.
void smooth_tangled_regions(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope,
                            const RunContext& context);

/// Adds `rings` rings of neighbours to the marked vertices.
void grow_region(const LayerBase& base, int rings, Column<VertexId, std::uint8_t>& region, const RunContext& context);

/// Makes one Laplacian sweep of the envelope's points at smooth vertices of the region. The Laplacian of the wall's points is subtracted. Returns a proposal
/// that is not tested. Heights do not fall below their present value, or below a few percent under the target, whichever is lower.
Envelope relaxed(const LayerBase& base, const Classification& classes, const Column<VertexId, std::uint8_t>& region, const Envelope& envelope,
                 const RunContext& context);

/// Smooths the envelope's points at smooth vertices by their Laplacian minus that of the wall's points. Changes are accepted only where macro-elements stay
/// valid. Heights stay near their target.
void smooth_envelope(const LayerBase& base, const Classification& classes, int sweeps, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
