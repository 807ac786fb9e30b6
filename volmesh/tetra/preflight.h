// Check of a boundary before an engine runs: defects that no engine survives, and defects that make an engine's work difficult.
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
  crossing,   ///< two triangles meet in more than their shared vertices (exact)
  duplicate,  ///< two triangles have the same three vertices
  folded,     ///< two triangles nearly coincide along a common edge; value: angle between them, rad
  sliver,     ///< value: smallest height over longest edge
  gap,        ///< two triangles without common vertex are close to each other; value: distance over the mean edge of the smaller one
};
/// Returns "triangles that cross another one", ...
std::string_view to_string(Trouble trouble);

struct PreflightLimits {
  double fold_angle = 1.0 * std::numbers::pi / 180.0;  ///< rad
  double sliver = 1e-3;                                ///< height over longest edge
  double gap = 0.01;                                   ///< share of the mean edge of the smaller triangle
  bool is_clear = false;                               ///< the caller has verified that there are no intersections: they are not searched
};

struct PreflightFinding {
  Trouble trouble = Trouble::crossing;
  std::array<std::uint32_t, 2> triangles{};  ///< ascending; for a sliver, twice the same
  double value = 0.0;
};

struct PreflightReport {
  std::array<std::int64_t, 5> counts{};    ///< indexed by trouble
  std::vector<PreflightFinding> findings;  ///< the first thousand of each trouble, in order of the triangles
  std::int64_t count(Trouble trouble) const { return counts[static_cast<std::size_t>(trouble)]; }
};

/// Checks a boundary. Parallel over a BoxTree; the same report for any number of threads. The two sides of a sheet count once.
/// \pre check_boundary() passed.
PreflightReport preflight(const TetraBoundary& boundary, const PreflightLimits& limits, const RunContext& context);

/// Adds likely locations to an error of an engine that reports none: the triangles found (folded ones, then gaps, then slivers; the worst of each first).
void add_suspects(const PreflightReport& report, const TetraBoundary& boundary, ErrorInfo& error);

/// Logs a warning for each kind of trouble that an engine may survive, with the number and the first location.
/// \throws Error(self_intersection) for intersections and duplicates, with locations and geometry.
void judge(const PreflightReport& report, const TetraBoundary& boundary, const RunContext& context);

}  // namespace sterna::volmesh
