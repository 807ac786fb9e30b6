#include "geom/tets/blocks.h"

#include <algorithm>
#include <array>

#include "geom/base/parallel.h"
#include "geom/tets/hilbert_curve.h"

namespace sterna::tets {

Blocks::Blocks(std::vector<Vec3> points, int n_halvings, double share, const RunContext& context)
    : planes_((std::size_t{1} << n_halvings) - 1), blocks_(std::size_t{1} << n_halvings) {
  std::vector<Block> parts(1);
  std::vector<std::size_t> first = {0, points.size()};  // index of the first point of each part, and the end
  for (std::size_t n = 1; n < blocks_.size(); n *= 2) {
    std::vector<Block> halves(2 * n);
    std::vector<std::size_t> next(2 * n + 1, points.size());
    parallel_for(
        context, n,
        [&](std::size_t i) {
          const std::span<Vec3> own(points.data() + first[i], first[i + 1] - first[i]);
          Plane& plane = planes_[n - 1 + i];
          halves[2 * i] = halves[2 * i + 1] = parts[i];
          next[2 * i] = next[2 * i + 1] = first[i];
          if (!own.empty()) {
            const Extent extent = extent_of(own);
            const Vec3 sides = extent.high - extent.low;
            plane.axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
            const std::size_t n_low = std::min(static_cast<std::size_t>(share * static_cast<double>(own.size())), own.size() - 1);
            std::ranges::nth_element(own, own.begin() + static_cast<std::ptrdiff_t>(n_low), {}, [&](const Vec3& p) { return p[plane.axis]; });
            plane.at = own[n_low][plane.axis];
            const auto middle = std::partition(own.begin(), own.end(), [&](const Vec3& p) { return p[plane.axis] < plane.at; });
            next[2 * i + 1] = first[i] + static_cast<std::size_t>(middle - own.begin());
          }
          halves[2 * i].high[plane.axis] = std::min(halves[2 * i].high[plane.axis], plane.at);
          halves[2 * i + 1].low[plane.axis] = std::max(halves[2 * i + 1].low[plane.axis], plane.at);
        },
        1);
    parts = std::move(halves);
    first = std::move(next);
  }
  blocks_ = std::move(parts);
}

std::size_t Blocks::find(const Vec3& p) const {
  std::size_t i = 0;
  while (i < planes_.size()) i = 2 * i + 1 + (p[planes_[i].axis] >= planes_[i].at ? 1 : 0);
  return i - planes_.size();
}

}  // namespace sterna::tets
