// Surfaces and files wrapped to one closed surface, taken from a cache where it is there.
#pragma once

#include <span>

#include "scripting/cache/reuse.h"
#include "scripting/values/verbs.h"
#include "surfmesh/wrap/wrap_surface.h"

namespace sterna::scripting {

/// Files are read with the options' unit; surfaces are in metres. Rules of layers and kinds of patches that manifests beside the files know are kept.
/// \throws Error of io and of surfmesh::wrap_surface
SurfaceValue wrap_surfaces(std::span<const UnionItem> items, const surfmesh::WrapOptions& options, const Reuse& reuse, const RunContext& context);

}  // namespace sterna::scripting
