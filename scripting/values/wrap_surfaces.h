// Surfaces and files wrapped to one closed surface, taken from a cache where it is there.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "geom/base/error.h"
#include "scripting/cache/reuse.h"
#include "scripting/values/verbs.h"
#include "surfmesh/wrap/wrap_surface.h"

namespace sterna::scripting {

/// Files are read with the options' unit; surfaces are in metres. Rules of layers and kinds of patches that manifests beside the files know are kept.
/// `look` sees the whole report; then nothing is taken from a cache.
/// \throws Error of io and of surfmesh::wrap_surface
SurfaceValue wrap_surfaces(std::span<const UnionItem> items, const surfmesh::WrapOptions& options, const Reuse& reuse, const RunContext& context,
                           const std::function<void(const surfmesh::WrapReport&)>& look = {});

/// What was closed over or leaks, for a VTU.
TroubleGeometry closed_facets(const surfmesh::WrapReport& report);
/// Sizes used, closures and leaks with place and size, distances, as JSON.
std::string wrap_json(const surfmesh::WrapReport& report);

}  // namespace sterna::scripting
