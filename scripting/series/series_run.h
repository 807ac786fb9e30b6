// Runs a series: all cases if this is the main process, one case if it is a worker.
#pragma once

#include "scripting/series/series_plan.h"

namespace sterna::scripting {

/// In the main process, reuses valid results of earlier runs, runs the remaining cases, prints the table and writes NAME/series.csv and NAME/series.json;
/// returns the table as a value. In a worker of this series, runs the worker's case and never returns. In a worker of a later series, returns the table in
/// NAME/series.json.
/// \throws Error(write_failed) if another run works in the folder; cancelled after the workers were stopped; errors of the runner. Failing cases are not an
/// error.
ScriptValue run_series(const ScriptCall& call, const SeriesPlan& plan);

}  // namespace sterna::scripting
