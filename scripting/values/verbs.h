// The work behind both the Lua verbs and the command line: values that can be printed, checked, written and fed to the next verb.
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
#include "volmesh/case/patch_rule.h"
#include "volmesh/case/placed_part.h"
#include "volmesh/volume_mesh.h"

namespace sterna::scripting {

/// A file that went into a result, for its manifest.
struct InputFile {
  std::string name;  ///< as the user wrote it
  std::string hash;  ///< io::hash_input
};

/// What surface_mesh was asked for.
struct SurfaceRecipe {
  surfmesh::SurfaceMeshOptions options;
  std::vector<surfmesh::PatchSurfaceOptions> patches;  ///< the last that matches a face counts
  std::vector<volmesh::SizeSource> sources;            ///< in space
  std::string sources_text;                            ///< the same, and whether there was a function, as JSON: what manifests keep; empty for none
};

/// A surface with where it came from.
struct SurfaceValue {
  TriMesh mesh;
  surfmesh::StitchReport report;
  surfmesh::StitchOptions options;
  std::vector<InputFile> inputs;
  std::optional<UnionOptions> union_options = {};               ///< of a surface that union made
  std::optional<surfmesh::RepairOptions> repair_options = {};   ///< of a surface that repair looked at
  std::optional<surfmesh::WrapOptions> wrap_options = {};       ///< of a surface that wrap made
  std::optional<surfmesh::RemeshOptions> remesh_options = {};   ///< of a surface whose triangles remesh made
  std::optional<SurfaceRecipe> recipe = {};                     ///< of a surface that surface_mesh made
  std::optional<surfmesh::SurfaceMeshReport> mesh_report = {};  ///< the same, unless it was read from a file
  std::optional<double> smooth_angle = {};  ///< rad, the same or as the manifest beside the file says: the largest turn where the surface is smooth
  std::vector<volmesh::PatchRule> layers =
      {};  ///< what the model's makers said of the layer on patches, in order: the last of a name counts, the user's own come after
  std::shared_ptr<const surfmesh::ModelWall> model_wall = {};  ///< of a surface that surface_mesh made in this run: where new vertices belong
  std::vector<volmesh::PlacedPart> parts = {};    ///< that were meshed or read elsewhere and moved to where they are; in ascending order of their triangles
  std::optional<ContentKey> model_wall_key = {};  ///< of what model_wall knows, for caches
  std::vector<std::string> changes = {};          ///< what makes it another surface than the files: one sentence each, first in summaries and manifests
  std::vector<std::string> changed = {};          ///< figures before and after each step that changed it, JSON objects (geom/mesh/compare_geometry.h)
};

/// How a volume mesh was made here; absent for one that was read from a file.
struct MeshOrigin {
  surfmesh::StitchOptions surface_options;
  std::optional<UnionOptions> union_options;
  std::optional<surfmesh::RepairOptions> repair_options;
  std::optional<surfmesh::WrapOptions> wrap_options;
  std::optional<surfmesh::RemeshOptions> remesh_options;
  std::optional<SurfaceRecipe> recipe;
  std::optional<double> smooth_angle;  ///< of the wall
  volmesh::MeshCase options;
  volmesh::LayerReport layer;
  volmesh::EnvelopeCertificate certificate;
  std::int64_t n_wall_triangles = 0;
  volmesh::ImproveReport improvement;
  std::string tetra_engine;
  std::vector<std::string> tetra_failures;
  std::string tetra_choice;  ///< VolumeMeshResult::tetra_choice
  std::int64_t n_split_triangles = 0;
  volmesh::NeedleReport needles;
  std::vector<std::string> changes;  ///< of the wall
  std::vector<std::string> changed;  ///< of the wall
  bool is_reproducible = true;
  double tetra_engine_seconds = 0.0;
  double tetra_engine_peak_bytes = 0.0;
};

struct MeshValue {
  HybridMesh mesh;
  std::vector<InputFile> inputs;
  std::optional<MeshOrigin> origin;
  mutable std::optional<CheckReport> check;  ///< of the default options, always there for a mesh made here; then of the last whole check that was asked for, so
                                             ///< that manifests and reports say what that found
  std::set<std::string> unknown_kinds = {};  ///< patches of a file of which neither it, nor a manifest, nor their name says what they are
};

/// Reads the files and joins them to one surface; manifests beside them say how far smooth places turn.
/// \throws Error of io and of surfmesh::stitch_surface.
SurfaceValue read_wall(std::span<const InputPath> files, const surfmesh::StitchOptions& options, const RunContext& context);

/// What union takes: a surface that was read, or a file, whose closed components may cross each other.
using UnionItem = std::variant<SurfaceHandle, InputPath>;
/// Files are read with `unit` (m). Parts have the names of their files.
/// \throws Error of read_wall and of unite_meshes.
SurfaceValue unite_surfaces(std::span<const UnionItem> items, double unit, const UnionOptions& options, const RunContext& context);

/// Reads a volume mesh, with what the manifest beside it knows (mesh_manifest.h); patches whose kind nothing says are a warning. Every command and verb that
/// takes a volume mesh reads it here. `incomplete`: what happens to boundary faces that the file lacks.
/// \throws Error of io, file_malformed of a manifest.
MeshValue read_mesh(const InputPath& file, const RunContext& context, io::Incomplete incomplete = io::Incomplete::kept);

/// \throws Error unsupported_format or write_failed when a mesh of this name cannot be written: unknown extension, no such folder. Before the work.
void require_mesh_output(const std::filesystem::path& path);

/// Writes the mesh and, once that is done, its manifest "<path>.json"; a .sterna file holds manifest, certificate and quality, too. Each file appears whole or
/// not at all. A .sterna file keeps the numbers of nodes and cells, whatever the options say.
/// \throws Error of io.
void write_mesh(const MeshValue& mesh, const std::filesystem::path& path, const WriteOptions& options, const RunContext& context);

/// A mesh without a manifest, in a format by its name in the table, or by the extension where that is empty.
/// \throws Error of io.
void write_mesh_alone(const HybridMesh& mesh, const std::filesystem::path& path, std::string_view format, const WriteOptions& options,
                      const RunContext& context);

/// \throws Error unsupported_format or write_failed when a surface cannot be written to a file of this name. Before the work.
void require_surface_output(const std::filesystem::path& path);
/// Writes a surface; format by extension; also its manifest "<path>.json" where there is something that the format cannot hold (has_surface_manifest).
/// \throws Error of io.
void write_surface(const SurfaceValue& surface, const std::filesystem::path& path, const RunContext& context);

/// The options of reading a surface and of all stages of the volume mesh, for `--set stage.option=value`. The arguments must outlive the table.
OptionTable all_options(surfmesh::StitchOptions& surface, volmesh::MeshCase& volume);

}  // namespace sterna::scripting
