// CPACS files (versions 2 and 3): the outer shape of an aircraft. Source: the CPACS schema (DLR); transformations scale first, then rotate about the
// own axes x, y', z'' and move, as its documentation says; degrees.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/model/aircraft.h"

namespace sterna {

/// Reads the first aircraft model: wings, pylons, fuselages (sections with positionings and all transformations, profiles as points, cst2D or
/// standard), nacelles with their cowls, trailing and leading edge devices, symmetry, reference values. What else the model holds (guide curves,
/// structure, linked files ...) is named in the messages, one for each element, which also go to the log as warnings; landing gears are taken as retracted
/// (a note, and a line of the log).
/// \throws Error(file_not_found, file_malformed) with line and XML path
AircraftReading read_cpacs(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna
