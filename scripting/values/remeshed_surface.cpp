#include "scripting/values/remeshed_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include "geom/math/constants.h"
#include "scripting/cache/content_key.h"
#include "scripting/cache/stage_cache.h"
#include "scripting/values/geometry_changes.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/summary.h"
#include "scripting/values/value_keys.h"
#include "surfmesh/remesh/remesh_demand.h"
#include "volmesh/case/sliver_options.h"

namespace sterna::scripting {
namespace {

/// Largest accepted share of slivers, relative to the previous share. If more slivers remain, the feature lines of the surface force them, and layers there do
/// not improve.
constexpr double k_fewer_slivers = 0.5;
/// Limits of the distance of new triangles from the given ones, relative to the body's length and to the edges of the new triangles. Beyond them the new
/// triangles have lost part of the shape (a dent, a nose, a thin part).
constexpr double k_largest_distance = 1e-3, k_largest_of_edge = 0.2;
/// Fraction of the area that may be turned from the smooth surface in addition to that of the given triangles. It allows for regions at feature lines, where
/// both values depend on a single triangle.
constexpr double k_more_turned = 0.005;
/// Limits of the number of triangles made by without_slivers(): a factor and a number, of which the larger applies. Without them, steps and slivers that
/// resemble curvature would lead to millions of triangles.
constexpr std::size_t k_many_times = 20, k_few_triangles = 200'000;

/// One attempt: the refinement of a family, and if vertices are on the given triangles because those on the smooth surface are too far from them.
struct RemeshAttempt {
  double refinement;
  bool is_smooth;
};
/// The first attempt uses the requested sizes. If it has too many triangles, larger sizes follow; if its result is too far from the shape, or too thin, smaller
/// sizes follow.
constexpr RemeshAttempt k_first{1.0, true};
constexpr std::array<RemeshAttempt, 2> k_coarser{{{2.0 / 3.0, true}, {4.0 / 9.0, true}}};
constexpr std::array<RemeshAttempt, 2> k_finer{{{1.0, false}, {1.5, true}}};

std::string text_of(const RemeshAttempt& attempt) {
  if (!attempt.is_smooth) return "remesh is repeated with vertices on the given triangles";
  return fmt::format("remesh is repeated with edges {:.3g} times as long", 1.0 / attempt.refinement);
}

std::optional<ContentKey> remesh_key(const SurfaceValue& wall, const RemeshRecipe& recipe, const std::function<double(const Point&)>& size) {
  if (size) return std::nullopt;
  surfmesh::RemeshOptions options = recipe.options;
  return KeyMaker("remeshed").add(key_of(wall.mesh)).add(sterna::options_of(options)).add(recipe.patches).add(recipe.sources).key();
}

SurfaceValue remeshed_if(const SurfaceValue& wall, const RemeshRecipe& recipe, const std::function<double(const Point&)>& size,
                         const surfmesh::RemeshDemand& demand, const RunContext& context, const Reuse& reuse) {
  SurfaceRecipe requested;
  requested.options.sizes.growth = recipe.options.sizes.growth;
  requested.sources = recipe.sources;
  const surfmesh::SpaceSizes sizes = space_sizes(requested, size);
  surfmesh::RemeshResult result = cached<surfmesh::RemeshResult>(reuse, "remesh", "", remesh_key(wall, recipe, size), context, [&] {
    return surfmesh::remesh_surface(wall.mesh, recipe.options, recipe.patches, sizes, demand, context);
  });
  require_likeness(result.report, demand);  // a cached result may have been made without this demand
  SurfaceValue made = wall;
  replace_mesh(made, std::move(result.mesh));
  const std::string text = "remeshed: " + to_text(result.report);
  made.report.messages.push_back(text);
  made.history.push_back(
      {.options = recipe.options,
       .changes = {fmt::format("remeshed: {} -> {} triangles, at most {:.3g} m from the given ones", count_text(result.report.n_triangles_before),
                               count_text(result.report.n_triangles), std::max(result.report.to_input.max, result.report.from_input.max))}});
  context.info(text);
  return made;
}

/// Returns the accepted surface, with warnings about missing or different parts.
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
  if (last_of<surfmesh::RepairOptions>(wall.history) || last_of<surfmesh::WrapOptions>(wall.history))
    return surfmesh::is_remesh_advised(surfmesh::count_slivers(wall.mesh), wall.mesh.n_triangles());
  if (wall.mesh_report) return false;
  const auto n = static_cast<double>(surfmesh::count_slivers(wall.mesh, volmesh::SliverOptions{}.split_needles).n);
  return n > 0.0 && n >= k_many_slivers * static_cast<double>(wall.mesh.n_triangles());
}

SurfaceValue without_slivers(const SurfaceValue& wall, const RemeshRecipe& recipe, const RunContext& context, const Reuse& reuse) {
  if (!is_remesh_advised(wall)) return wall;
  const surfmesh::SliverCount before = surfmesh::count_slivers(wall.mesh);
  RemeshRecipe bounded = recipe;
  const std::size_t n = wall.mesh.n_triangles();
  const double share_before = static_cast<double>(before.n) / static_cast<double>(n);
  const bool is_own_budget = recipe.options.sizes.max_triangles == surfmesh::SurfaceSizeOptions{}.max_triangles;
  if (is_own_budget)
    bounded.options.sizes.max_triangles =
        static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(recipe.options.sizes.max_triangles), std::max(k_many_times * n, k_few_triangles)));
  const surfmesh::RemeshDemand demand{.most_slivers = k_fewer_slivers * share_before,
                                      .least_angle = std::min(before.least_angle, surfmesh::k_worst_sliver_angle),
                                      .largest_distance = k_largest_distance,
                                      .largest_distance_of_edge = k_largest_of_edge,
                                      .more_turned = k_more_turned};
  const auto meets = [&](const SurfaceValue& made) {  // a cached result may have been made without this demand
    const surfmesh::SliverCount after = surfmesh::count_slivers(made.mesh);
    const double share = static_cast<double>(after.n) / static_cast<double>(made.mesh.n_triangles());
    if (share <= demand.most_slivers && after.least_angle >= demand.least_angle) return true;
    context.info(
        fmt::format("auto: after remesh {:.3g} % of the triangles are slivers (before: {:.3g} %), the smallest angle is {:.3g} deg (before: {:.3g} deg)",
                    100.0 * share, 100.0 * share_before, after.least_angle / k_degree, before.least_angle / k_degree));
    return false;
  };
  std::span<const RemeshAttempt> others;
  std::size_t next = 0;
  for (RemeshAttempt attempt = k_first;;) {
    bounded.options.sizes.refinement = attempt.refinement * recipe.options.sizes.refinement;
    bounded.options.smooth = attempt.is_smooth && recipe.options.smooth;
    std::string problem = "auto: the result of remesh does not meet the requirements";
    try {
      SurfaceValue made = remeshed_if(wall, bounded, {}, demand, context, reuse);
      if (meets(made)) return with_change(std::move(made), wall, context);
      if (others.empty()) others = k_finer;
    } catch (const Error& error) {
      if (error.code() == ErrorCode::cancelled) throw;
      const bool is_too_many = error.code() == ErrorCode::overflow;
      problem = "auto: " + error.info().attempted + ": " + error.info().problem;
      if (is_too_many) problem += fmt::format(" (remesh.max_triangles{})", is_own_budget ? ", by default 20 times the given triangles, at least 200000" : "");
      if (others.empty()) others = is_too_many ? std::span<const RemeshAttempt>(k_coarser) : std::span<const RemeshAttempt>(k_finer);
    }
    if (next == others.size()) {
      context.info(problem + "; the triangles are kept");
      return wall;
    }
    attempt = others[next++];
    context.info(problem + "; " + text_of(attempt));
  }
}

}  // namespace sterna::scripting
