#include "geom/tets/curve.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sterna::tets {
namespace {

constexpr int k_levels = 21;

}  // namespace

Curve::Curve(std::span<const Vec3> points) {
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  Vec3 low{k_infinity, k_infinity, k_infinity}, high = -low;
  for (const Vec3& p : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  const double edge = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  origin_ = low;
  cells_per_metre_ = edge > 0.0 && edge < k_infinity ? (1 << k_levels) / edge : 0.0;
}

/// Level by level: which eighth of the cube in Gray's order, then the cube turned and mirrored so that the next level's path begins where this one's ended
/// (Skilling 2004 has the bits).
std::uint64_t Curve::key(const Vec3& p) const {
  constexpr std::uint32_t k_top = 1u << (k_levels - 1);
  std::array<std::uint32_t, 3> x;
  for (std::size_t axis = 0; axis < 3; ++axis)
    x[axis] = static_cast<std::uint32_t>(std::clamp((p[axis] - origin_[axis]) * cells_per_metre_, 0.0, static_cast<double>((1u << k_levels) - 1)));
  for (std::uint32_t bit = k_top; bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (x[axis] & bit) {
        x[0] ^= below;
      } else {
        const std::uint32_t swapped = (x[0] ^ x[axis]) & below;
        x[0] ^= swapped;
        x[axis] ^= swapped;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t gray = 0;
  for (std::uint32_t bit = k_top; bit > 1; bit >>= 1)
    if (x[2] & bit) gray ^= bit - 1;
  for (std::uint32_t& axis : x) axis ^= gray;
  std::uint64_t key = 0;
  for (int level = k_levels - 1; level >= 0; --level)
    for (const std::uint32_t axis : x) key = key << 1 | std::uint64_t{axis >> level & 1u};
  return key;
}

}  // namespace sterna::tets
