// What the workbench shows of an object that a script made: triangles, patches, figures, measures as one block of bytes.
#pragma once

#include <string>

#include "geom/base/run_context.h"
#include "scripting/lua/script_value.h"

namespace sterna::scripting {

/// Whether there is something to draw: models, components, surfaces, envelopes, tetrahedra's layer, volume meshes.
bool is_drawable(const ScriptValue& value);
/// One line: what it is.
std::string object_text(const ScriptValue& value);

struct SceneOptions {
  std::size_t max_triangles = 1'500'000;  ///< above that the surface is thinned, and says so
  bool is_quick = false;                  ///< nothing but the shape: no measures, no curvature
};

/// Four bytes of length (little-endian), four of nought, a JSON object of that length padded with blanks to a multiple of 4, then the arrays that it points
/// into (docs/report.md: schema sterna-scene-1 has its frame, patches and surface; also facts, and of volume meshes verdict, gates, places).
/// \pre is_drawable(value) \throws Error of making a component's model, of check
std::string scene_bytes(const ScriptValue& value, const SceneOptions& options, const RunContext& context);

/// JSON of what inspect{} says of a surface without layers (schema sterna-inspect-1: findings with places and advice).
/// \throws Error(bad_argument) for another object than a surface
std::string inspection_json(const ScriptValue& value, const RunContext& context);

/// JSON of a cut through a volume mesh and its arrays, in the same form. `plane` as `--cut` takes it: "x=1.2", "point=0,0,0 normal=0,1,0"
/// \throws Error(bad_argument) for another text, or another object than a volume mesh
std::string cut_bytes(const ScriptValue& value, const std::string& plane, std::size_t max_polygons, const RunContext& context);

}  // namespace sterna::scripting
