// Components that scripts describe, put together: the aircraft as data, and as a model.
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
  std::vector<ModelHandle> models;  ///< solids beside them, from files or other verbs
};

/// The components as data: deflections, controls and engines included.
/// \throws Error(bad_argument) for two components of one name
Aircraft aircraft_of(const AircraftParts& parts);

/// All components side by side, mirror images included, with their kinds and the patch names of engines; deflected where the script says so.
/// \throws Error of make_components
ModelValue make_aircraft(const AircraftParts& parts, const RunContext& context);

/// The union of all solids of these models, with a report of its tries and doubts in `report`; contacts that look hard are warnings of the log.
/// \throws Error of cad::unite
ModelValue unite_solids(const std::vector<ModelHandle>& models, const UniteOptions& options, const RunContext& context);

/// All models side by side; names of components that would be there twice get a number behind, which is told in the log.
ModelValue assemble(const std::vector<ModelHandle>& models, const RunContext& context);

}  // namespace sterna::scripting
