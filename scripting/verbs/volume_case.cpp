#include "scripting/verbs/volume_case.h"

#include "scripting/lua/verb_tools.h"
#include "scripting/values/disc_verbs.h"
#include "scripting/values/layer_options.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/periodic_pairs.h"
#include "scripting/values/wake_verbs.h"
#include "scripting/verbs/source_verbs.h"

namespace sterna::scripting {

void read_volume_case(TableReader& reader, const ScriptCall& call, const OptionTable& schema, SourceEntries sources, VolumeCase& made) {
  made.first_heights = read_first_heights(reader, call);
  reader.read_options(schema);
  if (sources == SourceEntries::taken) made.options.sources = read_sources(reader, call);
  made.options.discs = read_interfaces(reader, call);
  made.options.wakes = read_wakes(reader, call);
  made.options.periodic = read_periodic(reader);
  made.options.patches = read_layer_rules(reader);
}

void complete_volume_case(TableReader& reader, const ScriptCall& call, const OptionTable& schema, VolumeCase& made) {
  apply_overrides(call, schema);
  complete_layers(made.options, reader, call);
}

void require_volume_options(TableReader& reader, const VolumeCase& made, const SurfaceValue* wall) {
  volmesh::MeshCase known = made.options;
  if (wall) known.patches.insert(known.patches.end(), wall->layers.begin(), wall->layers.end());  // the rules of the surface may give the first height
  reader.require(volmesh::required_options_of(known));
}

SurfaceValue wall_of_case(const SurfaceValue& wall, VolumeCase& made, const RunContext& context) {
  SurfaceValue given = wall;
  given.inputs.insert(given.inputs.end(), made.farfield_inputs.begin(), made.farfield_inputs.end());
  set_first_heights(made.first_heights, given, made.options, context);
  return given;
}

}  // namespace sterna::scripting
