// Compares a surface before and after a step that may change it: patches, parts, area, enclosed volume and box. Everything that is missing or differs by more
// than 0.1 % is named, so that no geometry is lost without a warning.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

/// Relative change of an area or a volume, and change of the box over its longest side, above which a change is reported.
inline constexpr double k_reported_change = 1e-3;

struct GeometryFigures {
  double area = 0.0;             ///< m^2
  std::optional<double> volume;  ///< m^3, magnitude of the signed volume; empty unless all parts are closed
  std::int64_t n_parts = 0;      ///< parts connected over edges of two facets
  std::int64_t n_closed = 0;     ///< parts without an open edge
  Box box;                       ///< m
};

struct PatchChange {
  std::string name;
  double before = 0.0, after = 0.0;  ///< m^2
};

struct PartChange {
  std::string name;     ///< name of the patch with most of the part's area; with the location if several parts have the same name
  Point location;       ///< m, centre of its box
  double area = 0.0;    ///< m^2
  double volume = 0.0;  ///< m^3, magnitude; 0: the part is open
};

/// Differences between two states of a surface. "Missing" parts are present before and absent after.
struct GeometryChange {
  std::string by;  ///< name of the step: "repair", "wrap", "union"
  GeometryFigures before, after;
  std::vector<PatchChange> missing_patches;           ///< by descending area
  std::vector<PatchChange> changed_patches;           ///< more than k_reported_change, by descending difference; without missing patches
  std::vector<PartChange> missing_parts;              ///< no part of the result is near; by descending area
  std::vector<std::vector<PartChange>> joined_parts;  ///< several closed parts that are one part of the result
  std::vector<PartChange> divided_parts;              ///< closed parts that are several parts of the result
  bool is_area_changed() const;
  bool is_volume_changed() const;
  bool is_box_changed() const;
  /// Returns true if nothing is missing, no area, volume, patch or box differs by more than k_reported_change, and the parts are unchanged.
  bool is_small() const;
};

/// Compares an original surface with the surface derived from it. The original may be torn (facets in any sense, edges with any number of facets; vertices at
/// equal locations are one vertex). Patches correspond by name; "wing_1", "wing_2" of the result correspond to "wing" if it was split. Areas of the result
/// that fill holes count for the patch whose name they carry.
/// \throws Error(cancelled)
GeometryChange compare_geometry(const TriMesh& before, const TriMesh& after, std::string by, const RunContext& context);

enum class GeometryChangeUse : std::uint8_t {
  keeps_shape,    ///< any difference in area or volume causes a warning
  unites_bodies,  ///< the step removes parts inside other bodies: area and volume may decrease, within the range that a union can produce
};

/// Returns sentences for warnings with figures; names at most the worst three patches and parts in each. Empty if no warning is needed.
std::vector<std::string> warnings_of(const GeometryChange& change, GeometryChangeUse use = GeometryChangeUse::keeps_shape);

/// Returns one line: "area 1 -> 0.99 m2 (-1 %), volume ..., 3 -> 2 parts".
std::string to_text(const GeometryChange& change);

/// Returns a JSON object for manifests.
std::string to_json(const GeometryChange& change);

}  // namespace sterna
