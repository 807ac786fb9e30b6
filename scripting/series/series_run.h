// Runs a series: in the main process all of it, in a worker one case.
#pragma once

#include "scripting/series/series_plan.h"

namespace sterna::scripting {

/// In the main process: takes what earlier runs have left and is still true, runs the rest, prints the table and writes NAME/series.csv and NAME/series.json;
/// returns the table as a value. In the worker of this series: runs its case and never returns; in that of a later one: the table that is in NAME/series.json.
/// \throws Error(write_failed) where another run is at work in the folder; cancelled after the workers were stopped; whatever the runner throws. Cases that
/// fail are no error.
ScriptValue run_series(const ScriptCall& call, const SeriesPlan& plan);

}  // namespace sterna::scripting
