// The history of a surface: the steps that made and changed it, in order. Manifests and summaries print it, and keys contain it.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "geom/base/rules.h"
#include "geom/boolean/union_meshes.h"
#include "scripting/values/option_json.h"
#include "surfmesh/model/surface_mesh.h"
#include "surfmesh/remesh/remesh_surface.h"
#include "surfmesh/repair/repair_surface.h"
#include "surfmesh/wrap/wrap_surface.h"
#include "volmesh/case/size_sources.h"

namespace sterna::scripting {

/// The request to surface_mesh.
struct SurfaceRecipe {
  surfmesh::SurfaceMeshOptions options;
  std::vector<Rule> patches;                 ///< rules of faces; the last rule that matches a face applies
  std::vector<volmesh::SizeSource> sources;  ///< sources in space
  bool has_function = false;                 ///< a function of the location also limits the edges
};

/// A step that made or changed a surface.
struct SurfaceStep {
  /// Options of the verb. std::monostate: a verb without stored options, or a step that was read from a manifest.
  std::variant<std::monostate, UnionOptions, surfmesh::RepairOptions, surfmesh::WrapOptions, surfmesh::RemeshOptions, SurfaceRecipe> options = {};
  std::vector<std::string> changes = {};  ///< differences from the surface before the step, one sentence each
  std::string figures = {};               ///< figures before and after the step, as a JSON object (geom/mesh/compare_geometry.h); empty: not compared
};

using SurfaceHistory = std::vector<SurfaceStep>;

/// Returns the options of the last step of this kind; null if there is none.
template <class T, class History>
auto last_of(History& history) {
  for (auto step = history.rbegin(); step != history.rend(); ++step)
    if (auto* options = std::get_if<T>(&step->options)) return options;
  return decltype(std::get_if<T>(&history.front().options))(nullptr);
}

/// Returns the sentences of all steps. They come first in summaries and manifests.
std::vector<std::string> changes_of(const SurfaceHistory& history);

/// Adds the changes and figures of a surface from which a verb makes another one. Options are left out, because they describe other triangles, but the recipe
/// of a surface may be kept.
void inherit(SurfaceHistory& history, const SurfaceHistory& from, bool keeps_recipe = false);

/// Returns the options of the last union, repair, wrap, remesh and surface_mesh. `history` must outlive the table.
OptionTable history_options(SurfaceHistory& history);

/// Adds the entry "surface_patches" of the recipe, if there are rules.
void add_rules(Json& json, const SurfaceRecipe& recipe);
/// Adds the entries "surface_patches" and "surface_sources" of the recipe, as far as it has them. The second function reads them.
/// \throws Error(file_malformed, bad_argument)
void add_recipe(Json& json, const SurfaceRecipe& recipe);
void read_recipe(const Json& json, SurfaceRecipe& recipe);
/// Adds the entries "changes" and "changed" (figures), as far as there are any. The second function reads them; figures that are no objects are left out.
/// \throws nlohmann::json::exception if an entry of "changes" is no string
void add_changes(Json& json, const SurfaceHistory& history);
SurfaceHistory read_changes(const Json& json);

}  // namespace sterna::scripting
