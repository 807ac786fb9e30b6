// Verbs of series: series, jobs, slurm, range, zip.
#pragma once

#include <span>

#include "scripting/lua/script_call.h"

namespace sterna::scripting {

std::span<const ScriptVerb> series_verbs();

}  // namespace sterna::scripting
