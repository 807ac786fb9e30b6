#include "volmesh/improve/improve.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "volmesh/improve/improver.h"
#include "volmesh/improve/remaining.h"
#include "volmesh/improve/tet_quality.h"

namespace sterna::volmesh {
namespace {

using Corners = std::array<std::uint32_t, 4>;

struct Summary {
  std::int64_t n_bad = 0;
  std::int64_t n_bad_free = 0;
  double min_cosine = 1.0;   ///< of the largest angle
  double max_cosine = -1.0;  ///< of the smallest
};

Summary summarise(const TetraBoundary& boundary, const TetraResult& tets, const ImproveOptions& options, const RunContext& context) {
  const std::size_t n_fixed = boundary.points.size();
  const double highest = std::cos(options.improve_min_angle), lowest = std::cos(options.improve_max_angle);
  return parallel_reduce(
      context, tets.tetrahedra.size(), Summary{},
      [&](std::size_t begin, std::size_t end) {
        Summary s;
        for (std::size_t t = begin; t < end; ++t) {
          const Corners& c = tets.tetrahedra[t];
          const auto place = [&](std::uint32_t v) { return v < n_fixed ? boundary.points[v] : tets.new_points[v - n_fixed]; };
          const auto [of_smallest, of_largest] = dihedral_cosines(place(c[0]), place(c[1]), place(c[2]), place(c[3]));
          s.max_cosine = std::max(s.max_cosine, of_smallest);
          s.min_cosine = std::min(s.min_cosine, of_largest);
          if (of_smallest <= highest && of_largest >= lowest) continue;
          ++s.n_bad;
          s.n_bad_free += std::ranges::all_of(c, [&](std::uint32_t v) { return v >= n_fixed; });
        }
        return s;
      },
      [](const Summary& a, const Summary& b) {
        return Summary{a.n_bad + b.n_bad, a.n_bad_free + b.n_bad_free, std::min(a.min_cosine, b.min_cosine), std::max(a.max_cosine, b.max_cosine)};
      });
}

}  // namespace

ImproveReport improve_tetrahedra(const TetraBoundary& boundary, TetraResult& tets, const ImproveOptions& options, const RunContext& context) {
  const Summary before = summarise(boundary, tets, options, context);
  ImproveReport report{.n_bad_before = before.n_bad, .min_angle_before = std::acos(before.max_cosine), .max_angle_before = std::acos(before.min_cosine)};
  Improver improver(boundary, tets, options.improve_min_angle, options.improve_max_angle, context);
  report.rounds = improver.run(options.improve_rounds);
  improver.finish(tets);
  const Summary after = summarise(boundary, tets, options, context);
  report.n_bad_after = after.n_bad;
  report.n_bad_free_after = after.n_bad_free;
  report.min_angle_after = std::acos(after.max_cosine);
  report.max_angle_after = std::acos(after.min_cosine);
  if (report.n_bad_after > 0) list_remaining(boundary, tets, options, report, context);
  return report;
}

}  // namespace sterna::volmesh
