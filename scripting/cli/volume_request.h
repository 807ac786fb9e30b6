// What `sterna mesh` and `sterna inspect` take for the space around a surface: both commands have the same arguments by construction.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/half.h"
#include "scripting/command/command_context.h"
#include "scripting/command/command_line.h"
#include "scripting/values/repair_surfaces.h"
#include "scripting/values/verbs.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::scripting {

/// Returns --disc, --wake-sheet, --periodic, --source, --wake, --farfield, --half and --patch. \param what the verb of the command: "mesh"
std::vector<CommandArgument> volume_arguments(const std::string& what);

/// Returns the options of `sterna inspect`: of the inspection, of reading surfaces and of volume_mesh. None is required.
HeldOptions inspect_arguments();
/// Returns the options of the line after those of --farfield.
/// \throws Error(bad_argument) of farfield_of_text
OptionOverrides options_with_farfield(const CommandLine& line);
/// Returns the options of reading files of the other kind, with the reason why they have no effect. `unused` must outlive them.
std::vector<OptionsElsewhere> options_of_other_files(bool is_model, const std::string& file, AutoSurface& unused);
/// Sets discs, wake sheets and periodic sides of the case.
/// \throws Error(bad_argument, unknown_option)
void read_features(const CommandLine& line, volmesh::MeshCase& options);
/// Returns the sources that do not depend on the wall.
std::vector<volmesh::SizeSource> sources_of(const std::vector<std::string>& texts);
/// Adds refinement regions and wakes behind the body to the case.
void add_sources(const CommandLine& line, const TriMesh& wall, volmesh::MeshCase& options);
/// With --half: returns the half of the surface, otherwise the surface. \param half options of the cut, --set half.axis=z
/// \throws Error(bad_argument) for options of half without --half
SurfaceValue halved(const CommandLine& line, const OptionOverrides& half, const SurfaceValue& wall, const CommandContext& context);
/// Returns the options of the cut. \throws as halved
HalfOptions half_options(const CommandLine& line, const OptionOverrides& half, const CommandContext& context);
/// Reads the file of the farfield shape "surface", if one is named, and adds it to the wall's inputs.
void read_farfield_of(volmesh::MeshCase& options, SurfaceValue& wall, const RunContext& context);

}  // namespace sterna::scripting
