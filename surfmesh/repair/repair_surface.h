// Repairs a surface with holes, seams, crossings, baffles and inner walls so that it can be meshed, with as few changes as possible. All changes are reported.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"
#include "surfmesh/stitch/stitch_surface.h"

namespace sterna::surfmesh {

/// Lengths are fractions of the body length L (the longest side of the box), so the defaults fit any body.
struct RepairOptions {
  double gap = 1e-3;            ///< L; width of the widest seam that is closed; wider seams are treated as holes
  double hole = 0.3;            ///< L; diameter of the largest curved hole that is filled
  double flat_hole = 2.0;       ///< L; the same for holes with a flat boundary
  int hole_edges = 1000;        ///< number of edges of the largest hole that is filled
  double smallest_part = 1e-3;  ///< L; parts with a smaller box are dropped
  double sliver = 1e-7;         ///< L; shorter edges are collapsed where something was changed
  double largest_move = 0.01;   ///< L; largest movement of retained facets; a larger movement is an error
  std::string half = "automatic";
  double half_tolerance = 1e-3;  ///< L; largest distance of the boundary of a half model from its plane
  bool hull = true;
  int rounds = 6;
};

/// Kind of a local change. The values name what was changed.
enum class RepairKind {
  dropped,         ///< facets without area, duplicates, and doubled baffles removed
  welded,          ///< vertices merged that differ by rounding only
  zipped,          ///< a seam closed
  into_plane,      ///< the boundary of a half model moved into its plane
  filled,          ///< a hole filled
  cut,             ///< facets cut where they cross other facets
  removed_sheet,   ///< facets removed that have the fluid on both sides
  removed_inside,  ///< facets removed that have the fluid on neither side
  removed_part,    ///< a part removed because it is very small
  separated,       ///< vertices or edges split that had more than two facets or several fans
  joined,          ///< bodies joined that touched along edges, across the crevice between them
  collapsed,       ///< short edges collapsed
  replaced,        ///< crossing facets removed and the hole filled
  turned           ///< facets reversed that were oriented against the others
};
inline constexpr std::size_t k_repair_kinds = 14;
/// Returns the name of the kind, such as "filled" or "removed_sheet".
std::string_view to_string(RepairKind kind);

struct RepairChange {
  RepairKind kind = RepairKind::dropped;
  Vec3 position;              ///< m; centre of the changed region
  double size = 0.0;          ///< m; largest movement (welded, zipped, into_plane, separated, collapsed); for other kinds the diameter of the region
  std::int64_t n_facets = 0;  ///< number of facets added, removed, cut or moved
};

/// The changed and the removed facets, for drawing.
struct RepairDrawing {
  std::vector<Vec3> points;  ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> change;  ///< per triangle: index of its change in RepairReport::changes
};

/// The opening of a half model. Its boundary lies exactly in the plane.
struct HalfOpening {
  std::string axis;      ///< "x", "y" or "z"
  double at = 0.0;       ///< m
  bool is_above = true;  ///< the body is on the side of larger coordinates
  double off = 0.0;      ///< m; largest distance of the boundary from the plane before the repair
  std::int64_t n_vertices = 0;
};

struct RepairReport {
  StitchReport stitch;                ///< report on the result, which is verified by stitch_surface
  std::vector<RepairChange> changes;  ///< in chronological order; empty if the input was valid: then the result is bitwise identical
  std::optional<HalfOpening> half;
  double length = 0.0;       ///< m, body length L
  double moved = 0.0;        ///< m; largest distance of samples of retained facets from the input
  double from_result = 0.0;  ///< m; largest distance of samples of the result from the input; mostly at the middle of the largest filled hole
  double from_input = 0.0;   ///< m; largest distance of samples of the input from the result; largest where parts were removed
  double sampling = 0.0;     ///< m; sampling error: no point is farther than the distances above plus this value
  RepairDrawing drawing;
  std::vector<std::string> messages;  ///< one sentence for each kind of change, as written to the log

