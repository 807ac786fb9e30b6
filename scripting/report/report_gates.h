// Gates, worst places, histograms and coverage of a report page, off the report of `check`.
#pragma once

#include <string>

#include "geom/mesh/check.h"

namespace sterna::scripting {

/// JSON object with verdict, quality_verdict, gates (those of the verdict first), places (findings first, then each gate's, worst gates first), histograms and
/// coverage.
std::string page_check_json(const CheckReport& report);
/// The same of what has no gates.
std::string page_no_check_json();

}  // namespace sterna::scripting
