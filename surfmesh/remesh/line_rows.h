// Lines of a triangulation that are trailing or leading edges and get rows of stretched triangles, as surface_mesh lays them on CAD (docs/method/surface.md,
// "Wing edges and bands").
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
  double growth = 1.2;           ///< of rows that follow each other
  double curvature_angle = 0.2;  ///< rad: a row spans at most this angle of the surface,
  double min_edge = 0.0;         ///< m: but for that is no lower than this
};

struct LineRows {
  std::int32_t line = k_no_line;
  std::array<SideRows, 2> sides;  ///< left of the line, right of it
  double longest = 0.0;           ///< m: edges along are no longer
  bool is_nose = false;
  double at_ends = 0.0;               ///< m, of a nose: what its curvature asks for where rows end
  std::array<bool, 2> is_going_on{};  ///< at its start, its end: another line with rows does
};

struct RowLines {
  std::vector<LineRows> lines;
  std::vector<std::string> notes;  ///< wishes that could not be met
};

/// Lines with rows: sharp ones (a turn of more than 120 degrees) that look aft or forward along x, and sides of narrow bases that look aft, rows on the wing's
/// side only; lines that were laid on smooth noses (is_nose) where the surface is bent as a nose is. Lines of kept triangles have none.
RowLines find_row_lines(const Reference& reference, const SurfaceLimitTable& limits, const RemeshOptions& options,
                        std::span<const PatchSurfaceOptions> patches);

/// Metres across the surface, at right angles from the middle of a half-edge into its triangle, to the next line or `most`.
double width_across(const Reference& reference, HalfedgeId h, double most);

}  // namespace sterna::surfmesh
