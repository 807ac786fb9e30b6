// Gates G17 and G18 as verbs and commands: mesh:check{ wall = wall }, wall:check(), sterna check --model.
#pragma once

#include <string>

#include "geom/mesh/check.h"
#include "scripting/lua/script_call.h"
#include "scripting/values/verbs.h"
#include "surfmesh/model/deviation.h"

namespace sterna::scripting {

/// \throws Error(bad_argument) with a remedy if the surface has no model
void require_model_wall(const SurfaceValue& wall, const std::string& attempted);

/// Measures the mesh's walls against the model of `wall` and adds both gates to the report. Walls that cannot be measured are reported in the log.
/// \pre wall.true_surface.wall; report.quality_measured
void measure_on_model(const HybridMesh& mesh, const SurfaceValue& wall, const GateTable& limits, CheckReport& report, const RunContext& context);

/// The method surface:check.
extern const ScriptVerb k_check_surface;

}  // namespace sterna::scripting
