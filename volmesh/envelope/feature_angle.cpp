#include "volmesh/envelope/feature_angle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "geom/base/parallel.h"
#include "geom/base/schema.h"
#include "geom/math/constants.h"
#include "volmesh/envelope/classify.h"

namespace sterna::volmesh {
namespace {

/// Margin above the largest smooth deviation. Single precision, and scripts that move the wall, change angles slightly.
constexpr double k_above_smooth = 1.0 * k_degree;
/// Degrees: smaller deviations occur on any coarse curved surface, and larger ones are features on all surfaces.
constexpr std::size_t k_lowest = 20, k_highest = 60;
constexpr std::size_t k_window = 2;  ///< number of bins on either side that are counted together with a bin, so that single edges do not end a gap
/// A window with at most this fraction of all edges counts as empty, because every surface has some badly shaped triangles.
constexpr double k_quiet_share = 1e-3;

using Histogram = std::array<std::int64_t, 181>;  ///< number of edges for each degree of |deviation|

Histogram histogram_of(const LayerBase& base, const RunContext& context) {
  return parallel_reduce(
      context, base.topology.n_halfedges(), Histogram{},
      [&](std::size_t begin, std::size_t end) {
        Histogram counts{};
        for (std::size_t i = begin; i < end; ++i) {
          const HalfedgeId h(i);
          const HalfedgeId twin = base.topology.twin(h);
          if ((twin.is_valid() && twin < h) || base.is_in_gap(h)) continue;
          ++counts[static_cast<std::size_t>(std::abs(dihedral_deviation(base, h)) / k_degree)];
        }
        return counts;
      },
      [](Histogram a, const Histogram& b) {
        for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
        return a;
      });
}

std::string degrees_text(double angle) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f deg", angle / k_degree);
  return text;
}

double middle_of_gap(const LayerBase& base, const RunContext& context) {
  const Histogram counts = histogram_of(base, context);
  std::int64_t n_edges = 0;
  for (const std::int64_t n : counts) n_edges += n;
  std::array<std::int64_t, k_highest + 1> near{};
  for (std::size_t i = k_lowest; i <= k_highest; ++i)
    for (std::size_t k = i - k_window; k <= i + k_window; ++k) near[i] += counts[k];
  const std::int64_t least = *std::min_element(near.begin() + k_lowest, near.end());
  const std::int64_t quiet = std::max(least, static_cast<std::int64_t>(k_quiet_share * static_cast<double>(n_edges)));
  std::size_t best_begin = k_lowest, best_end = k_lowest;
  for (std::size_t begin = k_lowest; begin <= k_highest; ++begin) {
    std::size_t end = begin;
    while (end <= k_highest && near[end] <= quiet) ++end;
    if (end - begin > best_end - best_begin) best_begin = begin, best_end = end;
    begin = end;
  }
  return 0.5 * static_cast<double>(best_begin + best_end) * k_degree;  // bin i covers [i, i + 1) degrees
}

}  // namespace

double feature_angle_of(const LayerBase& base, const EnvelopeOptions& options, const RunContext& context) {
  return is_automatic(options.feature_angle) ? middle_of_gap(base, context) : options.feature_angle;
}

double decide_feature_angle(const LayerBase& base, const EnvelopeOptions& options, double smooth_angle, const RunContext& context) {
  if (!is_automatic(options.feature_angle)) {
    context.debug("feature angle " + degrees_text(options.feature_angle) + ", as given");
    return options.feature_angle;
  }
  if (!is_automatic(smooth_angle)) {
    const double angle = std::max(static_cast<double>(k_lowest) * k_degree, smooth_angle + k_above_smooth);
    if (angle <= static_cast<double>(k_highest) * k_degree) {
      context.debug("feature angle " + degrees_text(angle) + ": the surface mesh turns by up to " + degrees_text(smooth_angle) + " where the model is smooth");
      return angle;
    }
    context.debug("the surface mesh turns by " + degrees_text(smooth_angle) +
                  " where the model is smooth, too much for a feature angle");  // the surface mesher has already warned of this
  }
  const double angle = middle_of_gap(base, context);
  context.debug("feature angle " + degrees_text(angle) + ", the gap in the histogram of dihedral angles");
  return angle;
}

}  // namespace sterna::volmesh
