// The manifest beside a surface that surface_mesh made: what it was made of and how good it is, and what a later run can know of it.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Schema sterna-surface-1: inputs with hashes, options, patches, sizes, quality with worst places (angles in degrees, as in reports), the hash of `written`.
/// Quality is that of surface_mesh; without it the largest turn alone, where it is known. \pre `written` is the finished file.
/// \throws Error of io
std::string surface_manifest_json(const SurfaceValue& surface, const std::filesystem::path& written);

/// Whether there is something that the surface's file cannot hold: quality, kinds of patches, rules for layers, what was changed.
bool has_surface_manifest(const SurfaceValue& surface);

/// Writes it as "<written>.json".
void write_surface_manifest(const SurfaceValue& surface, const std::filesystem::path& written);

/// What the manifest beside a surface file knows of it.
struct KnownSurface {
  std::optional<double> smooth_angle;      ///< rad: SurfaceMeshReport::max_smooth_angle
  std::map<std::string, PatchKind> kinds;  ///< of its patches by name: surface formats do not hold them
  bool encloses_fluid = false;             ///< its outermost part has normals inwards
  std::vector<volmesh::PatchRule> layers;  ///< SurfaceValue::layers
  std::vector<std::string> changes;        ///< SurfaceValue::changes
  std::vector<std::string> changed;        ///< SurfaceValue::changed
};
/// Nothing where there is none, or where it is of another state of the file (`hash` differs), which is a warning.
/// \throws Error(file_malformed) where it is ours but its contents are not as they must be
std::optional<KnownSurface> read_surface_manifest(const InputPath& file, const std::string& hash, const RunContext& context);

/// Kinds by names of patches; names that are not among them keep theirs.
void set_kinds(Column<PatchId, Patch>& patches, const std::map<std::string, PatchKind>& kinds);

}  // namespace sterna::scripting
