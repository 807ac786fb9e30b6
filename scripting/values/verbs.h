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
#include "scripting/values/surface_history.h"
#include "scripting/values/write_options.h"
#include "surfmesh/model/model_wall.h"
#include "surfmesh/stitch/stitch_surface.h"
#include "volmesh/case/layer_rules.h"
#include "volmesh/case/placed_part.h"
#include "volmesh/volume_mesh.h"

namespace sterna::scripting {

/// An input file of a result, for its manifest.
struct InputFile {
  std::string name;  ///< as the user wrote it
  std::string hash;  ///< io::hash_input
};

/// The exact surface behind a mesh of surface_mesh.
struct TrueSurface {
  std::shared_ptr<const surfmesh::ModelWall> wall = {};  ///< gives the positions of new vertices; null: unknown
  std::optional<ContentKey> key = {};                    ///< key of its data, for caches
};

/// A surface with its history and with facts that later steps use.
struct SurfaceValue {
  TriMesh mesh;
  surfmesh::StitchReport report;
  surfmesh::StitchOptions options;
  std::vector<InputFile> inputs;
  SurfaceHistory history = {};
  std::optional<surfmesh::SurfaceMeshReport> mesh_report = {};  ///< set for a surface made by surface_mesh, unless it was read from a file
  std::optional<double> smooth_angle = {};  ///< rad; largest turn where the surface is smooth, from surface_mesh or from the manifest beside the file
  std::vector<Rule> layers =
      {};  ///< layer rules for patches, set by the makers of the model, in order. The last rule for a name applies, and the user's own rules come after these
  TrueSurface true_surface = {};                ///< set for a surface made by surface_mesh in this run
  std::vector<volmesh::PlacedPart> parts = {};  ///< parts meshed or read elsewhere and moved to their locations; in ascending order of their triangles
};

/// Replaces the mesh of a surface, and drops the data that refer to its former triangles: report of the mesher, positions on the model, placed parts.
void replace_mesh(SurfaceValue& surface, TriMesh mesh);

/// Describes how a volume mesh was made in this run. Absent for a mesh that was read from a file.
struct MeshOrigin {
  surfmesh::StitchOptions surface_options;
  SurfaceHistory history;              ///< history of the wall
  std::optional<double> smooth_angle;  ///< smooth angle of the wall
  volmesh::MeshCase options;           ///< its patch rules include those of the wall
  std::int64_t n_wall_triangles = 0;
  volmesh::VolumeMeshReport report;
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
