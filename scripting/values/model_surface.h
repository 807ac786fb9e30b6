// The surface of models as a triangulation: what surface_mesh{}, `sterna surface` and `sterna mesh model.step` share.
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

/// Meshes the models, side by side where there are several. The log says what was made: triangles, patches, closed or open and where, the worst angle with its
/// face, absorbed parts, crossings (a warning). Patches have the faces' names.
/// \throws Error of surfmesh::mesh_model What .smx files say of their components' triangles (maxlen, minlen, maxphi other than sumo's 30 degrees, lerfactor,
/// terfactor; not where defaults="true") counts as rules before the recipe's. `size`: lengths of edges by place, called by this thread alone.
/// \throws also Error(bad_argument) for a source that volmesh::problem_of objects to
SurfaceValue mesh_models(const std::vector<ModelHandle>& models, const SurfaceRecipe& recipe, const std::function<double(const Point&)>& size,
                         const RunContext& context, const Reuse& reuse = {});

/// Reads files of models and meshes their surface. Components of .smx and CPACS files are united first; CAD stays as it is. `reading` counts for CAD.
/// \p periodic: pairs of sides of the volume; those that are faces of the models go into the recipe.
/// \throws Error of read_model, unite_solids, mesh_models; bad_argument for a file that is no model
SurfaceValue mesh_model_files(std::span<const InputPath> files, const ReadCadOptions& reading, const SurfaceRecipe& recipe, const RunContext& context,
                              const Reuse& reuse = {}, std::span<const volmesh::PeriodicNames> periodic = {});

/// Models as files have them, before their surface is meshed.
struct ModelsOfFiles {
  std::vector<ModelHandle> models;
  SurfaceRecipe recipe;  ///< with what the files say
};
/// The first half of mesh_model_files().
ModelsOfFiles read_model_files(std::span<const InputPath> files, const ReadCadOptions& reading, const SurfaceRecipe& recipe, const RunContext& context,
                               std::span<const volmesh::PeriodicNames> periodic = {});
/// The second half.
SurfaceValue mesh_model_files(const ModelsOfFiles& files, const RunContext& context, const Reuse& reuse = {});

/// The number of triangles that their surface will have, all models where they are.
/// \throws Error of surfmesh::forecast_surface
surfmesh::SurfaceForecast forecast_models(const std::vector<ModelHandle>& models, const SurfaceRecipe& recipe, const RunContext& context);

/// Several lines: the report of the mesher with the places where the surface is open and what was absorbed.
/// \pre surface.mesh_report
std::string surface_mesh_text(const Model& model, const SurfaceValue& surface);

/// What the recipe's sources and a function by place ask for.
/// \throws Error(bad_argument) for a source that volmesh::problem_of objects to
surfmesh::SpaceSizes space_sizes(const SurfaceRecipe& recipe, const std::function<double(const Point&)>& size);

/// The same options, those of bands in stages of their own: leading_edge = { chordwise = 0.004 } is leading_edge_chordwise.
OptionTable with_edge_tables(OptionTable table);
/// What one entry of patches = { ["wing*"] = { max_edge = 0.1 } } takes. `rule` must outlive the table.
OptionTable patch_rule_options(surfmesh::PatchSurfaceOptions& rule);
/// A list of objects with the options that each rule sets, for manifests; and back.
/// \throws Error(file_malformed, bad_argument)
std::string patch_rules_json(const std::vector<surfmesh::PatchSurfaceOptions>& rules);
std::vector<surfmesh::PatchSurfaceOptions> patch_rules_of_json(const std::string& text);
/// Sources of a size field as a JSON list, for manifests; samples by their number only. Empty: there is nothing.
std::string sources_text(const std::vector<volmesh::SizeSource>& sources, bool has_function);

}  // namespace sterna::scripting
