// Runs one case in the process of a worker.
#pragma once

#include <filesystem>

#include "scripting/series/series_plan.h"

namespace sterna::scripting {

/// First thing in a worker: it ends with its parent, and what it starts does not hold the series' lock.
void become_worker();

/// Descriptor under which a worker of the pool inherits the lock of the series' folder: it is held until the last of them is gone.
inline constexpr int k_series_lock_descriptor = 3;

/// The parameters, name and index: what the function of a series gets.
ScriptValue argument_of(const SeriesCase& c);

/// Runs the function of the plan with the parameters of the case and leaves everything in its folder: case.json, script/, outputs, quality.json, measure.json,
/// status.json. What the function throws is the case's failure and ends there. Afterwards the session's series says that the case is over.
/// \throws Error(write_failed) where the folder cannot be written
void run_case(const ScriptCall& call, const SeriesPlan& plan, const SeriesCase& c);

}  // namespace sterna::scripting
