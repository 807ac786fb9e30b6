// Compares a surface before and after a step that may change it: patches, parts, area, enclosed volume and box. What is missing or differs by more than 0.1 %
// is named, so that no geometry is lost without a warning.
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
  std::optional<double> volume;  ///< m^3, magnitude of the signed volume; nothing unless all parts are closed
  std::int64_t n_parts = 0;      ///< parts connected over edges of two facets
  std::int64_t n_closed = 0;     ///< parts without an open edge
  Box box;                       ///< m
};

struct PatchChange {
  std::string name;
  double before = 0.0, after = 0.0;  ///< m^2
};

struct PartChange {
  std::string name;     ///< of the patch that has most of its area; with the place where several parts have the same
  Point place;          ///< m, middle of its box
  double area = 0.0;    ///< m^2
  double volume = 0.0;  ///< m^3, magnitude; 0: the part is open
};

/// Differences of two states of a surface. "Missing" is what the first has and the second has not.
struct GeometryChange {
  std::string by;  ///< the step: "repair", "wrap", "union"
  GeometryFigures before, after;
  std::vector<PatchChange> missing_patches;           ///< by falling area
  std::vector<PatchChange> changed_patches;           ///< more than k_reported_change, by falling difference; not those that are missing
  std::vector<PartChange> missing_parts;              ///< none of the result is near; by falling area
  std::vector<std::vector<PartChange>> joined_parts;  ///< several closed parts that are one part of the result
  std::vector<PartChange> divided_parts;              ///< closed parts that are several parts of the result
  bool is_area_changed() const;
  bool is_volume_changed() const;
  bool is_box_changed() const;
  /// Nothing is missing, no area, volume, patch or box differs by more than k_reported_change, and parts are as before.
  bool is_small() const;
};

/// Compares a surface as it was, perhaps torn (facets in any sense, edges with any number of facets; vertices at equal places are one vertex), with the surface
/// made of it. Patches correspond by name; "wing_1", "wing_2" of the result stand for "wing" where it was split. Areas of the result that fill holes count for
/// the patch whose name they have.
/// \throws Error(cancelled)
GeometryChange compare_geometry(const TriMesh& before, const TriMesh& after, std::string by, const RunContext& context);

enum class GeometryChangeUse : std::uint8_t {
  keeps_shape,    ///< any difference in area or volume is worth a warning
  unites_bodies,  ///< the step removes what lies inside of other bodies: area and volume become smaller, within what a union can give
};

/// Sentences for warnings, in plain words with figures; at most the worst three patches and parts are named in each. Empty where nothing is to be warned of.
std::vector<std::string> warnings_of(const GeometryChange& change, GeometryChangeUse use = GeometryChangeUse::keeps_shape);

/// One line: "area 1 -> 0.99 m2 (-1 %), volume ..., 3 -> 2 parts".
std::string to_text(const GeometryChange& change);

/// A JSON object for manifests.
std::string to_json(const GeometryChange& change);

}  // namespace sterna
