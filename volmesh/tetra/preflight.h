// Checks a boundary before an engine runs. Finds defects with which every engine fails, and defects that are difficult for engines.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

enum class Trouble : std::uint8_t {
  crossing,   ///< two triangles meet in more than their shared vertices (exact test)
  duplicate,  ///< two triangles have the same three vertices
  folded,     ///< two triangles nearly coincide along a common edge; value: angle between them in rad
  sliver,     ///< triangle with a small height; value: ratio of the smallest height to the longest edge
  gap,        ///< two triangles without a common vertex are close to each other; value: ratio of their distance to the mean edge of the smaller one
};
/// Returns a text such as "triangles that cross another one".
std::string_view to_string(Trouble trouble);

struct PreflightLimits {
  double fold_angle = 1.0 * std::numbers::pi / 180.0;  ///< rad, limit of the fold angle
  double sliver = 1e-3;                                ///< limit of the ratio of height to longest edge
  double gap = 0.01;                                   ///< limit of the gap as a fraction of the mean edge of the smaller triangle
  bool searches_crossings = true;                      ///< false: only the other kinds of trouble are searched, and there is no proof
};

struct PreflightFinding {
  Trouble trouble = Trouble::crossing;
  std::array<std::uint32_t, 2> triangles{};  ///< triangles in ascending order; for a sliver twice the same triangle
  double value = 0.0;
};

struct PreflightReport {
  std::array<std::int64_t, 5> counts{};    ///< number of findings of each kind
  std::vector<PreflightFinding> findings;  ///< the first thousand findings of each kind, in the order of the triangles
  ClearProof clear = {};                   ///< given if crossings were searched, and there are neither crossings nor duplicates
  std::int64_t count(Trouble trouble) const { return counts[static_cast<std::size_t>(trouble)]; }
};

/// Checks a boundary. Parallel over a BoxTree; the report is the same for any number of threads. The two sides of a sheet count as one.
/// \pre check_boundary() has passed
PreflightReport preflight(const TetraBoundary& boundary, const PreflightLimits& limits, const RunContext& context);

/// Adds likely locations to the error of an engine that reports none. They are the triangles found by the check: folded ones, then gaps, then slivers, with the
/// worst of each kind first.
void add_suspects(const PreflightReport& report, const TetraBoundary& boundary, ErrorInfo& error);

/// Logs a warning for each kind of trouble with which an engine may still succeed, with the number of findings and the first location.
/// \throws Error(self_intersection) for intersections and duplicates, with locations and a drawing
void judge(const PreflightReport& report, const TetraBoundary& boundary, const RunContext& context);

}  // namespace sterna::volmesh
