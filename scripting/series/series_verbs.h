// Verbs for series: series, jobs, slurm, range, zip.
#pragma once

#include <span>

#include "geom/base/schema.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {

struct SeriesOptions;

std::span<const ScriptVerb> series_verbs();

/// Returns the options of the stage "series", for --set. `options` must outlive the table.
OptionTable options_of_series(SeriesOptions& options);

}  // namespace sterna::scripting
