// Gates G17 and G18 for users: mesh:check{ wall = wall }, wall:check(), sterna check --model.
#pragma once

#include <string>

#include "geom/mesh/check.h"
#include "scripting/lua/script_call.h"
#include "scripting/values/verbs.h"
#include "surfmesh/model/deviation.h"

namespace sterna::scripting {

/// \throws Error(bad_argument) where the surface does not know its model, with what to do instead
void require_model_wall(const SurfaceValue& wall, const std::string& attempted);

/// Measures the mesh's walls against the model of `wall` and puts both gates into the report; what was left out goes to the log.
/// \pre wall.model_wall; report.quality_measured
void measure_on_model(const HybridMesh& mesh, const SurfaceValue& wall, const GateTable& limits, CheckReport& report, const RunContext& context);

/// surface:check, a method.
extern const ScriptVerb k_check_surface;

}  // namespace sterna::scripting
