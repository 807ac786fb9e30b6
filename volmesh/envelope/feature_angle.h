// Angle beyond which an edge is a feature, derived from the surface itself (docs/method/envelope.md, "Feature angle").
#pragma once

#include "geom/base/run_context.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Returns options.feature_angle or, if automatic, the middle of the widest gap, between 20 and 60 degrees, in the histogram of the edges' dihedral
/// deviations. Deviations of smooth surfaces end below the gap, features begin above it; without a gap the emptiest part of the histogram is used. Radians.
double feature_angle_of(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context);

/// Returns the feature angle of a wall whose largest dihedral deviation at smooth locations may be known (automatic: unknown): in that case the least angle
/// of at least 20 degrees above this deviation, if there is one up to 60 degrees; otherwise as feature_angle_of(). The log states the criterion that decided.
double decide_feature_angle(const LayerBase& base, const EnvelopeOptions& options, double smooth_angle, const RunContext& context);

}  // namespace sterna::volmesh
