// The files with which a case of OpenFOAM is run: Allrun with its stages, Allclean, and the script that tests forces and velocities.
#pragma once

#include <vector>

#include "scripting/verbs/foam_setup.h"

namespace sterna::scripting {

/// Returns system/stage, stage.start and stage.final (schemes that differ between the start and the rest of a steady run), system/runControl (the end of each
/// part of the run), system/judge.awk, Allrun and Allclean.
std::vector<CaseFile> foam_run_files(const FoamSetup& setup);

/// Returns entries of controlDict's functions by which a steady run ends when its velocity is out of bounds; empty for transient runs.
std::string foam_watch_functions(const FoamSetup& setup);

/// Returns the bound of the velocity in steady flow of gases, m/s (limitVelocity in fvOptions). It is needed because the start from uniform flow gives extreme
/// velocities in single cells.
double foam_speed_bound(const FoamSetup& setup);

}  // namespace sterna::scripting
