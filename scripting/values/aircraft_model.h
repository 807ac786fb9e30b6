// Components that scripts describe, combined to the aircraft as data, and to the aircraft as a model.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/cad/unite.h"
#include "scripting/lua/component_value.h"
#include "scripting/values/models.h"

namespace sterna::scripting {

struct AircraftParts {
  std::string name = "aircraft";
  std::vector<ComponentHandle> components;
  std::vector<ModelHandle> models;  ///< additional solids, from files or other verbs
};

/// Returns the components as data: deflections, controls and engines included.
/// \throws Error(bad_argument) if two components have the same name
Aircraft aircraft_of(const AircraftParts& parts);

/// Returns all components side by side, including mirror images, with their kinds and the patch names of engines. Control surfaces are deflected as set in the
/// script.
/// \throws Error of make_components
ModelValue make_aircraft(const AircraftParts& parts, const RunContext& context);

/// Returns the union of all solids of these models. `report` lists the attempts and doubtful results; contacts that look difficult are warnings in the log.
/// \throws Error of cad::unite
ModelValue unite_solids(const std::vector<ModelHandle>& models, const UniteOptions& options, const RunContext& context);

/// Returns all models side by side. Duplicate component names get a number appended, which is reported in the log.
ModelValue assemble(const std::vector<ModelHandle>& models, const RunContext& context);

}  // namespace sterna::scripting
