// remesh of a wall: new triangles, taken from a cache if present.
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
  std::vector<surfmesh::PatchSurfaceOptions> patches;  ///< the last that matches a patch applies
  std::vector<volmesh::SizeSource> sources;            ///< in space
};

/// Returns the wall with new triangles; its inputs, its rules for layers and the kinds of its patches are kept. The changes are in the report's messages and
/// the log. `size`: lengths of edges by location, called by this thread alone; then nothing is cached.
/// \throws Error of surfmesh::remesh_surface; bad_argument for a source that volmesh::problem_of rejects
SurfaceValue remeshed(const SurfaceValue& wall, const RemeshRecipe& recipe, const std::function<double(const Point&)>& size, const RunContext& context,
                      const Reuse& reuse = {});

/// Minimum share of slivers (corners below volume_mesh's split_needles) from which new triangles are advised for a sound triangulation. Below this share at
/// most ten tetrahedra failed on any surface of docs/needles.md, above it tens to hundreds.
inline constexpr double k_many_needles = 0.02;

/// Returns true if gates would fail on the wall's triangles: by surfmesh::is_remesh_advised for repaired or wrapped surfaces, by k_many_needles for sound
/// triangulations. Always false for the triangles of models' faces.
bool is_remesh_advised(const SurfaceValue& wall);

/// Returns the wall with new triangles if they are advised and better: at most half the share of slivers, and no corner below a degree that was not there
/// before. The distance from the given triangles must be at most a thousandth of the length and a fifth of their edges. The area turned by more than 10 degrees
/// must not grow. Else returns the wall unchanged; the log reports the choice. A max_triangles other than the default is the budget; by default the budget is
/// 20 times the given triangles, at least 200 000.
SurfaceValue without_needles(const SurfaceValue& wall, const RemeshRecipe& recipe, const RunContext& context, const Reuse& reuse = {});

}  // namespace sterna::scripting
