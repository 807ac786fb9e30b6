// Scene data of an object for the workbench: triangles, patches, figures and measures in one block of bytes.
#pragma once

#include <string>

#include "geom/base/run_context.h"
#include "scripting/lua/script_value.h"

namespace sterna::scripting {

/// Returns true if the value can be drawn: models, components, surfaces, envelopes, tetrahedra (drawn as their wall), volume meshes.
bool is_drawable(const ScriptValue& value);
/// Returns a one-line description of the object.
std::string object_text(const ScriptValue& value);

struct SceneOptions {
  std::size_t max_triangles = 1'500'000;  ///< if there are more, the surface is decimated, which the scene states
  bool is_quick = false;                  ///< only the shape is made, without measures and curvature
};

/// Returns the block of bytes. It has four bytes of length (little-endian), four zero bytes, a JSON object of that length padded with blanks to a multiple of
/// 4, then the arrays to which the JSON refers. docs/report.md describes the JSON: sterna-scene-1 has the page's frame, patches and surface; also facts, and
/// for volume meshes verdict, gates and places.
/// \pre is_drawable(value)
/// \throws errors of making a component's model, and of check
std::string scene_bytes(const ScriptValue& value, const SceneOptions& options, const RunContext& context);

/// Returns the result of inspect{} for a surface without layers as JSON (schema sterna-inspect-1: findings with places and advice).
/// \throws Error(bad_argument) for an object other than a surface
std::string inspection_json(const ScriptValue& value, const RunContext& context);

/// Returns the JSON and arrays of a cut through a volume mesh, in the same form. `plane` is as in `--cut`: "x=1.2", "point=0,0,0 normal=0,1,0"
/// \throws Error(bad_argument) for another string, or for an object other than a volume mesh
std::string cut_bytes(const ScriptValue& value, const std::string& plane, std::size_t max_polygons, const RunContext& context);

}  // namespace sterna::scripting
