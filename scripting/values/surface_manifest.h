// The manifest beside a surface written by surface_mesh: its inputs, its quality, and the facts that a later run can use.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Returns the manifest, schema sterna-surface-1: inputs with hashes, options, patches, sizes, quality with worst locations (angles in degrees, as in reports),
/// and the hash of `written`. Quality is that of surface_mesh; other surfaces have only the largest turn, if known. \pre `written` is the finished file
/// \throws Error of io
std::string surface_manifest_json(const SurfaceValue& surface, const std::filesystem::path& written);

/// Returns true if there are data that the surface's file cannot hold: quality, kinds of patches, rules for layers, changes.
bool has_surface_manifest(const SurfaceValue& surface);

/// Writes the manifest as "<written>.json".
void write_surface_manifest(const SurfaceValue& surface, const std::filesystem::path& written);

/// The content of the manifest beside a surface file.
struct KnownSurface {
  std::optional<double> smooth_angle;      ///< rad: SurfaceMeshReport::max_smooth_angle
  std::map<std::string, PatchKind> kinds;  ///< kinds of its patches by name: surface formats do not hold them
  bool encloses_fluid = false;             ///< the outermost part of the surface has inward normals
  std::vector<Rule> layers;                ///< SurfaceValue::layers
  SurfaceHistory history;                  ///< changes and figures of SurfaceValue::history
};
/// Reads the manifest. Returns nothing if there is none. Returns nothing, with a warning, if it belongs to another state of the file (`hash` differs).
/// \throws Error(file_malformed) if the manifest is of sterna but its contents are invalid
std::optional<KnownSurface> read_surface_manifest(const InputPath& file, const std::string& hash, const RunContext& context);

/// Sets kinds by names of patches. Patches that are not in `kinds` keep their kind.
void set_kinds(Column<PatchId, Patch>& patches, const std::map<std::string, PatchKind>& kinds);

}  // namespace sterna::scripting
