#include "scripting/values/remeshed_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "scripting/cache/content_key.h"
#include "scripting/cache/stage_cache.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/summary.h"
#include "scripting/values/value_keys.h"

namespace sterna::scripting {
namespace {

std::optional<ContentKey> remesh_key(const SurfaceValue& wall, const RemeshRecipe& recipe, const std::function<double(const Point&)>& size) {
  if (size) return std::nullopt;
  surfmesh::RemeshOptions options = recipe.options;
  return KeyMaker("remeshed").add(key_of(wall.mesh)).add(sterna::options_of(options)).add(recipe.patches).add(recipe.sources).key();
}

}  // namespace

SurfaceValue remeshed(const SurfaceValue& wall, const RemeshRecipe& recipe, const std::function<double(const Point&)>& size, const RunContext& context,
                      const Reuse& reuse) {
  SurfaceRecipe asked;
  asked.options.growth = recipe.options.growth;
  asked.sources = recipe.sources;
  const surfmesh::SpaceSizes sizes = space_sizes(asked, size);
  surfmesh::RemeshResult result = cached<surfmesh::RemeshResult>(reuse, "remesh", "", remesh_key(wall, recipe, size), context, [&] {
    return surfmesh::remesh_surface(wall.mesh, recipe.options, recipe.patches, sizes, context);
  });
  SurfaceValue made = wall;
  made.mesh = std::move(result.mesh);
  made.mesh_report.reset();  // of the triangles before
  made.model_wall.reset();
  made.model_wall_key.reset();
  made.parts.clear();
  const std::string text = "remeshed: " + to_text(result.report);
  made.report.messages.push_back(text);
  made.changes.push_back(fmt::format("remeshed: {} -> {} triangles, at most {:.3g} m from the given ones", count_text(result.report.n_triangles_before),
                                     count_text(result.report.n_triangles), std::max(result.report.to_input.max, result.report.from_input.max)));
  context.info(text);
  return made;
}

}  // namespace sterna::scripting
