// The steps of build_envelope() one by one, for who wants to look at or change what is between them. In their order, with the same options, they give its
// envelope to the bit.
#pragma once

#include <cstdint>
#include <string_view>

#include "volmesh/envelope/classify.h"
#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// What has been done to an envelope.
enum class EnvelopeStep : std::uint8_t { classified, initial, smoothed, untangled, unwarped, retracted, finished };
std::string_view to_string(EnvelopeStep step);
/// \throws Error(bad_argument) for another text
EnvelopeStep envelope_step_of(std::string_view text);

/// After classify_vertices() and initial_envelope(): heights and directions, more where macro-elements are tangled; inside of the constraints' surfaces.
void smooth_step(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);
/// Heights where growth lines meet.
void untangle_step(const LayerBase& base, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);
/// \post every macro-element valid, heights as tall as that allows, the envelope itself smoothed.
void unwarp_step(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context);
/// \pre macro-elements valid.
/// \post the same, and free of self-intersection: good for tetrahedra.
void retract_step(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context);
/// \pre, \post valid and clear.
void optimise_step(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context);

}  // namespace sterna::volmesh
