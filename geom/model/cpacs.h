// Reads CPACS files (versions 2 and 3): the outer shape of an aircraft. Source: the CPACS schema (DLR). Angles are in degrees. Transformations scale first,
// then rotate about the body-fixed axes x, y', z'', then translate, as documented in the schema.
#pragma once

#include <filesystem>

#include "geom/base/run_context.h"
#include "geom/model/aircraft.h"

namespace sterna {

/// Reads the first aircraft model of a file. Contents that are read: wings, pylons, fuselages (sections with positionings and all transformations, profiles as
/// points, cst2D or standard), nacelles with their cowls, trailing and leading edge devices, symmetry, reference values. Other contents of the model (such as
/// guide curves, structure, linked files) are listed in the messages, one for each element; the messages also go to the log as warnings. Landing gears are
/// assumed retracted, which is also noted in the log.
/// \throws Error(file_not_found, file_malformed) with line and XML path
AircraftReading read_cpacs(const std::filesystem::path& path, const RunContext& context);

}  // namespace sterna
