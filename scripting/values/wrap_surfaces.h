// Wraps surfaces and files to one closed surface, from a cache if present.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "geom/base/error.h"
#include "scripting/cache/reuse.h"
#include "scripting/values/verbs.h"
#include "surfmesh/wrap/wrap_surface.h"

namespace sterna::scripting {

/// Wraps the items. Files are read with the options' unit; surfaces are in metres. Rules of layers and kinds of patches in manifests beside the files are kept.
/// `look` receives the whole report; if it is set, nothing is taken from a cache.
/// \throws Error of io and of surfmesh::wrap_surface
SurfaceValue wrap_surfaces(std::span<const UnionItem> items, const surfmesh::WrapOptions& options, const Reuse& reuse, const RunContext& context,
                           const std::function<void(const surfmesh::WrapReport&)>& look = {});

/// Returns the regions that were closed over and the leaking regions, for a VTU.
TroubleGeometry closed_facets(const surfmesh::WrapReport& report);
/// Returns, as JSON, the sizes that were used, closures and leaks with location and size, and distances.
std::string wrap_json(const surfmesh::WrapReport& report);

}  // namespace sterna::scripting
