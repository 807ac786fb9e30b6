// The inspection of files and surfaces, and its reports as text, as JSON, and as a picture.
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

/// The expected result of volume_mesh for a surface, and the steps required before.
struct Inspection : volmesh::InspectReport {
  Preparation preparation;
  std::optional<double> expected_triangles;  ///< predicted number of triangles of the model's surface
  std::optional<double> remeshed_triangles;  ///< predicted number of new triangles, if remesh is advised
};

/// What a caller does with the surface before it is inspected.
struct BeforeInspection {
  std::function<SurfaceValue(const SurfaceValue&, const RunContext&)> cut;                          ///< a change of the surface (half); may be empty
  std::function<void(SurfaceValue&, volmesh::MeshCase&, const RunContext&)> complete_options = {};  ///< options that depend on the surface; may be empty
};

/// Reads the files and joins them as read_surface does. Errors of reading or joining become findings, and as much as possible is still inspected. The rules of
/// manifests beside the files come before those of the request.
/// \throws Error of io (no such file, no such format), cancelled
Inspection inspect_files(std::span<const InputPath> files, const surfmesh::StitchOptions& options, volmesh::InspectRequest request, const RunContext& context,
                         const BeforeInspection& before = {});
/// Meshes the models' faces as mesh_model_files does, and inspects that surface. If meshing fails, inspects their triangles including the crossings.
/// \throws Error of reading models and of options; of meshing only if the error is not about the surface; cancelled
Inspection inspect_models(std::span<const InputPath> files, const ReadCadOptions& reading, const SurfaceRecipe& recipe, volmesh::InspectRequest request,
                          const RunContext& context, const BeforeInspection& before = {});
/// \throws Error(cancelled)
Inspection inspect_surface(const SurfaceValue& surface, volmesh::InspectRequest request, const RunContext& context);

/// Returns several lines: the surface, the verdict, the prediction, each finding with its locations and its advice, and the recommended first step.
std::string text_of(const Inspection& report, const std::string& name);
/// Returns the same report as JSON, schema "sterna-inspect-1".
std::string json_of(const Inspection& report, const std::string& name);

/// Writes a picture of the inspection. For "-o trouble.vtu" this is the surface with all fields. For "-o trouble.png" it is a picture of the surface, coloured
/// by the most severe finding, with the worst location of each finding marked.
/// \throws Error(unsupported_format) for another extension, Error(write_failed)
void write_inspection(const volmesh::InspectReport& report, const std::filesystem::path& path, const RunContext& context);
/// Checks the output path before the work starts.
/// \throws as write_inspection
void require_inspection_output(const std::filesystem::path& path);

}  // namespace sterna::scripting
