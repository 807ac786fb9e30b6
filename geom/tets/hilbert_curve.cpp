#include "geom/tets/hilbert_curve.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sterna::tets {
namespace {

constexpr int k_curve_levels = 21;

/// Returns the bits of a number with two zeros between any two.
constexpr std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffffull;
  x = (x | x << 16) & 0x001f0000ff0000ffull;
  x = (x | x << 8) & 0x100f00f00f00f00full;
  x = (x | x << 4) & 0x10c30c30c30c30c3ull;
  x = (x | x << 2) & 0x1249249249249249ull;
  return x;
}

}  // namespace

Extent extent_of(std::span<const Vec3> points) {
  constexpr double k_infinity = std::numeric_limits<double>::infinity();
  Extent extent{{k_infinity, k_infinity, k_infinity}, {-k_infinity, -k_infinity, -k_infinity}};
  for (const Vec3& p : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      extent.low[axis] = std::min(extent.low[axis], p[axis]);
      extent.high[axis] = std::max(extent.high[axis], p[axis]);
    }
  }
  return extent;
}

Curve::Curve(std::span<const Vec3> points) {
  const Extent extent = extent_of(points);
  const double edge = extent.longest_side();
  origin_ = extent.low;
  cells_per_metre_ = edge > 0.0 && edge < std::numeric_limits<double>::infinity() ? (1 << k_curve_levels) / edge : 0.0;
}

/// Computes the key level by level. The octant of the cube gives the next digits in Gray order. Then the cube is rotated and reflected so that the path of the
/// next level begins where this one ended (bit operations: Skilling 2004).
std::uint64_t Curve::key(const Vec3& p) const {
  std::array<std::uint32_t, 3> x;
  for (std::size_t axis = 0; axis < 3; ++axis)
    x[axis] = static_cast<std::uint32_t>(std::clamp((p[axis] - origin_[axis]) * cells_per_metre_, 0.0, static_cast<double>((1u << k_curve_levels) - 1)));
  for (int level = k_curve_levels - 1; level > 0; --level) {
    const std::uint32_t below = (1u << level) - 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {  // the cube is reflected if the bit is set, else rotated; without branches
      const std::uint32_t is_set = 0u - (x[axis] >> level & 1u);
      const std::uint32_t swapped = (x[0] ^ x[axis]) & below & ~is_set;
      x[axis] ^= swapped;
      x[0] ^= axis == 0 ? below & is_set : swapped ^ (below & is_set);
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t gray = x[2] >> 1;  // parity of the higher bits, for each bit
  for (const int shift : {1, 2, 4, 8, 16}) gray ^= gray >> shift;
  return spread(x[0] ^ gray) << 2 | spread(x[1] ^ gray) << 1 | spread(x[2] ^ gray);
}

}  // namespace sterna::tets
