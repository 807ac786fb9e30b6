// Rows of stretched triangles along parts of a face's border, laid before the rest of the face is meshed: an advancing layer on the surface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "surfmesh/face/face_mesh.h"
#include "surfmesh/face/face_sizes.h"

namespace sterna::surfmesh {

/// Where a row would be as high as this part of the length of its edges along the border, rows end: the triangle that follows is as high as an equilateral one,
/// 0.87.
inline constexpr double k_isotropic_height = 0.9;
/// Rows at most: with growth 1.2 the 60th is 50 000 times as high as the first.
inline constexpr std::size_t k_max_rows = 60;

/// Heights of rows: the first, each later one `growth` times the one before, none above what curvature across allows.
struct RowLaw {
  double first = 0.0;  ///< m
  double growth = 1.2;
  CurvatureLimits limits;
  /// \param before height of the row below, 0 for the first one. \param curvature of the surface across the rows there, 1/m
  double next_height(double before, double curvature) const;
};

/// Consecutive points of a loop that rows stand on: `n_points` of them from `first` on, around the loop's end if need be. At either end rows begin and end with
/// nothing, or with the points of the border beyond it (`n_before` in front of the first one, `n_after` behind the last), which then are the rows' ends there.
struct BandRun {
  std::size_t loop = 0, first = 0, n_points = 0;
  std::size_t n_before = 0, n_after = 0;
  RowLaw law{};
};

/// What triangles of bands are like.
struct BandMeasures {
  std::int64_t n_triangles = 0;
  double max_stretch = 0.0;    ///< largest length along : length across of their cells
  double max_growth = 0.0;     ///< largest ratio of the heights of rows that follow each other
  std::int64_t n_columns = 0;  ///< border points that rows stand on
  std::int64_t n_without = 0;  ///< border points of runs with none
};

struct BandedFace {
  FaceMesh mesh;  ///< triangles of rows come last; vertices as of mesh_face
  BandMeasures bands;
  std::vector<Point> dropped;  ///< where rows had to be taken back because the rest could not be meshed
};

/// mesh_face with rows along parts of the border: vertices of rows lie on the surface, their triangles are what they are; the rest is meshed from the rows'
/// outer line. Neighbouring columns differ by one row at most. Rows end before another border, another run, or a fold.
/// \throws as mesh_face, never because of the rows
BandedFace mesh_banded_face(const Surface& surface, const FaceBorder& border, const std::vector<BandRun>& runs, const SizeFunction& size, Vec2 mean_speed,
                            const FaceMeshOptions& options, const RunContext& context);

/// The diagonal of the cell a b / d c (counter-clockwise a b c d) that leaves the larger least angle; where both are as good the one that `is_even` says.
/// \return true: from a to c
bool is_first_diagonal(const Point& a, const Point& b, const Point& c, const Point& d, bool is_even);

}  // namespace sterna::surfmesh
