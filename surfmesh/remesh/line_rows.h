// Trailing and leading edges of a triangulation that get rows of stretched triangles, like those that surface_mesh lays on CAD models. Rules:
// docs/method/surface.md, "Wing edges and bands".
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "surfmesh/remesh/reference.h"
#include "surfmesh/remesh/remesh_sizes.h"

namespace sterna::surfmesh {

/// Rows on one side of a line.
struct SideRows {
  bool is_any = false;
  double first = 0.0;            ///< m, height of the first row
  double growth = 1.2;           ///< ratio of consecutive row heights
  double curvature_angle = 0.2;  ///< rad: a row spans at most this angle of the surface,
  double min_edge = 0.0;         ///< m: the angle does not reduce the height below this length
};

struct LineRows {
  std::int32_t line = k_no_line;
  std::array<SideRows, 2> sides;  ///< left and right of the line
  double longest = 0.0;           ///< m: upper limit of edge lengths along the line
  bool is_nose = false;
  double at_ends = 0.0;               ///< m, for a nose: size required by its curvature where rows end
  std::array<bool, 2> is_going_on{};  ///< at its start and at its end: true if another line with rows continues there
};

struct RowLines {
  std::vector<LineRows> lines;
  std::vector<std::string> notes;  ///< requirements that could not be met
};

/// Finds lines with rows. There are three types: sharp lines (a turn of more than 120 degrees) that face aft or forward along x; the sides of narrow bases that
/// face aft, with rows on the wing's side only; and lines laid on smooth noses (is_nose) where the surface has the curvature of a nose. Lines of kept triangles
/// have no rows.
RowLines find_row_lines(const Reference& reference, const SurfaceLimitTable& limits, const RemeshOptions& options, std::span<const Rule> patches);

/// Returns the width of the surface beside a half-edge in metres: the distance from its middle, at right angles into its triangle, across the surface to the
/// next line. The result is at most `most`.
double width_across(const Reference& reference, HalfedgeId h, double most);

}  // namespace sterna::surfmesh
