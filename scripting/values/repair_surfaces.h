// repair of files and surfaces, and the sequence of --auto: use the files as they are, else repair them, else wrap them.
#pragma once

#include <functional>
#include <span>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/cad/read_cad.h"
#include "scripting/cache/reuse.h"
#include "scripting/values/verbs.h"
#include "surfmesh/remesh/remesh_surface.h"
#include "surfmesh/repair/repair_surface.h"
#include "surfmesh/wrap/wrap_surface.h"

namespace sterna::scripting {

/// Reads files with the unit of `stitching`; surfaces are in metres. Sound surfaces are returned with the bytes of read_wall and without a change. `look`
/// receives the whole report; if it is set, nothing is taken from a cache.
/// \throws Error of io and of surfmesh::repair_surface
SurfaceValue repair_surfaces(std::span<const UnionItem> items, const surfmesh::StitchOptions& stitching, const surfmesh::RepairOptions& options,
                             const Reuse& reuse, const RunContext& context, const std::function<void(const surfmesh::RepairReport&)>& look = {});

/// Returns the options of repair for users: those of repair itself and those of reading, except options of reading that repair sets.
OptionTable repair_options(surfmesh::StitchOptions& stitching, surfmesh::RepairOptions& options);

/// Returns the changed facets, for a VTU.
TroubleGeometry changed_facets(const surfmesh::RepairReport& report);
/// Returns, as JSON, the changes with kind, location, size and number of facets, the distances, and the options.
std::string repair_json(const surfmesh::RepairReport& report);

struct AutoSurface {
  surfmesh::StitchOptions stitching = {};
  surfmesh::RepairOptions repair = {};
  surfmesh::WrapOptions wrap = {};           ///< its unit, fluid and split_angle are those of `stitching`
  ReadCadOptions reading = {};               ///< for models
  SurfaceRecipe recipe = {};                 ///< for models
  std::vector<PeriodicNames> periodic = {};  ///< pairs of sides of the volume; pairs of faces of models are meshed identically
  surfmesh::RemeshOptions remesh = {};
};

/// Returns the options of wrap, with the unit, the fluid and the split angle of reading.
surfmesh::WrapOptions wrap_with_reading(surfmesh::WrapOptions wrap, const surfmesh::StitchOptions& reading);

/// Returns a surface that can be meshed, with as few changes as its files allow. Surfaces that can be meshed as they are have the bytes of read_wall or
/// mesh_model_files. Models whose faces cross or fold, or that are open, are first triangulated as they are (crossings = "ignore") and then treated as
/// triangulations.
/// \throws Error of the first step with the reports of repair and wrap. An error that is not about the surface (a missing file, an option) is thrown at once
SurfaceValue auto_triangles(std::span<const InputPath> files, const AutoSurface& options, const Reuse& reuse, const RunContext& context);

/// Returns the surface of auto_triangles(), with new triangles if the given ones would make gates fail (without_slivers).
SurfaceValue auto_surface(std::span<const InputPath> files, const AutoSurface& options, const Reuse& reuse, const RunContext& context);

/// Returns true if an error is about the surface itself, so that repair or wrap may help.
bool is_about_surface(const Error& error);

}  // namespace sterna::scripting
