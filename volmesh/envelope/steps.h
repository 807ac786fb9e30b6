// The single steps of build_envelope(), for callers that inspect or modify intermediate results. Called in their order and with the same options, they produce
// bit-exactly the envelope of build_envelope().
#pragma once

#include <cstdint>
#include <string_view>

#include "volmesh/envelope/classify.h"
#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// State of an envelope, named by the last completed step.
enum class EnvelopeStep : std::uint8_t { classified, initial, smoothed, untangled, unwarped, retracted, finished };
std::string_view to_string(EnvelopeStep step);
/// \throws Error(bad_argument) for any other string
EnvelopeStep envelope_step_of(std::string_view text);

/// Smooths heights and directions, with more sweeps where macro-elements are tangled. Keeps the envelope inside the constraint surfaces. Called after
/// classify_vertices() and initial_envelope().
void smooth_step(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);
/// Limits heights where growth lines meet.
void untangle_step(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);
/// \post every macro-element is valid, heights are as tall as validity allows, and the envelope itself is smoothed
void unwarp_step(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);
/// \pre macro-elements are valid
/// \post macro-elements are valid and the envelope is free of self-intersection, so tetrahedra can be made
void retract_step(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context);
/// \pre, \post the envelope is valid and clear
void optimise_step(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
