// The surface mesh of models, taken from a cache where it is there.
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

/// "of body, wing, tail": names of components.
std::string names_of(const std::vector<ModelHandle>& models);

/// mesh_part(), or what it made of the same part before: the same model, its names and kinds, options and rules, wherever it is. Parts whose sizes depend on
/// their place, or of which it is not known what they were made of, are made anew.
PartMesher cached_part_mesher(const Reuse& reuse);

/// What `make` makes of the models, or what it made of the same before. A surface from the cache knows its models, too: what its model wall needs of them is
/// made by `all` when a vertex has to go there, which is seldom.
/// \throws what make() throws
SurfaceValue cached_surface(const std::vector<ModelHandle>& models, const SurfaceRecipe& asked, const SizeFunction& size,
                            const std::function<SurfaceValue(const SizeFunction&)>& make, const std::function<Model()>& all, const Reuse& reuse,
                            const RunContext& context);

}  // namespace sterna::scripting
