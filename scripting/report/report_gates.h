// Gates, worst locations, histograms and coverage of a report page, from the report of `check`.
#pragma once

#include "geom/mesh/check.h"
#include "scripting/values/option_json.h"

namespace sterna::scripting {

/// Returns a JSON object with verdict, quality_verdict, gates (gates of the verdict first), places (findings first, then those of each gate, worst gates
/// first), histograms and coverage.
Json page_check_json(const CheckReport& report);
/// Returns the object for meshes without gates.
Json page_no_check_json();

}  // namespace sterna::scripting
