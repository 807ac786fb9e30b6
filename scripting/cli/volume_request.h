// What `sterna mesh` and `sterna inspect` take of the space around a surface: both commands have the same options by construction.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/half.h"
#include "scripting/command/command_context.h"
#include "scripting/lua/script_call.h"
#include "scripting/values/verbs.h"
#include "volmesh/case/mesh_case.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

struct VolumeRequest {
  std::vector<std::string> discs;                                ///< strings for disc_of_text
  std::vector<std::string> sheets;                               ///< strings for wake_sheet_of_text
  std::vector<std::string> periodic;                             ///< strings for periodic_of_text
  std::vector<std::string> sources;                              ///< strings for source_of_text
  std::vector<std::string> wakes;                                ///< strings for wake_of_text
  std::vector<std::pair<std::string, OptionOverrides>> patches;  ///< pattern of names, options
  bool is_half = false;                                          ///< the surface is cut to its half
  OptionOverrides half;                                          ///< --set half.axis=z; only with is_half
};

/// Adds --disc, --wake-sheet, --periodic, --source, --wake, --farfield, --half and --patch. Options of the farfield go to `options`. \param what the verb of
/// the command: "mesh"
void add_volume_arguments(CLI::App& command, VolumeRequest& request, OptionOverrides& options, const std::string& what);

/// Sets discs, wake sheets and periodic sides of the case.
/// \throws Error(bad_argument, unknown_option)
void read_features(const VolumeRequest& request, volmesh::MeshCase& options);
/// Returns the sources that do not depend on the wall.
std::vector<volmesh::SizeSource> sources_of(const std::vector<std::string>& texts);
/// Adds refinement regions and wakes behind the body to the case.
void add_sources(const VolumeRequest& request, const TriMesh& wall, volmesh::MeshCase& options);
/// Returns the options of the cut.
/// \throws Error(bad_argument) for options of half without --half
HalfOptions half_options(const VolumeRequest& request, const CommandContext& context);
/// With --half: returns the half of the surface, otherwise the surface.
/// \throws as half_options
SurfaceValue halved(const VolumeRequest& request, const SurfaceValue& wall, const CommandContext& context);
/// Reads the file of the farfield shape "surface", if one is named, and adds it to the wall's inputs.
void read_farfield_of(volmesh::MeshCase& options, SurfaceValue& wall, const RunContext& context);

}  // namespace sterna::scripting
