// The request of a volume mesh in a verb's table: the same reading for volume_mesh, make_envelope and inspect, so that all of them take the same entries.
#pragma once

#include <vector>

#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"
#include "scripting/values/verbs.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::scripting {

struct VolumeCase {
  volmesh::MeshCase options;
  std::vector<InputFile> farfield_inputs;  ///< files of the farfield
  FunctionHandle first_heights;            ///< first height by location; null: none
};

/// Which entries the verb takes, besides the options of its schema.
enum class SourceEntries { taken, of_a_later_step };

/// Reads first heights, options, interfaces, wakes, periodic sides, rules for patches, and sources. Notes problems.
void read_volume_case(TableReader& reader, const ScriptCall& call, const OptionTable& schema, SourceEntries sources, VolumeCase& made);
/// Applies the command line's overrides, and derives what follows from combinations of options. Notes problems.
/// \pre read_volume_case
void complete_volume_case(TableReader& reader, const ScriptCall& call, const OptionTable& schema, VolumeCase& made);
/// Notes the required options that neither the case nor the rules of the wall (which may be null) give.
void require_volume_options(TableReader& reader, const VolumeCase& made, const SurfaceValue* wall);
/// Returns the wall with the inputs of the case, and evaluates its first heights there.
/// \throws as set_first_heights
SurfaceValue wall_of_case(const SurfaceValue& wall, VolumeCase& made, const RunContext& context);

}  // namespace sterna::scripting
