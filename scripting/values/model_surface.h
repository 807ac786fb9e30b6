// The surface of models as a triangulation: shared by surface_mesh{}, `sterna surface` and `sterna mesh model.step`.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/cad/read_cad.h"
#include "scripting/cache/reuse.h"
#include "scripting/values/models.h"
#include "scripting/values/verbs.h"
#include "surfmesh/model/surface_forecast.h"

namespace sterna::scripting {

/// Meshes the models, side by side if there are several. The log reports the result: triangles, patches, if the surface is closed or where it is open, the
/// worst angle with its face, absorbed parts, and crossings (as a warning). Patches have the faces' names. Triangle settings of components in .smx files
/// (maxlen, minlen, maxphi other than sumo's 30 degrees, lerfactor, terfactor) are rules that come before the recipe's, unless they have defaults="true".
/// `size`: lengths of edges by location, called by this thread only.
/// \throws Error of surfmesh::mesh_model, also Error(bad_argument) for a source that volmesh::problem_of rejects
SurfaceValue mesh_models(const std::vector<ModelHandle>& models, const SurfaceRecipe& recipe, const std::function<double(const Point&)>& size,
                         const RunContext& context, const Reuse& reuse = {});

/// Reads files of models and meshes their surface. Components of .smx and CPACS files are united first; CAD is unchanged. `reading` applies to CAD.
/// \p periodic: pairs of sides of the volume; pairs of faces of the models go into the recipe
/// \throws Error of read_model, unite_solids, mesh_models; bad_argument for a file that is no model
SurfaceValue mesh_model_files(std::span<const InputPath> files, const ReadCadOptions& reading, const SurfaceRecipe& recipe, const RunContext& context,
                              const Reuse& reuse = {}, std::span<const PeriodicNames> periodic = {});

/// Models as read from files, before their surface is meshed.
struct ModelsOfFiles {
  std::vector<ModelHandle> models;
  SurfaceRecipe recipe;  ///< with the settings of the files
};
/// Reads the models: the first half of mesh_model_files().
ModelsOfFiles read_model_files(std::span<const InputPath> files, const ReadCadOptions& reading, const SurfaceRecipe& recipe, const RunContext& context,
                               std::span<const PeriodicNames> periodic = {});
/// Meshes the models: the second half of mesh_model_files().
SurfaceValue mesh_model_files(const ModelsOfFiles& files, const RunContext& context, const Reuse& reuse = {});

/// Returns the expected number of triangles of the surface, with all models at their locations.
/// \throws Error of surfmesh::forecast_surface
surfmesh::SurfaceForecast forecast_models(const std::vector<ModelHandle>& models, const SurfaceRecipe& recipe, const RunContext& context);

/// Returns several lines: the report of the mesher, open locations of the surface and absorbed parts.
/// \pre surface.mesh_report
std::string surface_mesh_text(const Model& model, const SurfaceValue& surface);

/// Returns the sizes imposed by the recipe's sources and a function of the location.
/// \throws Error(bad_argument) for a source that volmesh::problem_of rejects
surfmesh::SpaceSizes space_sizes(const SurfaceRecipe& recipe, const std::function<double(const Point&)>& size);

/// Returns the same options, with those of bands in separate stages: leading_edge = { chordwise = 0.004 } stands for leading_edge_chordwise.
OptionTable with_edge_tables(OptionTable table);

/// Returns the options of `sterna surface`, and of `sterna mesh` of a model, except those of the volume. The arguments must outlive the table.
OptionTable model_surface_options(surfmesh::SurfaceMeshOptions& surface, ReadCadOptions& reading);

}  // namespace sterna::scripting
