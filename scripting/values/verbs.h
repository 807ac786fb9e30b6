// The functions behind both the Lua verbs and the command line. Their values can be printed, checked, written and passed to the next verb.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/boolean/union_meshes.h"
#include "geom/mesh/check.h"
#include "io/file/volume_file.h"
#include "scripting/cache/provenance.h"
#include "scripting/lua/handles.h"
#include "scripting/lua/input_path.h"
#include "scripting/values/write_options.h"
#include "surfmesh/model/model_wall.h"
#include "surfmesh/model/surface_mesh.h"
#include "surfmesh/remesh/remesh_surface.h"
#include "surfmesh/repair/repair_surface.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "surfmesh/wrap/wrap_surface.h"
#include "volmesh/case/layer_rules.h"
#include "volmesh/case/placed_part.h"
#include "volmesh/volume_mesh.h"

namespace sterna::scripting {

/// An input file of a result, for its manifest.
struct InputFile {
  std::string name;  ///< as the user wrote it
  std::string hash;  ///< io::hash_input
};

/// The request to surface_mesh.
struct SurfaceRecipe {
  surfmesh::SurfaceMeshOptions options;
  std::vector<Rule> patches;                 ///< rules of faces; the last rule that matches a face applies
  std::vector<volmesh::SizeSource> sources;  ///< sources in space
  std::string sources_text;                  ///< JSON of the sources, and if there was a function, for manifests; empty if there is neither
};

/// A surface with its origin.
struct SurfaceValue {
  TriMesh mesh;
  surfmesh::StitchReport report;
  surfmesh::StitchOptions options;
  std::vector<InputFile> inputs;
  std::optional<UnionOptions> union_options = {};               ///< set for a surface made by union
  std::optional<surfmesh::RepairOptions> repair_options = {};   ///< set for a surface processed by repair
  std::optional<surfmesh::WrapOptions> wrap_options = {};       ///< set for a surface made by wrap
  std::optional<surfmesh::RemeshOptions> remesh_options = {};   ///< set for a surface whose triangles were made by remesh
  std::optional<SurfaceRecipe> recipe = {};                     ///< set for a surface made by surface_mesh
  std::optional<surfmesh::SurfaceMeshReport> mesh_report = {};  ///< set for a surface made by surface_mesh, unless it was read from a file
  std::optional<double> smooth_angle = {};  ///< rad; largest turn where the surface is smooth, from surface_mesh or from the manifest beside the file
  std::vector<Rule> layers =
      {};  ///< layer rules for patches, set by the makers of the model, in order. The last rule for a name applies, and the user's own rules come after these
  std::shared_ptr<const surfmesh::ModelWall> model_wall = {};  ///< set for a surface made by surface_mesh in this run: gives the positions of new vertices
  std::vector<volmesh::PlacedPart> parts = {};    ///< parts meshed or read elsewhere and moved to their locations; in ascending order of their triangles
  std::optional<ContentKey> model_wall_key = {};  ///< key of the data of model_wall, for caches
  std::vector<std::string> changes = {};          ///< differences from the surface of the files, one sentence each; they come first in summaries and manifests
  std::vector<std::string> changed = {};          ///< figures before and after each step that changed the surface, as JSON objects
                                                  ///< (geom/mesh/compare_geometry.h)
};

/// Replaces the mesh of a surface, and drops the data that refer to its former triangles: report of the mesher, positions on the model, placed parts.
void replace_mesh(SurfaceValue& surface, TriMesh mesh);

/// Describes how a volume mesh was made in this run. Absent for a mesh that was read from a file.
struct MeshOrigin {
  surfmesh::StitchOptions surface_options;
  std::optional<UnionOptions> union_options;
  std::optional<surfmesh::RepairOptions> repair_options;
  std::optional<surfmesh::WrapOptions> wrap_options;
  std::optional<surfmesh::RemeshOptions> remesh_options;
  std::optional<SurfaceRecipe> recipe;
  std::optional<double> smooth_angle;  ///< smooth angle of the wall
  volmesh::MeshCase options;
  volmesh::LayerReport layer;
  volmesh::EnvelopeCertificate certificate;
  std::int64_t n_wall_triangles = 0;
  volmesh::ImproveReport improvement;
  std::string tetra_engine;
  std::vector<std::string> tetra_failures;
  std::string tetra_choice;  ///< VolumeMeshResult::tetra_choice
  std::int64_t n_split_triangles = 0;
  volmesh::SliverReport slivers;
  std::vector<std::string> changes;  ///< changes of the wall
  std::vector<std::string> changed;  ///< changed figures of the wall
  bool is_reproducible = true;
  double tetra_engine_seconds = 0.0;
  double tetra_engine_peak_bytes = 0.0;
};

struct MeshValue {
  HybridMesh mesh;
  std::vector<InputFile> inputs;
  std::optional<MeshOrigin> origin;
  mutable std::optional<CheckReport> check;  ///< report of a check. For a mesh made here it is always present, with the default options. A complete check that
                                             ///< is requested later replaces it, so that manifests and reports have its findings
  std::set<std::string> unknown_kinds = {};  ///< patches of a file whose kind is given neither by the file, nor by a manifest, nor by their name
};

/// Reads the files and joins them to one surface; manifests beside the files give the largest turn in smooth regions.
/// \throws Error of io and of surfmesh::stitch_surface.
SurfaceValue read_wall(std::span<const InputPath> files, const surfmesh::StitchOptions& options, const RunContext& context);

/// Input of union: a surface that was read, or a file, whose closed components may cross each other.
using UnionItem = std::variant<SurfaceHandle, InputPath>;
/// Unites the items. Files are read with `unit` (m). Parts have the names of their files.
/// \throws Error of read_wall and of unite_meshes.
SurfaceValue unite_surfaces(std::span<const UnionItem> items, double unit, const UnionOptions& options, const RunContext& context);

/// Reads a volume mesh, with the data of the manifest beside it (mesh_manifest.h). Patches of unknown kind give a warning. Every command and verb that takes a
/// volume mesh reads it here. `incomplete` decides how boundary faces that the file lacks are treated.
/// \throws Error of io, file_malformed of a manifest.
MeshValue read_mesh(const InputPath& file, const RunContext& context, io::Incomplete incomplete = io::Incomplete::kept);

/// Checks the output path before the work starts.
/// \throws Error unsupported_format or write_failed if a mesh of this name cannot be written: unknown extension, no such folder
void require_mesh_output(const std::filesystem::path& path);

/// Writes the mesh and then its manifest "<path>.json". A .sterna file also holds manifest, certificate and quality. Each file is written atomically. A .sterna
/// file keeps the numbers of nodes and cells, regardless of the options.
/// \throws Error of io.
void write_mesh(const MeshValue& mesh, const std::filesystem::path& path, const WriteOptions& options, const RunContext& context);

/// Writes a mesh without a manifest, in a format by its name in the table, or by the extension if the name is empty.
/// \throws Error of io.
void write_mesh_alone(const HybridMesh& mesh, const std::filesystem::path& path, std::string_view format, const WriteOptions& options,
                      const RunContext& context);

/// Checks the output path before the work starts.
/// \throws Error unsupported_format or write_failed if a surface cannot be written to a file of this name
void require_surface_output(const std::filesystem::path& path);
/// Writes a surface in the format given by the extension. Also writes its manifest "<path>.json" if there are data that the format cannot hold
/// (has_surface_manifest).
/// \throws Error of io.
void write_surface(const SurfaceValue& surface, const std::filesystem::path& path, const RunContext& context);

/// Returns the options of reading a surface and of all stages of the volume mesh, for `--set stage.option=value`. The arguments must outlive the table.
OptionTable all_options(surfmesh::StitchOptions& surface, volmesh::MeshCase& volume);

}  // namespace sterna::scripting
