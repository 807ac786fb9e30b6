// A surface with holes, seams, crossings, sheets and inner walls made into one that can be meshed, with as few changes as possible, each of them told.
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

/// Lengths are shares of the body length L (the longest side of the box), so that the defaults fit any body.
struct RepairOptions {
  double gap = 1e-3;            ///< L; wider seams stay open, and are holes
  double hole = 0.3;            ///< L; diameter of the largest curved hole that is filled
  double flat_hole = 2.0;       ///< L; the same for holes with a flat rim
  int hole_edges = 1000;        ///< of the largest hole that is filled
  double smallest_part = 1e-3;  ///< L; parts with a smaller box are dropped
  double sliver = 1e-7;         ///< L; shorter edges are collapsed where something was changed
  double largest_move = 0.01;   ///< L; of what is left of the input; more is an error
  std::string half = "automatic";
  double half_tolerance = 1e-3;  ///< L; how far from its plane the rim of a half model may lie
  bool hull = true;
  int rounds = 6;
};

/// What was done to a place.
enum class RepairKind {
  dropped,         ///< facets without area, copies, doubled sheets
  welded,          ///< vertices within rounding
  zipped,          ///< a seam closed
  into_plane,      ///< the rim of a half model moved into its plane
  filled,          ///< a hole
  cut,             ///< facets cut where they cross others
  removed_sheet,   ///< facets with the fluid on both sides
  removed_inside,  ///< facets with the fluid on neither side
  removed_part,    ///< a part too small to matter
  separated,       ///< vertices or edges in which more than two facets met
  joined,          ///< bodies that touched along edges, over the crevice between them
  collapsed,       ///< short edges
  replaced,        ///< crossing facets taken out and the hole filled
  turned           ///< facets against the sense of the others
};
inline constexpr std::size_t k_repair_kinds = 14;
/// "filled", "removed_sheet" ...
std::string_view to_string(RepairKind kind);

struct RepairChange {
  RepairKind kind = RepairKind::dropped;
  Vec3 position;              ///< m; centre of the place
  double size = 0.0;          ///< m; how far something moved (welded, zipped, into_plane, separated, collapsed), else the diameter of the place
  std::int64_t n_facets = 0;  ///< concerned: added, removed, cut or moved
};

/// The facets that were changed or taken out, for drawing.
struct RepairDrawing {
  std::vector<Vec3> points;  ///< m
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> change;  ///< per triangle: index into RepairReport::changes
};

/// The opening of half a body: its rim lies in the plane, exactly.
struct HalfRim {
  std::string axis;      ///< "x", "y" or "z"
  double at = 0.0;       ///< m
  bool is_above = true;  ///< the body is on the side of larger coordinates
  double off = 0.0;      ///< m; how far the rim was off the plane at most
  std::int64_t n_vertices = 0;
};

struct RepairReport {
  StitchReport stitch;                ///< of the result, which stitch_surface proves
  std::vector<RepairChange> changes;  ///< in the order in which they were made; empty: the input is as good as the result, which has its bytes
  std::optional<HalfRim> half;
  double length = 0.0;       ///< m, L
  double moved = 0.0;        ///< m; farthest sample of what is left of the input's facets from the input
  double from_result = 0.0;  ///< m; farthest sample of the result from the input: the middle of the largest filled hole, mostly
  double from_input = 0.0;   ///< m; farthest sample of the input from the result: what was removed
  double sampling = 0.0;     ///< m; no point is farther than the figures above plus this
  RepairDrawing drawing;
  std::vector<std::string> messages;  ///< one sentence for each kind of change, as logged

  std::int64_t count(RepairKind kind) const;
};

struct RepairResult {
  TriMesh mesh;
  RepairReport report;
};

/// Steps: weld and drop (as stitch_surface); small parts; seams zipped with a growing tolerance, T-junctions, too; sheets; the opening of a half model
/// recognised and put into its plane; holes filled, flat ones flat; crossings cut exactly and the outer hull kept (facets with the fluid on one side); vertices
/// and edges in which the hull touches itself separated; short edges collapsed; what still crosses after rounding replaced by a filling, in growing rings. A
/// surface that stitch_surface accepts (without allow_open) comes back with the same bytes and no change.
/// \post closed, or with a rim in report.half's plane to the bit; manifold, oriented, without crossings (stitch_surface is asked); patches are those of the nearest
/// facets of the input.
/// \throws Error as stitch_surface for what is left, with places and the next thing to try; mesh_invalid when the surface would move by more than allowed
RepairResult repair_surface(const std::vector<SurfaceSoup>& soups, const StitchOptions& stitching, const RepairOptions& options, const RunContext& context);

