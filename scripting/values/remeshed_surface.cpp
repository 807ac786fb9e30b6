#include "scripting/values/remeshed_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geom/math/constants.h"
#include "scripting/cache/content_key.h"
#include "scripting/cache/stage_cache.h"
#include "scripting/values/geometry_changes.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/summary.h"
#include "scripting/values/value_keys.h"
#include "surfmesh/remesh/remesh_demand.h"
#include "volmesh/case/needle_options.h"

namespace sterna::scripting {
namespace {

/// Of the needles before: with more left the lines of the surface force them, and layers there are no better for it.
constexpr double k_fewer_needles = 0.5;
/// Refinements that are tried one after the other where there would be too many triangles: those of a family.
constexpr std::array<double, 3> k_coarser = {1.0, 2.0 / 3.0, 4.0 / 9.0};
/// Of the body's length: new triangles further from the given ones have lost something of the shape (a nose, a thin part), and nobody asked for them.
constexpr double k_largest_distance = 0.02;
/// without_needles() makes at most so many times the triangles, within these bounds: steps and slivers that look like curvature would ask for millions.
constexpr std::size_t k_many_times = 5, k_few_triangles = 50'000, k_many_triangles = 200'000;

std::optional<ContentKey> remesh_key(const SurfaceValue& wall, const RemeshRecipe& recipe, const std::function<double(const Point&)>& size) {
  if (size) return std::nullopt;
  surfmesh::RemeshOptions options = recipe.options;
  return KeyMaker("remeshed").add(key_of(wall.mesh)).add(sterna::options_of(options)).add(recipe.patches).add(recipe.sources).key();
}

SurfaceValue remeshed_if(const SurfaceValue& wall, const RemeshRecipe& recipe, const std::function<double(const Point&)>& size,
                         const surfmesh::RemeshDemand& demand, const RunContext& context, const Reuse& reuse) {
  SurfaceRecipe asked;
  asked.options.growth = recipe.options.growth;
  asked.sources = recipe.sources;
  const surfmesh::SpaceSizes sizes = space_sizes(asked, size);
  surfmesh::RemeshResult result = cached<surfmesh::RemeshResult>(reuse, "remesh", "", remesh_key(wall, recipe, size), context, [&] {
    return surfmesh::remesh_surface(wall.mesh, recipe.options, recipe.patches, sizes, demand, context);
  });
  require_near(result.report, demand);  // a cached result was made without a demand, perhaps
  SurfaceValue made = wall;
  made.mesh = std::move(result.mesh);
  made.remesh_options = recipe.options;
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

/// The accepted surface, with warnings of what is missing or different.
SurfaceValue with_change(SurfaceValue made, const SurfaceValue& wall, const RunContext& context) {
  note_change(made, compare_geometry(wall.mesh, made.mesh, "remesh", context), context);
  return made;
}

}  // namespace

SurfaceValue remeshed(const SurfaceValue& wall, const RemeshRecipe& recipe, const std::function<double(const Point&)>& size, const RunContext& context,
                      const Reuse& reuse) {
  return with_change(remeshed_if(wall, recipe, size, {}, context, reuse), wall, context);
}

bool is_remesh_advised(const SurfaceValue& wall) {
  if (wall.repair_options || wall.wrap_options) return surfmesh::is_remesh_advised(surfmesh::count_needles(wall.mesh), wall.mesh.n_triangles());
  if (wall.mesh_report) return false;
  const auto n = static_cast<double>(surfmesh::count_needles(wall.mesh, volmesh::NeedleOptions{}.split_needles).n);
  return n > 0.0 && n >= k_many_needles * static_cast<double>(wall.mesh.n_triangles());
}

SurfaceValue without_needles(const SurfaceValue& wall, const RemeshRecipe& recipe, const RunContext& context, const Reuse& reuse) {
  if (!is_remesh_advised(wall)) return wall;
  const surfmesh::NeedleCount before = surfmesh::count_needles(wall.mesh);
  RemeshRecipe bounded = recipe;
  const std::size_t n = wall.mesh.n_triangles();
  const std::size_t most = std::clamp(k_many_times * n, k_few_triangles, std::max(k_many_triangles, n));
  bounded.options.max_triangles = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(recipe.options.max_triangles), most));
  const surfmesh::RemeshDemand demand{.most_needles = static_cast<std::int64_t>(std::ceil(k_fewer_needles * static_cast<double>(before.n))) - 1,
                                      .least_angle = before.least_angle,
                                      .largest_distance = k_largest_distance};
  for (std::size_t i = 0; i < k_coarser.size(); ++i) {
    bounded.options.refinement = k_coarser[i] * recipe.options.refinement;
    try {
      SurfaceValue made = remeshed_if(wall, bounded, {}, demand, context, reuse);
      // A cached result was made without a demand, perhaps: it is looked at again.
      const surfmesh::NeedleCount after = surfmesh::count_needles(made.mesh);
      if (static_cast<double>(after.n) < k_fewer_needles * static_cast<double>(before.n) && after.least_angle >= before.least_angle)
        return with_change(std::move(made), wall, context);
      context.info(fmt::format("auto: remesh leaves {} needles of {}, the least angle {:.3g} deg for {:.3g} deg: the triangles stay as they are",
                               count_text(after.n), count_text(before.n), after.least_angle / k_degree, before.least_angle / k_degree));
      break;
    } catch (const Error& error) {
      if (error.code() == ErrorCode::cancelled) throw;
      const bool is_last = error.code() != ErrorCode::overflow || i + 1 == k_coarser.size();
      context.info("auto: " + error.info().attempted + ": " + error.info().problem +
                   (is_last ? "; the triangles stay as they are" : fmt::format("; it is tried with edges {:.3g} times as long", 1.0 / k_coarser[i + 1])));
      if (is_last) break;
    }
  }
  return wall;
}

}  // namespace sterna::scripting
