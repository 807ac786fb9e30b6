#include "volmesh/second_engine.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/mesh/gates.h"
#include "volmesh/improve/angle_survey.h"
#include "volmesh/improve/remaining.h"
#include "volmesh/tetra/size_supply.h"

namespace sterna::volmesh {
namespace {

/// Text of the failure after which another engine made the recovery for sterna's own engine.
constexpr const char* k_recovery_failure = "recovery of the boundary";

struct SmallFace {
  std::array<std::uint32_t, 3> corners;  ///< vertices, ascending
  double volume = 0.0;                   ///< m^3, volume of the tetrahedron on the face
};

std::array<std::uint32_t, 3> face_of(const std::array<std::uint32_t, 4>& tet, std::size_t opposite) {
  std::array<std::uint32_t, 3> corners{};
  for (std::size_t k = 0, n = 0; k < 4; ++k)
    if (k != opposite) corners[n++] = tet[k];
  std::ranges::sort(corners);
  return corners;
}

/// Counts volume ratios beyond the limit. At few faces, each corner belongs to a tetrahedron that is so much larger. Only these faces are compared with the
/// tetrahedra behind them.
void count_growth(std::span<const Vec3> boundary, const TetraResult& tets, double limit, HardMisses& misses, const RunContext& context) {
  const auto& cells = tets.tetrahedra;
  const auto location = [&](std::uint32_t v) { return v < boundary.size() ? boundary[v] : tets.new_points[v - boundary.size()]; };
  std::vector<double> volume(cells.size()), largest_at(boundary.size() + tets.new_points.size(), 0.0);
  parallel_for(context, cells.size(),
               [&](std::size_t t) { volume[t] = tet_volume(location(cells[t][0]), location(cells[t][1]), location(cells[t][2]), location(cells[t][3])); });
  for (std::size_t t = 0; t < cells.size(); ++t)
    for (const std::uint32_t v : cells[t]) largest_at[v] = std::max(largest_at[v], volume[t]);
  std::vector<SmallFace> small;
  std::vector<std::uint8_t> is_small_at(largest_at.size(), 0);
  for (std::size_t t = 0; t < cells.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k) {
      const auto corners = face_of(cells[t], k);
      if (!std::ranges::all_of(corners, [&](std::uint32_t v) { return largest_at[v] > limit * volume[t]; })) continue;
      small.push_back({corners, volume[t]});
      for (const std::uint32_t v : corners) is_small_at[v] = 1;
    }
  if (small.empty()) return;
  std::ranges::sort(small, {}, &SmallFace::corners);
  for (std::size_t t = 0; t < cells.size(); ++t)
    for (std::size_t k = 0; k < 4; ++k) {
      const auto corners = face_of(cells[t], k);
      if (!std::ranges::all_of(corners, [&](std::uint32_t v) { return is_small_at[v]; })) continue;
      const auto [begin, end] = std::ranges::equal_range(small, corners, {}, &SmallFace::corners);
      for (const SmallFace& face : std::ranges::subrange(begin, end)) {
        if (volume[t] <= limit * face.volume) continue;
        ++misses.n_growth;
        misses.growth = std::max(misses.growth, volume[t] / face.volume);
      }
    }
}

std::string described(const HardMisses& misses) {
  return std::to_string(misses.n()) + " items beyond the hard limits, dihedral angles " + number_text(k_degrees * misses.smallest, 3) + " to " +
         number_text(k_degrees * misses.largest, 4) + " deg" + (misses.n_growth > 0 ? ", volume ratio " + number_text(misses.growth, 3) : "");
}

bool is_better(const HardMisses& a, const HardMisses& b) { return a.n() != b.n() ? a.n() < b.n() : a.smallest > b.smallest; }

bool may_use(const SecondEngine& second, const TetraResult& tets, const std::vector<std::string>& failures) {
  const TetraOptions& options = second.tetrahedra;
  return options.engine == "automatic" && options.try_other_engine && !options.two_pass && !tets.is_two_pass && options.boundary_splits != "always" &&
         std::ranges::all_of(failures, [](const std::string& failure) { return failure.starts_with(k_recovery_failure); });
}

/// Returns the tetrahedra of the other engine; nothing if it fails.
std::optional<TetraResult> fill_again(const FillBoundary& boundary, const SecondEngine& second, const std::string& engine, bool& is_reproducible,
                                      const RunContext& context) {
  const StageTimer timer(context, "improve/second_engine");
  TetraOptions options = second.tetrahedra;
  options.engine = engine;
  options.try_other_engine = false;
  options.boundary_splits = "never";
  const TetraBoundary domain = engine_boundary(boundary, second.holes, second.clear, second.traits);
  SizeSupply sizes(domain, second.sources, second.sizes, context);
  try {
    return fill(domain, sizes, options, context);
  } catch (const FillError& error) {
    is_reproducible &= error.is_repeatable();
    return std::nullopt;  // a warning is not needed, because the engine selection has already warned
  }
}

}  // namespace

SecondEngine second_engine(const MeshCase& options, std::vector<Vec3> holes, ClearProof clear, BoundaryTraits traits) {
  return {.tetrahedra = options.tetrahedra, .sources = options.sources, .sizes = options.size, .holes = std::move(holes), .clear = clear, .traits = traits};
}

HardMisses hard_misses(const TetraBoundary& boundary, const TetraResult& tets, const ImproveOptions& options, const RunContext& context) {
  const GateTable gates;
  ImproveOptions hard = options;
  hard.improve_min_angle = gates[Measure::min_dihedral].hard;
  hard.improve_max_angle = gates[Measure::max_dihedral].hard;
  const AngleSurvey survey = survey_angles(boundary, tets, quality_limits(hard.improve_min_angle, hard.improve_max_angle), context);
  ImproveReport forced;
  list_remaining(boundary, tets, survey.bad, hard, forced, context);
  HardMisses misses{.n_angles = static_cast<std::int64_t>(survey.bad.size()) - forced.n_forced, .smallest = survey.smallest, .largest = survey.largest};
  count_growth(boundary.points, tets, gates[Measure::tet_growth].hard, misses, context);
  return misses;
}

std::string choose_engine(const FillBoundary& boundary, const SecondEngine& second, const ImproveOptions& options, const std::vector<std::string>& failures,
                          TetraResult& tets, ImproveReport& report, const RunContext& context) {
  if (!may_use(second, tets, failures)) return {};
  const TetraBoundary domain = improvement_boundary(boundary);
  const HardMisses first = hard_misses(domain, tets, options, context);
  if (first.n() == 0) return {};
  const std::string other = tets.engine == "sterna" ? "hxt" : "sterna";
  context.info("tetrahedra by " + tets.engine + ": " + described(first) + "; trying " + other + " too");
  std::optional<TetraResult> filled = fill_again(boundary, second, other, tets.is_reproducible, context);
  std::string choice = tets.engine + ": " + described(first);
  if (!filled) {
    choice += "; " + other + ": no result; kept " + tets.engine;
  } else {
    ImproveReport of_other = improve_tetrahedra(domain, *filled, options, context);
    const HardMisses now = hard_misses(domain, *filled, options, context);
    choice += "; " + other + ": " + described(now) + "; kept " + (is_better(now, first) ? other : tets.engine);
    if (is_better(now, first)) {
      filled->is_reproducible &= tets.is_reproducible;
      filled->engine_seconds += tets.engine_seconds;
      filled->engine_peak_bytes = std::max(filled->engine_peak_bytes, tets.engine_peak_bytes);
      tets = std::move(*filled);
      report = std::move(of_other);
    }
  }
  context.info("choice of the engine: " + choice);
  return choice;
}

}  // namespace sterna::volmesh
