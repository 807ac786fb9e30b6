// Runs one case in a worker process.
#pragma once

#include <filesystem>

#include "scripting/series/series_plan.h"

namespace sterna::scripting {

/// Initialises a worker: it ends with its parent, and processes that it starts do not hold the series lock.
void become_worker();

/// Descriptor under which a worker of the pool inherits the lock of the series folder, which is held until the last worker has ended.
inline constexpr int k_series_lock_descriptor = 3;

/// Returns the argument of a series function: the parameters, name and index.
ScriptValue argument_of(const SeriesCase& c);

/// Runs the function of the plan with the parameters of the case and writes the results to its folder: case.json, script/, outputs, quality.json, measure.json,
/// status.json. An error of the function is the failure of the case and is not propagated. Afterwards the case is marked as finished in the session's series.
/// \throws Error(write_failed) if the folder cannot be written
void run_case(const ScriptCall& call, const SeriesPlan& plan, const SeriesCase& c);

}  // namespace sterna::scripting
