#include "geom/delaunay/insertion_order.h"

#include <algorithm>
#include <array>
#include <bit>

namespace sterna::delaunay {
namespace {

/// Levels of the curve: cells of 2^-26 of the box separate points; six bits of the key remain for the round.
constexpr int k_levels = 26;
/// Points of the first round; among fewer points the order does not matter.
constexpr std::uint32_t k_first_round_bits = 10;

/// Two levels of the Hilbert curve at once: for each of its four orientations and each of 4 x 4 cells, the position of the cell and the orientation within it.
/// Orientation: bit 0 = coordinates exchanged, bit 1 = both mirrored.
struct TwoLevels {
  std::array<std::array<std::uint8_t, 16>, 4> position{};
  std::array<std::array<std::uint8_t, 16>, 4> inner{};
};

constexpr TwoLevels make_two_levels() {
  TwoLevels table;
  for (unsigned orientation = 0; orientation < 4; ++orientation) {
    for (unsigned cell = 0; cell < 16; ++cell) {
      unsigned state = orientation, position = 0;
      for (unsigned level = 2; level-- > 0;) {
        unsigned x = (cell >> (2 + level)) & 1u, y = (cell >> level) & 1u;
        if ((state & 2u) != 0) {
          x ^= 1u;
          y ^= 1u;
        }
        if ((state & 1u) != 0) {
          const unsigned old_x = x;
          x = y;
          y = old_x;
        }
        position = position << 2 | ((3u * x) ^ y);
        // In the first and last quadrant the curve runs along the other diagonal; in the last one also backwards.
        if (y == 0) state ^= x != 0 ? 3u : 1u;
      }
      table.position[orientation][cell] = static_cast<std::uint8_t>(position);
      table.inner[orientation][cell] = static_cast<std::uint8_t>(state);
    }
  }
  return table;
}
constexpr TwoLevels k_two_levels = make_two_levels();

/// Returns the position along the Hilbert curve of a cell of the 2^k_levels square.
std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y) {
  static_assert(k_levels % 2 == 0);
  std::uint64_t key = 0;
  std::uint32_t state = 0;
  for (int shift = k_levels - 2; shift >= 0; shift -= 2) {
    const std::uint32_t cell = ((x >> shift) & 3u) << 2 | ((y >> shift) & 3u);
    key = key << 4 | k_two_levels.position[state][cell];
    state = k_two_levels.inner[state][cell];
  }
  return key;
}

/// Mixes the bits of an index (splitmix64, Steele 2014), because the round of a point must not depend on its position.
std::uint64_t scramble(std::uint64_t i) {
  i += 0x9e3779b97f4a7c15u;
  i = (i ^ (i >> 30)) * 0xbf58476d1ce4e5b9u;
  i = (i ^ (i >> 27)) * 0x94d049bb133111ebu;
  return i ^ (i >> 31);
}

struct KeyedIndex {
  std::uint64_t key;
  std::uint32_t index;
};

/// Returns the indices of points by (round, position on the curve, index).
template <class Round>
std::vector<std::uint32_t> sorted_along_curve(std::span<const Vec2> points, const Round& round_of) {
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
  std::vector<KeyedIndex> locations(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto x = static_cast<std::uint32_t>(std::clamp((points[i].x - low.x) * scale, 0.0, cells));
    const auto y = static_cast<std::uint32_t>(std::clamp((points[i].y - low.y) * scale, 0.0, cells));
    locations[i] = {round_of(i) << (2 * k_levels) | hilbert_key(x, y), static_cast<std::uint32_t>(i)};
  }
  std::sort(locations.begin(), locations.end(), [](const KeyedIndex& a, const KeyedIndex& b) { return a.key != b.key ? a.key < b.key : a.index < b.index; });
  std::vector<std::uint32_t> order(n);
  for (std::size_t i = 0; i < n; ++i) order[i] = locations[i].index;
  return order;
}

}  // namespace

std::vector<std::uint32_t> insertion_order(std::span<const Vec2> points) {
  // Each round except the first has as many points as all before: the last round one half of them, the one before a quarter ...
  const int n_rounds = std::max(1, static_cast<int>(std::bit_width(points.size())) - static_cast<int>(k_first_round_bits));
  return sorted_along_curve(points, [n_rounds](std::size_t i) {
    const int before_last = std::min(std::countr_zero(scramble(i)), n_rounds - 1);
    return static_cast<std::uint64_t>(n_rounds - 1 - before_last);
  });
}

std::vector<std::uint32_t> order_along_curve(std::span<const Vec2> points) {
  return sorted_along_curve(points, [](std::size_t) { return std::uint64_t{0}; });
}

}  // namespace sterna::delaunay
