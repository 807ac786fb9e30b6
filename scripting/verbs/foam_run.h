// How a case of OpenFOAM is run: Allrun with its stages, Allclean, and the script that judges forces and velocities.
#pragma once

#include <vector>

#include "scripting/verbs/foam_setup.h"

namespace sterna::scripting {

/// system/stage, stage.start, stage.final (schemes that differ between the start and the rest of a steady run), system/runControl (where a part of it ends),
/// system/judge.awk, Allrun, Allclean.
std::vector<CaseFile> foam_run_files(const FoamSetup& setup);

/// Entries of controlDict's functions by which a steady run ends when its velocity is out of bounds; empty for runs in time.
std::string foam_watch_functions(const FoamSetup& setup);

/// m/s, the bound of the velocity in steady flow of gases (limitVelocity in fvOptions): the start from uniform flow throws single cells far off.
double foam_speed_bound(const FoamSetup& setup);

}  // namespace sterna::scripting
