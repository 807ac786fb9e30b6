// The angle beyond which an edge is a feature, from the surface itself (docs/method/envelope.md, "Feature angle").
#pragma once

#include "geom/base/run_context.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// options.feature_angle, or where that is automatic: the middle of the widest gap, between 20 and 60 degrees, in the histogram of the edges' dihedral
/// deviations. Smooth surfaces end below the gap, features begin above it; without a gap its emptiest part counts. Radians.
double feature_angle_of(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context);

/// The same for a wall of which the largest dihedral turn at smooth places may be known (automatic: it is not): then the least angle of at least 20 degrees
/// that is above that, if there is one up to 60 degrees. The log says what decided.
double decide_feature_angle(const LayerBase& base, const EnvelopeOptions& options, double smooth_angle, const RunContext& context);

}  // namespace sterna::volmesh
