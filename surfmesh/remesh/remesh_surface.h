// Re-triangulates a triangulated surface. Sizes follow the curvature as in surface_mesh on CAD models, sharp edges and patches are kept, and vertices lie on a
// smooth reconstruction of the input (docs/method/surface.md, "Sliver triangles": the third repair).
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"
#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// Names and meanings are those of SurfaceMeshOptions. Its options for wings and CAD faces do not apply to a triangulation.
struct RemeshOptions {
  SurfaceSizeOptions sizes;
  double feature_angle = 40.0 * std::numbers::pi / 180.0;
  bool smooth = true;
};

/// Rows of stretched triangles at leading and trailing edges.
struct RowReport {
  std::int64_t n_triangles = 0;
  std::int64_t n_columns = 0;      ///< locations of lines on which rows stand
  std::int64_t n_without = 0;      ///< locations of those lines that have no rows
  double max_stretch = 0.0;        ///< largest aspect ratio of their cells: length along the line over length across it
  double max_growth = 0.0;         ///< largest ratio of consecutive row heights
  std::vector<std::string> notes;  ///< requirements that could not be met
};

/// Distance of one surface from another, sampled at the vertices, and at the middles of edges and triangles.
struct SurfaceDistance {
  double max = 0.0;      ///< m
  double mean = 0.0;     ///< m, mean over the samples
  Point location{};      ///< location of the largest distance
  double of_edge = 0.0;  ///< largest ratio of the distance to the longest edge of the new triangle there
};

struct RemeshReport {
  std::int64_t n_triangles_before = 0, n_triangles = 0;
  std::int64_t n_lines = 0;                    ///< number of pieces between corners of sharp edges, patch borders and open boundaries
  std::int64_t n_corners = 0;                  ///< number of ends of these lines; they do not move
  double least_size = 0.0;                     ///< m, smallest target size anywhere
  double max_edge = 0.0;                       ///< m, the largest target size
  double min_angle = 0.0;                      ///< rad
  double max_angle = 0.0;                      ///< rad
  double angle_quantile_1 = 0.0;               ///< rad: 1 % of the triangles have their smallest angle below this value
  double mean_radius_ratio = 0.0;              ///< mean weighted by area of 2 r / R, which is 1 for an equilateral triangle
  std::array<std::int64_t, 6> least_angles{};  ///< numbers of triangles by their smallest angle: below 10 degrees, below 20, and so on up to 60
  std::int64_t n_slivers = 0;                  ///< number of sliver triangles, with an angle below k_sliver_angle
  std::vector<ErrorLocation> slivers;          ///< the worst sliver triangles, at most k_max_locations, with the features that force them
  SurfaceDistance to_input;                    ///< from the new surface to the given one
  SurfaceDistance from_input;                  ///< from the given surface to the new one
  double turned_before = 0.0, turned = 0.0;  ///< fractions of the area of triangles turned by more than k_turned_angle from the smooth surface at a corner, of
                                             ///< the input and of the result
  double length = 0.0;                       ///< m, body length
  std::int64_t n_kept = 0;                   ///< number of triangles kept unchanged, because new ones would cross
  int n_rounds = 1;                          ///< rounds of remeshing; above 1 if triangles crossed
  RowReport rows;
};

/// Rad: triangles with a smaller angle are sliver triangles (docs/method/surface.md, "Sliver triangles").
inline constexpr double k_sliver_angle = 8.0 * std::numbers::pi / 180.0;

/// Rad: triangles turned from the smooth surface by more than this angle do not represent it.
inline constexpr double k_turned_angle = 10.0 * std::numbers::pi / 180.0;

struct RemeshResult {
  TriMesh mesh;  ///< patches as given, in the same order
  RemeshReport report;
};