  std::int64_t count(RepairKind kind) const;
};

struct RepairResult {
  TriMesh mesh;
  RepairReport report;
};

/// Repairs a surface in these steps. (1) Weld vertices and drop facets (as stitch_surface does), drop small parts. (2) Zip seams with a growing tolerance,
/// including T-junctions. (3) Remove baffles. (4) Recognise the opening of a half model and move it into its plane. (5) Fill holes; holes with a flat boundary
/// are filled flat. (6) Cut crossings exactly and keep the outer hull (facets with the fluid on one side). (7) Separate vertices and edges in which the hull
/// touches itself; collapse short edges. (8) Replace facets that still cross after rounding by a filling, in growing rings. A surface that stitch_surface
/// accepts (without allow_open) is returned bitwise unchanged.
/// \post The result is closed, or its open boundary lies exactly in the plane of report.half. It is manifold, oriented and without crossings (verified by
/// stitch_surface). Facets have the patch of the nearest facet of the input.
/// \throws Error like stitch_surface for remaining defects, with locations and the next step to try; mesh_invalid if the surface would move by more than
/// allowed
RepairResult repair_surface(const std::vector<SurfaceSoup>& soups, const StitchOptions& stitching, const RepairOptions& options, const RunContext& context);

/// Diagnosis by the repair steps up to the filling of holes. Nothing is cut, no hull is taken, and nothing is verified.
struct RepairForecast {
  bool is_needed = false;        ///< false: stitch_surface accepts the surface, and the other members are empty
  std::string problem;           ///< error of stitch_surface, with its counts
  std::vector<Vec3> locations;   ///< m; locations of the first defects
  std::int64_t n_facets = 0;     ///< number of facets as read, with non-zero area
  double area = 0.0;             ///< m^2, total area of these facets
  double length = 0.0;           ///< m, body length
  std::int64_t n_changes = 0;    ///< number of changed regions in total; 0 for a half model with its boundary in the plane
  std::int64_t n_seams = 0;      ///< number of zipped seams
  std::int64_t n_sheets = 0;     ///< number of removed baffles
  std::int64_t n_holes = 0;      ///< number of filled holes
  std::int64_t n_fillings = 0;   ///< number of facets that fill them
  std::int64_t n_open = 0;       ///< number of openings that repair does not close, because they exceed its limits or are as large as the surface itself
  double widest_open = 0.0;      ///< m; diagonal of the box of the widest such opening
  Vec3 widest_location;          ///< m; middle of that opening
  std::int64_t n_crossings = 0;  ///< number of pairs of facets that cross or touch after these steps
  std::int64_t n_crowded = 0;    ///< number of edges with more than two facets after these steps
  std::optional<HalfOpening> half;
  bool is_enough = true;  ///< true if nothing stays open and crossings can be cut
};

/// Diagnoses a surface, mostly in a small fraction of the time of repair_surface. The repair itself may still fail if the hull leaks or if rounding leaves
/// crossings.
/// \throws Error like repair_surface for defects that cannot be repaired (file_malformed, empty_surface, bad_argument); cancelled
RepairForecast foresee_repair(const std::vector<SurfaceSoup>& soups, const StitchOptions& stitching, const RepairOptions& options, const RunContext& context);

}  // namespace sterna::surfmesh

namespace sterna {

template <>
struct Schema<surfmesh::RepairOptions> {
  using O = surfmesh::RepairOptions;
  static constexpr std::string_view stage = "repair";
  static constexpr std::array fields = {
      Field<O>{.name = "gap", .member = &O::gap, .min = 0.0, .max = 0.02, .help = "width of the widest seam that is closed, as a share of the body length"},
      Field<O>{.name = "hole", .member = &O::hole, .min = 0.0, .max = 10.0, .help = "diameter of the largest curved hole that is filled, in body lengths"},
      Field<O>{.name = "flat_hole",
               .member = &O::flat_hole,
               .min = 0.0,
               .max = 10.0,
               .help = "diameter of the largest hole with a flat border that is filled, in body lengths"},
      Field<O>{.name = "hole_edges", .member = &O::hole_edges, .min = 3, .max = 100000, .help = "number of edges of the largest hole that is filled"},
      Field<O>{.name = "smallest_part", .member = &O::smallest_part, .min = 0.0, .max = 0.5, .help = "parts with a smaller box are removed; in body lengths"},
      Field<O>{.name = "sliver", .member = &O::sliver, .min = 0.0, .max = 1e-3, .help = "shorter edges are collapsed in repaired regions; in body lengths"},
      Field<O>{.name = "largest_move",
               .member = &O::largest_move,
               .min = 0.0,
               .max = 1.0,
               .help = "largest allowed displacement of retained facets, in body lengths; more is an error. Filled holes are not counted"},
      Field<O>{.name = "half",
               .member = &O::half,
               .help = "plane in which a half model is open: automatic if it is unique, off, or the axis normal to it",
               .choices = "automatic off x y z"},
      Field<O>{.name = "half_tolerance",
               .member = &O::half_tolerance,
               .min = 0.0,
               .max = 0.02,
               .help = "largest distance of the open boundary from the plane of the half model (option half), in body lengths"},
      Field<O>{.name = "hull",
               .member = &O::hull,
               .help = "where facets cross or more than two meet in an edge, keep only facets that the outer flow reaches from exactly one side"},
      Field<O>{.name = "rounds", .member = &O::rounds, .min = 1, .max = 50, .help = "largest number of rounds of cutting and replacing"},
  };
};

}  // namespace sterna
