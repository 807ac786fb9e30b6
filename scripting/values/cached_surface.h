// Takes the surface mesh of models from a cache if present.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "geom/base/run_context.h"
#include "scripting/cache/cached_answers.h"
#include "scripting/cache/reuse.h"
#include "scripting/values/mesh_parts.h"
#include "scripting/values/models.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Returns "of body, wing, tail": names of components.
std::string names_of(const std::vector<ModelHandle>& models);

/// Returns a mesher that calls mesh_part() or returns its cached mesh of the same part: the same model, names, kinds, options and rules, at any location. Parts
/// whose sizes depend on their location, or whose inputs are unknown, are always meshed again.
PartMesher cached_part_mesher(const Reuse& reuse);

/// Returns the surface that `make` makes of the models, or the cached result of the same call. A surface from the cache also refers to its models: `all` builds
/// the geometry for its model wall when a vertex has to be moved to the model, which is rare.
/// \throws what make() throws
SurfaceValue cached_surface(const std::vector<ModelHandle>& models, const SurfaceRecipe& requested, const SizeFunction& size,
                            const std::function<SurfaceValue(const SizeFunction&)>& make, const std::function<Model()>& all, const Reuse& reuse,
                            const RunContext& context);

}  // namespace sterna::scripting
