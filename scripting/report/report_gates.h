// Gates, worst places, histograms and coverage of a report page, off the report of `check`.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "geom/mesh/check.h"

namespace sterna::scripting {

/// Adds verdict, quality_verdict, gates (those of the verdict first), places (findings first, then each gate's, worst gates first), histograms and coverage.
void add_check(const CheckReport& report, nlohmann::ordered_json& page);
/// The same of what has no gates.
void add_no_check(nlohmann::ordered_json& page);

}  // namespace sterna::scripting
