// repair of files and surfaces, and the ladder of --auto: as they are, repaired, wrapped.
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

/// Files are read with the unit of `stitching`; surfaces are in metres. What is sound comes back with the bytes of read_wall and without a change. `look` sees
/// the whole report; then nothing is taken from a cache.
/// \throws Error of io and of surfmesh::repair_surface
SurfaceValue repair_surfaces(std::span<const UnionItem> items, const surfmesh::StitchOptions& stitching, const surfmesh::RepairOptions& options,
                             const Reuse& reuse, const RunContext& context, const std::function<void(const surfmesh::RepairReport&)>& look = {});

/// What a user may ask of repair: its own options and those of reading but for what it does itself.
OptionTable repair_options(surfmesh::StitchOptions& stitching, surfmesh::RepairOptions& options);

/// The facets that were changed, for a VTU.
TroubleGeometry changed_facets(const surfmesh::RepairReport& report);
/// Changes with kind, place, size and number of facets, the distances and the options, as JSON.
std::string repair_json(const surfmesh::RepairReport& report);

struct AutoSurface {
  surfmesh::StitchOptions stitching = {};
  surfmesh::RepairOptions repair = {};
  surfmesh::WrapOptions wrap = {};                    ///< its unit, fluid and split_angle are those of `stitching`
  ReadCadOptions reading = {};                        ///< of models
  SurfaceRecipe recipe = {};                          ///< of models
  std::vector<volmesh::PeriodicNames> periodic = {};  ///< of the volume; those that are faces of models are cut alike
  surfmesh::RemeshOptions remesh = {};
};

/// A surface that can be meshed, with as little done to it as its files allow. What can be meshed as it is comes back with the bytes of read_wall or
/// mesh_model_files. Models whose faces cross or fold, or that are open, are triangulated as they are first (crossings = "ignore") and go on as triangulations.
/// \throws Error of the first step with what repair and wrap said of it; at once what is not about the surface (a missing file, an option)
SurfaceValue auto_triangles(std::span<const InputPath> files, const AutoSurface& options, const Reuse& reuse, const RunContext& context);

/// auto_triangles, and new triangles where those would make gates fail (without_needles).
SurfaceValue auto_surface(std::span<const InputPath> files, const AutoSurface& options, const Reuse& reuse, const RunContext& context);

/// Whether an error is about the surface itself, so that repair or wrap may help.
bool is_about_surface(const Error& error);

}  // namespace sterna::scripting
