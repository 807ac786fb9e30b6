// remesh of a wall: new triangles, taken from a cache where they are there.
#pragma once

#include <functional>
#include <vector>

#include "geom/base/run_context.h"
#include "scripting/cache/reuse.h"
#include "scripting/values/verbs.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::scripting {

/// What remesh was asked for.
struct RemeshRecipe {
  surfmesh::RemeshOptions options;
  std::vector<surfmesh::PatchSurfaceOptions> patches;  ///< the last that matches a patch counts
  std::vector<volmesh::SizeSource> sources;            ///< in space
};

/// The wall with new triangles; its inputs, its rules for layers and the kinds of its patches stay. What was done is in the report's messages and the log.
/// `size`: lengths of edges by place, called by this thread alone; then nothing is cached.
/// \throws Error of surfmesh::remesh_surface; bad_argument for a source that volmesh::problem_of objects to
SurfaceValue remeshed(const SurfaceValue& wall, const RemeshRecipe& recipe, const std::function<double(const Point&)>& size, const RunContext& context,
                      const Reuse& reuse = {});

/// From this share of needles on (corners below volume_mesh's split_needles) new triangles are advised for a sound triangulation: below it at most ten
/// tetrahedra failed on any surface of docs/needles.md, above it tens to hundreds.
inline constexpr double k_many_needles = 0.02;

/// Whether gates would fail on the wall's triangles: of what was repaired or wrapped by surfmesh::is_remesh_advised, of sound triangulations by
/// k_many_needles. Of the triangles of models' faces never.
bool is_remesh_advised(const SurfaceValue& wall);

/// The wall with new triangles where they are advised and better: half the share of needles at most, none below a degree that was not there, within a
/// thousandth of the length and a fifth of their edges of the given ones, and no more area turned by more than 10 degrees. Else the wall as it is: the log
/// says which. A max_triangles other than the default is the budget; by default it is 20 times the given triangles, at least 200 000.
SurfaceValue without_needles(const SurfaceValue& wall, const RemeshRecipe& recipe, const RunContext& context, const Reuse& reuse = {});

}  // namespace sterna::scripting