/// What repair finds to do, by its own steps up to the filling of holes: nothing is cut, no hull is taken, nothing proved.
struct RepairForecast {
  bool is_needed = false;        ///< false: stitch_surface accepts the surface, and the rest is empty
  std::string problem;           ///< what stitch_surface said, with its counts
  std::vector<Vec3> places;      ///< m; where, the first of them
  std::int64_t n_facets = 0;     ///< with an area, as read
  double area = 0.0;             ///< m^2, of these
  double length = 0.0;           ///< m, body length
  std::int64_t n_changes = 0;    ///< places in all; 0 of half a model with its rim in the plane
  std::int64_t n_seams = 0;      ///< places zipped
  std::int64_t n_sheets = 0;     ///< places removed
  std::int64_t n_holes = 0;      ///< filled
  std::int64_t n_fillings = 0;   ///< facets that fill them
  std::int64_t n_open = 0;       ///< openings that repair does not close: above its limits, or as large as what is there
  double widest_open = 0.0;      ///< m; diagonal of the box of the widest of them
  Vec3 widest_place;             ///< m; its middle
  std::int64_t n_crossings = 0;  ///< pairs of facets that cross or touch, then
  std::int64_t n_crowded = 0;    ///< edges of more than two facets, then
  std::optional<HalfRim> half;
  bool is_enough = true;  ///< nothing stays open, and what crosses may be cut
};

/// Quick: mostly a small share of the time of repair_surface, which may still fail where the hull leaks or rounding leaves crossings.
/// \throws Error as repair_surface for what no repair is for (file_malformed, empty_surface, bad_argument); cancelled
RepairForecast foresee_repair(const std::vector<SurfaceSoup>& soups, const StitchOptions& stitching, const RepairOptions& options, const RunContext& context);

}  // namespace sterna::surfmesh

namespace sterna {

template <>
struct Schema<surfmesh::RepairOptions> {
  using O = surfmesh::RepairOptions;
  static constexpr std::string_view stage = "repair";
  static constexpr std::array fields = {
      Field<O>{.name = "gap", .member = &O::gap, .min = 0.0, .max = 0.02, .help = "widest seam that is zipped, as a share of the body length"},
      Field<O>{.name = "hole", .member = &O::hole, .min = 0.0, .max = 10.0, .help = "diameter of the largest curved hole that is filled, in body lengths"},
      Field<O>{.name = "flat_hole",
               .member = &O::flat_hole,
               .min = 0.0,
               .max = 10.0,
               .help = "diameter of the largest hole with a flat rim that is filled, in body lengths"},
      Field<O>{.name = "hole_edges", .member = &O::hole_edges, .min = 3, .max = 100000, .help = "edges of the largest hole that is filled"},
      Field<O>{.name = "smallest_part", .member = &O::smallest_part, .min = 0.0, .max = 0.5, .help = "parts with a smaller box are dropped; in body lengths"},
      Field<O>{
          .name = "sliver", .member = &O::sliver, .min = 0.0, .max = 1e-3, .help = "shorter edges are collapsed where something was changed; in body lengths"},
      Field<O>{.name = "largest_move",
               .member = &O::largest_move,
               .min = 0.0,
               .max = 1.0,
               .help = "how far what is left of the surface may move, in body lengths; more is an error. What fills holes is not counted"},
      Field<O>{.name = "half",
               .member = &O::half,
               .help = "plane in which half a model is open: found where it is clear, none, or its axis",
               .choices = "automatic off x y z"},
      Field<O>{
          .name = "half_tolerance", .member = &O::half_tolerance, .min = 0.0, .max = 0.02, .help = "how far off that plane the rim may lie, in body lengths"},
      Field<O>{.name = "hull",
               .member = &O::hull,
               .help = "where facets cross or more than two meet in an edge, keep only what the outer flow reaches from one side"},
      Field<O>{.name = "rounds", .member = &O::rounds, .min = 1, .max = 50, .help = "how often cutting and replacing are tried at most"},
  };
};

}  // namespace sterna
