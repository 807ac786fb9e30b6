// Makes new triangles for a wall (remesh), from a cache if present.
#pragma once

#include <functional>
#include <vector>

#include "geom/base/run_context.h"
#include "scripting/cache/reuse.h"
#include "scripting/values/verbs.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::scripting {

/// The request to remesh.
struct RemeshRecipe {
  surfmesh::RemeshOptions options;
  std::vector<Rule> patches;                 ///< rules of patches; the last rule that matches a patch applies
  std::vector<volmesh::SizeSource> sources;  ///< sources in space
};

/// Returns the wall with new triangles; its inputs, its rules for layers and the kinds of its patches are kept. The changes are in the report's messages and
/// the log. `size`: lengths of edges by location, called by this thread alone; then nothing is cached.
/// \throws Error of surfmesh::remesh_surface; bad_argument for a source that volmesh::problem_of rejects
SurfaceValue remeshed(const SurfaceValue& wall, const RemeshRecipe& recipe, const std::function<double(const Point&)>& size, const RunContext& context,
                      const Reuse& reuse = {});

/// Share of slivers (corners below volume_mesh's split_needles) above which new triangles are advised for a sound triangulation. Below this share at most ten
/// tetrahedra failed on any surface of docs/needles.md, above it tens to hundreds.
inline constexpr double k_many_slivers = 0.02;

/// Returns true if gates would fail on the wall's triangles. This is tested by surfmesh::is_remesh_advised for repaired or wrapped surfaces, by k_many_slivers
/// for sound triangulations. Always false for the triangles of models' faces.
bool is_remesh_advised(const SurfaceValue& wall);

/// Returns the wall with new triangles if they are advised and better; otherwise returns the wall unchanged. The log reports the choice. New triangles are
/// better if they have at most half the share of slivers and no corner below a degree that was not there before. Their distance from the given triangles must
/// be at most a thousandth of the length and a fifth of their edges. The area turned by more than 10 degrees must not grow. The budget is max_triangles if that
/// differs from its default; by default it is 20 times the given triangles, at least 200 000.
SurfaceValue without_slivers(const SurfaceValue& wall, const RemeshRecipe& recipe, const RunContext& context, const Reuse& reuse = {});

}  // namespace sterna::scripting
