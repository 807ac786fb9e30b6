#include "geom/delaunay/insertion_order.h"

#include <algorithm>
#include <bit>

namespace sterna::delaunay {
namespace {

/// Levels of the curve: cells of 2^-26 of the box tell points apart; six bits of the key are left for the round.
constexpr int k_levels = 26;
/// Points of the first round; below, order does not matter.
constexpr std::uint32_t k_first_round_bits = 10;

/// Place along Hilbert's curve of a cell of the 2^k_levels square.
std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y) {
  std::uint64_t key = 0;
  for (int level = k_levels - 1; level >= 0; --level) {
    const std::uint32_t bx = (x >> level) & 1u, by = (y >> level) & 1u;
    key = key << 2 | ((3u * bx) ^ by);
    // Rotate the quadrant so that the curve is continuous.
    if (by == 0) {
      const std::uint32_t mask = bx != 0 ? ~0u : 0u;
      const std::uint32_t old_x = x ^ mask;
      x = y ^ mask;
      y = old_x;
    }
  }
  return key;
}

/// Mixes the bits of an index (splitmix64, Steele 2014): which round a point is in must not depend on where it is.
std::uint64_t scramble(std::uint64_t i) {
  i += 0x9e3779b97f4a7c15u;
  i = (i ^ (i >> 30)) * 0xbf58476d1ce4e5b9u;
  i = (i ^ (i >> 27)) * 0x94d049bb133111ebu;
  return i ^ (i >> 31);
}

struct Place {
  std::uint64_t key;
  std::uint32_t index;
};

}  // namespace

std::vector<std::uint32_t> insertion_order(std::span<const Vec2> points) {
  const std::size_t n = points.size();
  if (n == 0) return {};
  Vec2 low = points[0], high = points[0];
  for (const Vec2& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  const double side = std::max(high.x - low.x, high.y - low.y);
  const double cells = (1u << k_levels) - 1;
  const double scale = side > 0.0 ? cells / side : 0.0;
  // Each round but the first has as many points as all before: the last half of them, the one before a quarter ...
  const int n_bits = static_cast<int>(std::bit_width(n));
  const int n_rounds = std::max(1, n_bits - static_cast<int>(k_first_round_bits));
  std::vector<Place> places(n);
  for (std::size_t i = 0; i < n; ++i) {
    const int before_last = std::min(std::countr_zero(scramble(i)), n_rounds - 1);
    const std::uint64_t round = static_cast<std::uint64_t>(n_rounds - 1 - before_last);
    const auto x = static_cast<std::uint32_t>(std::clamp((points[i].x - low.x) * scale, 0.0, cells));
    const auto y = static_cast<std::uint32_t>(std::clamp((points[i].y - low.y) * scale, 0.0, cells));
    places[i] = {round << (2 * k_levels) | hilbert_key(x, y), static_cast<std::uint32_t>(i)};
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.key != b.key ? a.key < b.key : a.index < b.index; });
  std::vector<std::uint32_t> order(n);
  for (std::size_t i = 0; i < n; ++i) order[i] = places[i].index;
  return order;
}

}  // namespace sterna::delaunay
