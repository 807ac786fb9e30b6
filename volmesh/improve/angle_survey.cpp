#include "volmesh/improve/angle_survey.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"

namespace sterna::volmesh {
namespace {

constexpr std::size_t k_scan_chunk = 1 << 15;
/// Tolerance for the rounding difference between tet_quality() and the angles.
constexpr double k_rounding = 1e-9;

}  // namespace

AngleSurvey survey_angles(const TetraBoundary& boundary, const TetraResult& tets, const QualityLimits& limits, const RunContext& context) {
  struct Part {
    double max_cosine = -1.0;  ///< cosine of the smallest angle
    double min_cosine = 1.0;
    std::int64_t n_at_boundary = 0;
    std::vector<std::uint32_t> bad;
  };
  const std::size_t n_fixed = boundary.points.size();
  const auto location = [&](std::uint32_t v) -> const Vec3& { return v < n_fixed ? boundary.points[v] : tets.new_points[v - n_fixed]; };
  const Part all = parallel_reduce(
      context, tets.tetrahedra.size(), Part{},
      [&](std::size_t begin, std::size_t end) {
        Part part;
        double quality_of_interest = 1.0;  ///< tetrahedra of higher quality cannot contain a new extreme angle
        for (std::size_t t = begin; t < end; ++t) {
          const auto& c = tets.tetrahedra[t];
          part.n_at_boundary += std::min({c[0], c[1], c[2], c[3]}) < n_fixed;
          const Vec3 &p0 = location(c[0]), &p1 = location(c[1]), &p2 = location(c[2]), &p3 = location(c[3]);
          const double quality = tet_quality(p0, p1, p2, p3, limits.obtuse_weight);
          if (quality < limits.target) part.bad.push_back(static_cast<std::uint32_t>(t));
          if (quality > quality_of_interest * (1.0 + k_rounding)) continue;
          const auto [of_smallest, of_largest] = dihedral_cosines(p0, p1, p2, p3);
          part.max_cosine = std::max(part.max_cosine, of_smallest);
          part.min_cosine = std::min(part.min_cosine, of_largest);
          const double acute = part.max_cosine > 0.0 ? std::sqrt(1.0 - part.max_cosine * part.max_cosine) : 1.0;
          const double obtuse = part.min_cosine < 0.0 ? limits.obtuse_weight * std::sqrt(1.0 - part.min_cosine * part.min_cosine) : 1.0;
          quality_of_interest = std::max(acute, obtuse);
        }
        return part;
      },
      [](Part a, const Part& b) {
        a.max_cosine = std::max(a.max_cosine, b.max_cosine);
        a.min_cosine = std::min(a.min_cosine, b.min_cosine);
        a.n_at_boundary += b.n_at_boundary;
        a.bad.insert(a.bad.end(), b.bad.begin(), b.bad.end());
        return a;
      },
      k_scan_chunk);
  return {std::acos(all.max_cosine), std::acos(all.min_cosine), all.n_at_boundary, all.bad};
}

}  // namespace sterna::volmesh
