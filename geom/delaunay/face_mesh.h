// One parametric face, from its cut border to triangles: the Delaunay surface mesher of docs/method/surface.md, "Delaunay criterion in space", for a single
// face.
#pragma once

#include <cstdint>
#include <functional>
#include <numbers>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/math/predicates.h"
#include "geom/mesh/tri_mesh.h"
#include "geom/model/surface.h"

namespace sterna::delaunay {

/// A vertex on the border: (u, v) in the face's surface and the point that all faces of the edge share (within the edge's tolerance of S(u, v)).
struct BorderPoint {
  Uv uv;
  Point point;
};

/// Closed loops of border points, each without its first point repeated at the end; the domain is inside the outer loop and outside of holes, whatever their
/// sense and order. Seams are walked twice, with different (u, v). A pole is a run of points with the same place in space: all of them become the first one of
/// the run.
struct FaceBorder {
  std::vector<std::vector<BorderPoint>> loops;
};

/// Wanted length of edges at a place of the face and its point, metres; from many threads. Values below FaceMeshOptions::min_edge count as that.
using SizeFunction = std::function<double(Uv, const Point&)>;

struct FaceMeshOptions {
  double curvature_angle =
      12.0 * std::numbers::pi /
      180.0;  ///< rad: an edge spans at most this angle of the surface; for callers that make their sizes with it, mesh_face here does not look at it
  double min_edge = 0.0;                               ///< m: curvature asks for no less
  double size_growth = 0.3;                            ///< change of the edge length by distance, from curvature and from the border
  double min_angle = 25.0 * std::numbers::pi / 180.0;  ///< rad: goal of the second pass
  int smoothing_sweeps = 6;                            ///< at most; only vertices beside triangles that can gain move
  int max_triangles = 20'000'000;
};

struct FaceMeshReport {
  std::int64_t n_unfolding = 0;    ///< vertices inserted so that the first triangles follow the surface
  std::int64_t n_first_pass = 0;   ///< for size
  std::int64_t n_second_pass = 0;  ///< for quality
  std::int64_t n_refused = 0;      ///< proposals too near, beyond the border, or folding
  std::int64_t n_flips = 0;
  std::int64_t n_moves = 0;
  std::int64_t n_collapses = 0;
  double min_angle = 0.0;  ///< rad, of all triangles
  double max_angle = 0.0;
  Point worst_place{};                ///< where the smallest angle is
  std::int64_t n_outside_20_130 = 0;  ///< triangles with an angle outside [20, 130] degrees
  std::int64_t n_folded = 0;          ///< triangles that look against the surface's normal at a corner
};

/// Vertices 0 .. n_border - 1 are the border's points in the order of the loops (of a pole's run only the first is used).
struct FaceMesh {
  std::vector<Point> points;  ///< border: as given; the others exactly S(uv)
  std::vector<Uv> uv;
  std::vector<Vec3> normals;                ///< of the surface, unit; zero where it has none (poles)
  std::vector<TriangleVertices> triangles;  ///< counter-clockwise in (u, v): normals along du x dv
  std::uint32_t n_border = 0;
  std::size_t n_band = 0;  ///< so many of the triangles, the last ones, were laid in rows (band_rows.h); `report` is not about them
  FaceMeshReport report;
};

/// \throws Error(bad_argument) for a border without loops or a loop of fewer than three points
void check_border(const FaceBorder& border);

/// Box of the border in (u, v).
ParameterBox box_of(const FaceBorder& border);

/// Meshes a face: CDT of the border, vertices where the surface turns, refinement by size, by quality, flips, smoothing, collapses. `size` holds what curvature
/// asks for. `mean_speed`: mean lengths of du and dv, metres by parameter. Depends on the input alone; linear in the number of triangles. The border is kept as
/// it is.
/// \pre border points within their tolerance of the surface
/// \throws Error(self_intersection) where the border crosses or touches itself along a line in (u, v); Error(bad_argument) for an empty border or a size that
/// is not positive; Error(overflow) when max_triangles is not enough, with the place and the size wanted there
FaceMesh mesh_face(const Surface& surface, const FaceBorder& border, const SizeFunction& size, Vec2 mean_speed, const FaceMeshOptions& options,
                   const RunContext& context);

}  // namespace sterna::delaunay

namespace sterna {

template <>
struct Schema<delaunay::FaceMeshOptions> {
  using O = delaunay::FaceMeshOptions;
  static constexpr std::string_view stage = "face_mesh";
  static constexpr std::array fields = {
      Field<O>{.name = "curvature_angle",
               .member = &O::curvature_angle,
               .unit = Unit::radian,
               .min = 0.001,
               .max = 1.6,
               .help = "an edge spans at most this angle of the surface"},
      Field<O>{.name = "min_edge", .member = &O::min_edge, .unit = Unit::metre, .min = 0.0, .help = "curvature asks for no shorter edges"},
      Field<O>{.name = "size_growth",
               .member = &O::size_growth,
               .min = 0.01,
               .max = 2.0,
               .help = "change of the edge length by distance, from curvature and from the border"},
      Field<O>{.name = "min_angle", .member = &O::min_angle, .unit = Unit::radian, .min = 0.0, .max = 0.55, .help = "goal of the pass that refines by quality"},
      Field<O>{.name = "smoothing_sweeps", .member = &O::smoothing_sweeps, .min = 0, .max = 100, .help = "sweeps over the vertices, at most"},
      Field<O>{.name = "max_triangles", .member = &O::max_triangles, .min = 1, .max = 1e9, .help = "of one face; beyond it is an error"},
  };
};

}  // namespace sterna
