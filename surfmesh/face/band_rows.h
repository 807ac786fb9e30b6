// Rows of stretched triangles along parts of a face's border, laid before the rest of the face is meshed: an advancing layer on the surface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "surfmesh/face/face_sizes.h"
#include "surfmesh/face/sized_face_mesh.h"

namespace sterna::surfmesh {

/// Rows end where a row would be as high as this fraction of the length of its edges along the border. The height of an equilateral triangle, which follows,
/// is 0.87 of its edge.
inline constexpr double k_isotropic_height = 0.9;
/// Largest number of rows: with growth 1.2 the 60th is 50 000 times as high as the first.
inline constexpr std::size_t k_max_rows = 60;

/// Heights of rows: each row is `growth` times as high as the one before, up to the limit set by the curvature across the rows.
struct RowLaw {
  double first = 0.0;  ///< m
  double growth = 1.2;
  CurvatureLimits limits;
  /// \param before height of the row below, 0 for the first row. \param curvature of the surface across the rows there, 1/m
  double next_height(double before, double curvature) const;
};

/// Consecutive points of a loop on which rows stand: `n_points` of them from `first` on, possibly past the end of the loop. At either end, rows taper off to
/// nothing, or end at the border points beyond that end (`n_before` in front of the first point, `n_after` behind the last).
struct BandRun {
  std::size_t loop = 0, first = 0, n_points = 0;
  std::size_t n_before = 0, n_after = 0;
  RowLaw law{};
};

/// Statistics of the triangles in bands.
struct BandMeasures {
  std::int64_t n_triangles = 0;
  double max_stretch = 0.0;    ///< largest aspect ratio of their cells: length along the border over length across it
  double max_growth = 0.0;     ///< largest ratio of the heights of consecutive rows
  std::int64_t n_columns = 0;  ///< border points on which rows stand
  std::int64_t n_without = 0;  ///< border points of runs without rows
};

struct BandedFace {
  FaceMesh mesh;  ///< the triangles of rows come last; vertices are in the order of mesh_face
  BandMeasures bands;
  std::vector<Point> dropped;  ///< locations where rows were removed because the rest could not be meshed
};

/// Meshes a face like mesh_face, with rows along parts of the border. Vertices of rows lie on the surface, and row triangles are not improved afterwards. The
/// rest is meshed from the outer boundary of the rows. The numbers of rows of neighbouring columns differ by at most one. Rows end before another border,
/// another run, or a fold.
/// \throws as mesh_face; rows never cause an error
BandedFace mesh_banded_face(const Surface& surface, const FaceBorder& border, const std::vector<BandRun>& runs, const SizeFunction& size, Vec2 mean_speed,
                            const FaceMeshOptions& options, const RunContext& context);

/// Chooses the diagonal of the cell a b / d c (counter-clockwise a b c d) with the larger smallest angle. If both are equally good, `is_even` decides.
/// \return true: from a to c
bool is_first_diagonal(const Point& a, const Point& b, const Point& c, const Point& d, bool is_even);

}  // namespace sterna::surfmesh
