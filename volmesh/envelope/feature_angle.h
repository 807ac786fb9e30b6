// Angle above which an edge is a feature. It is derived from the surface itself (docs/method/envelope.md, "Feature angle").
#pragma once

#include "geom/base/run_context.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Returns options.feature_angle in radians. If it is automatic, returns the middle of the widest gap between 20 and 60 degrees in the histogram of the edges'
/// dihedral deviations. Deviations of smooth surfaces are below the gap, features above it. If there is no gap, the emptiest part of the histogram is used.
double feature_angle_of(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context);

/// Returns the feature angle of a wall whose largest dihedral deviation at smooth locations may be known (automatic: unknown). If it is known, the result is
/// the smallest angle of at least 20 degrees above this deviation, provided that it is not above 60 degrees. Otherwise the result is that of
/// feature_angle_of(). The log states which criterion was used.
double decide_feature_angle(const LayerBase& base, const EnvelopeOptions& options, double smooth_angle, const RunContext& context);

}  // namespace sterna::volmesh
