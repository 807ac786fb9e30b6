// Meshes one parametric face from its discretised border: the Delaunay surface mesher of docs/method/surface.md, "Delaunay criterion in space", for a single
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

/// A vertex on the border: (u, v) in the face's surface and the point shared by all faces of the edge (within the edge's tolerance of S(u, v)).
struct BorderPoint {
  Uv uv;
  Point point;
};

/// Closed loops of border points, without a repeated first point; the domain is inside the outer loop and outside of holes, whatever their orientation and
/// order. Seams are traversed twice, with different (u, v). A pole is a run of points at the same location in space: all of them become the first one of the
/// run.
struct FaceBorder {
  std::vector<std::vector<BorderPoint>> loops;
};

/// Target edge length at a location of the face and its point, metres; called from many threads. Values below FaceMeshOptions::min_edge are replaced by it.
using SizeFunction = std::function<double(Uv, const Point&)>;

struct FaceMeshOptions {
  double curvature_angle = 12.0 * std::numbers::pi / 180.0;  ///< rad: largest angle by which the surface turns along an edge; for callers that derive sizes
                                                             ///< from it, not used by mesh_face
  double min_edge = 0.0;                                     ///< m: lower limit of the target length from curvature
  double size_growth = 0.3;                                  ///< growth rate of the edge length with distance, from curvature and from the border
  double min_angle = 25.0 * std::numbers::pi / 180.0;        ///< rad: target of the second pass
  int smoothing_sweeps = 6;                                  ///< at most; only vertices beside triangles that can be improved are moved
  int max_triangles = 20'000'000;
};

struct FaceMeshReport {
  std::int64_t n_unfolding = 0;    ///< vertices inserted until the first triangles follow the surface
  std::int64_t n_first_pass = 0;   ///< vertices inserted for size
  std::int64_t n_second_pass = 0;  ///< vertices inserted for quality
  std::int64_t n_refused = 0;      ///< proposals rejected because they are too near, beyond the border, or fold the surface
  std::int64_t n_flips = 0;
  std::int64_t n_moves = 0;
  std::int64_t n_collapses = 0;
  double min_angle = 0.0;  ///< rad, smallest angle of all triangles
  double max_angle = 0.0;
  Point worst_location{};             ///< location of the smallest angle
  std::int64_t n_outside_20_130 = 0;  ///< triangles with an angle outside [20, 130] degrees
  std::int64_t n_folded = 0;          ///< triangles whose normal is opposite to the surface's normal at a corner
};

/// Vertices 0 .. n_border - 1 are the border's points in the order of the loops (only the first point of a pole's run is used).
struct FaceMesh {
  std::vector<Point> points;  ///< border: as given; inner points: exactly S(uv)
  std::vector<Uv> uv;
  std::vector<Vec3> normals;                ///< unit normals of the surface; zero where undefined (poles)
  std::vector<TriangleVertices> triangles;  ///< counter-clockwise in (u, v): normals along du x dv
  std::uint32_t n_border = 0;
  std::size_t n_band = 0;  ///< number of triangles at the end of the list that were generated in rows (band_rows.h); not included in `report`
  FaceMeshReport report;
};

/// \throws Error(bad_argument) for a border without loops or a loop of fewer than three points
void check_border(const FaceBorder& border);

/// Returns the box of the border in (u, v).
ParameterBox box_of(const FaceBorder& border);

/// Meshes a face: CDT of the border, vertices where the surface turns, refinement by size and by quality, flips, smoothing, collapses. `size` includes the
/// limits from curvature. `mean_speed`: mean lengths of du and dv, metres per parameter. Depends on the input only; linear in the number of triangles. The
/// border is unchanged.
/// \pre border points within their tolerance of the surface
/// \throws Error(self_intersection) where the border crosses or touches itself along a line in (u, v); Error(bad_argument) for an empty border or a size that
/// is not positive; Error(overflow) if max_triangles is not enough, with the location and its target size
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
               .help = "largest angle by which the surface turns along an edge"},
      Field<O>{.name = "min_edge", .member = &O::min_edge, .unit = Unit::metre, .min = 0.0, .help = "shortest edge that curvature may require"},
      Field<O>{.name = "size_growth",
               .member = &O::size_growth,
               .min = 0.01,
               .max = 2.0,
               .help = "largest change of the edge length per distance, away from curved parts and from the border"},
      Field<O>{.name = "min_angle",
               .member = &O::min_angle,
               .unit = Unit::radian,
               .min = 0.0,
               .max = 0.55,
               .help = "target angle of the pass that refines by quality"},
      Field<O>{
          .name = "smoothing_sweeps", .member = &O::smoothing_sweeps, .min = 0, .max = 100, .help = "largest number of smoothing sweeps over the vertices"},
      Field<O>{
          .name = "max_triangles", .member = &O::max_triangles, .min = 1, .max = 1e9, .help = "largest number of triangles of one face; more are an error"},
  };
};

}  // namespace sterna
