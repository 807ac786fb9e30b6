// The inspection of files and surfaces, and how it is told: as text, as JSON, as a picture.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "geom/cad/read_cad.h"
#include "scripting/values/preparation.h"
#include "scripting/values/verbs.h"
#include "volmesh/inspect/inspect.h"

namespace sterna::scripting {

/// What volume_mesh will make of it, and what it needs before.
struct Inspection : volmesh::InspectReport {
  Preparation preparation;
  std::optional<double> expected_triangles;  ///< of the model's surface, predicted before it was meshed
  std::optional<double> remeshed_triangles;  ///< of the new triangles where remesh is advised, predicted
};

using SurfaceChange = std::function<SurfaceValue(const SurfaceValue&, const RunContext&)>;

/// Reads the files and joins them as read_surface does; what that refuses is a finding, and as much as can be is looked at all the same. The rules of manifests
/// beside the files come before those of the request.
/// \throws Error of io (no such file, no such format), cancelled
/// \param cut where it is given: what is done to the surface before (half)
Inspection inspect_files(std::span<const InputPath> files, const surfmesh::StitchOptions& options, volmesh::InspectRequest request, const RunContext& context,
                         const SurfaceChange& cut = {});
/// Meshes the models' faces as mesh_model_files does, and inspects that surface; where that refuses them, their triangles with what crosses.
/// \throws Error of reading models and of options; of meshing them only where it is not about the surface; cancelled
Inspection inspect_models(std::span<const InputPath> files, const ReadCadOptions& reading, const SurfaceRecipe& recipe, volmesh::InspectRequest request,
                          const RunContext& context, const SurfaceChange& cut = {});
/// \throws Error(cancelled)
Inspection inspect_surface(const SurfaceValue& surface, volmesh::InspectRequest request, const RunContext& context);

/// Several lines: the surface, the verdict, the prediction, each finding with its places and its advice, what to do first.
std::string text_of(const Inspection& report, const std::string& name);
/// The same, schema "sterna-inspect-1".
std::string json_of(const Inspection& report, const std::string& name);

/// "-o trouble.vtu": the surface with all fields; "-o trouble.png": a picture of it, by the most severe finding, with the worst place of each marked.
/// \throws Error(unsupported_format) for another extension, Error(write_failed)
void write_inspection(const volmesh::InspectReport& report, const std::filesystem::path& path, const RunContext& context);
/// The same before the work.
/// \throws as write_inspection
void require_inspection_output(const std::filesystem::path& path);

}  // namespace sterna::scripting