/// Remeshes a wall. Edges that bend by more than feature_angle, borders of patches and open boundaries are lines. The corners of lines stay, and vertices
/// between corners move along the lines only. All other vertices lie on the input or, with `smooth`, on quadratic patches over its triangles. The bulge of such
/// a patch is the smaller of the two that the normals at the ends of each edge give, so that flat regions stay flat. No vertex leaves its smooth piece of
/// surface for another piece, however near that is.
/// \pre The wall is manifold, oriented and without self-intersection. It is closed, or open along boundaries; boundaries stay.
/// \post The result is manifold, and closed if the input was. No two triangles cross (exact test). No patch loses all its triangles. The result is bitwise the
/// same for any number of threads.
/// \param patches rules for patches by name; the last match is used. Used options: max_edge, min_edge, curvature_angle, chord_error, and rows at leading and
/// trailing edges
/// \throws Error(bad_argument) for sizes that are not positive, a rule that matches no patch or sets trailing_edge_cells or factors;
/// Error(non_manifold_surface); Error(self_intersection) if the input crosses itself or most of the result does; Error(overflow) for more than max_triangles,
/// before the work; Error(cancelled)
RemeshResult remesh_surface(const TriMesh& wall, const RemeshOptions& options, std::span<const Rule> patches, const SpaceSizes& requested,
                            const RunContext& context);

/// Returns several human-readable lines.
std::string to_text(const RemeshReport& report);

/// Sliver measures of a surface.
struct SliverCount {
  std::int64_t n = 0;        ///< number of triangles with an angle below the limit
  double least_angle = 0.0;  ///< rad, smallest angle; 0 for a surface without triangles
  Point location{};          ///< middle of the triangle with the smallest angle
};
/// \param limit rad
SliverCount count_slivers(const TriMesh& mesh, double limit = k_sliver_angle);
/// Returns true if layers and tetrahedra on a repaired or wrapped surface would fail quality gates. That is so if an angle is below k_worst_sliver_angle, or if
/// more than the fraction k_sliver_share of the triangles have an angle below k_sliver_angle.
bool is_remesh_advised(const SliverCount& slivers, std::size_t n_triangles);

/// Rad: tetrahedra and prisms on triangles with a smaller angle fail the gates for dihedral angles anywhere.
inline constexpr double k_worst_sliver_angle = 1.0 * std::numbers::pi / 180.0;
inline constexpr double k_sliver_share = 0.005;

}  // namespace sterna::surfmesh

namespace sterna {

template <>
struct Schema<surfmesh::RemeshOptions> {
  using O = surfmesh::RemeshOptions;
  static constexpr std::string_view stage = "remesh";
  static constexpr surfmesh::SizeTexts texts = {
      .automatic_max_edge = "for each connected piece: a twentieth of the root of its area, at least a thousandth of its length",
      .automatic_min_edge = "2 % of the longest edge; a quarter of that where chord_error needs it",
      .chord_error = "largest distance between the midpoint of an edge and the curved surface; edges are made short enough for this, by the curvature",
      .narrow = "largest edge length along a narrow strip between lines, in widths of the strip (never below a fifth of min_edge)",
      .gap_cells = "number of edges across a gap between opposite parts of the surface; 0: gaps are ignored"};
  static constexpr std::array own_fields = {
      Field<O>{.name = "feature_angle",
               .member = &O::feature_angle,
               .unit = Unit::radian,
               .min = 0.05,
               .max = 3.1,
               .help = "edges with a larger bend angle are kept; between these edges the surface is treated as smooth"},
      Field<O>{.name = "smooth",
               .member = &O::smooth,
               .help = "place new vertices on a curved surface through the input vertices, so that a coarse triangulation of a smooth body becomes smooth; "
                       "false: on the "
                       "input triangles"},
  };
  static constexpr auto fields =
      joined(surfmesh::length_fields<O>(texts), surfmesh::gap_fields<O>(texts), own_fields, surfmesh::count_fields<O>(), surfmesh::edge_row_fields<O>());
};

}  // namespace sterna
