#include "volmesh/adjacent/check_adjacent.h"

#include <algorithm>
#include <numeric>

namespace sterna::volmesh {
namespace {

struct Half {
  std::uint32_t from, to;
  std::uint32_t id;  ///< number of the half-edge, 3 * triangle + corner
  friend bool operator<(const Half& a, const Half& b) { return a.from != b.from ? a.from < b.from : a.to != b.to ? a.to < b.to : a.id < b.id; }
};

constexpr std::uint32_t k_no_half = ~0u;

std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }

/// Half-edges, found by their ends. A valid triangulation has only one for each pair of ends.
class HalfTable {
 public:
  explicit HalfTable(std::span<const std::array<std::uint32_t, 3>> triangles) {
    halves_.reserve(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) halves_.push_back({triangles[t][c], triangles[t][(c + 1) % 3], static_cast<std::uint32_t>(3 * t + c)});
    std::sort(halves_.begin(), halves_.end());
  }
  std::span<const Half> halves() const { return halves_; }
  std::uint32_t find(std::uint32_t from, std::uint32_t to) const {
    const auto at = std::lower_bound(halves_.begin(), halves_.end(), Half{from, to, 0});
    return at != halves_.end() && at->from == from && at->to == to ? at->id : k_no_half;
  }

 private:
  std::vector<Half> halves_;
};

class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t j) { parent_[std::max(root(i), root(j))] = std::min(root(i), root(j)); }
  std::int64_t count() const {
    std::int64_t n = 0;
    for (std::uint32_t i = 0; i < parent_.size(); ++i) n += parent_[i] == i ? 1 : 0;
    return n;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Counts components, border loops and Euler number. The corners at a vertex whose triangles share edges form one fan.
void count_topology(const std::vector<std::uint32_t>& twin, AdjacentCheck& check) {
  const std::size_t n_halves = twin.size();
  Groups components(n_halves / 3), fans(n_halves);
  std::int64_t n_border = 0;
  for (std::uint32_t h = 0; h < n_halves; ++h) {
    if (twin[h] == k_no_half) {
      ++n_border;
      continue;
    }
    components.join(h / 3, twin[h] / 3);
    fans.join(h, next(twin[h]));
  }
  std::vector<std::uint8_t> is_seen(n_halves, 0);
  for (std::uint32_t first = 0; first < n_halves; ++first) {
    if (twin[first] != k_no_half || is_seen[first] != 0) continue;
    ++check.n_loops;
    for (std::uint32_t h = first; is_seen[h] == 0;) {
      is_seen[h] = 1;
      // The search turns around the end of h to the outgoing border half-edge in the same fan.
      h = next(h);
      while (twin[h] != k_no_half) h = next(twin[h]);
    }
  }
  check.n_components = components.count();
  const auto n_triangles = static_cast<std::int64_t>(n_halves / 3);
  check.euler_number = fans.count() - (3 * n_triangles + n_border) / 2 + n_triangles;
}

}  // namespace

AdjacentCheck check_adjacent(std::span<const AdjacentEdge> edges, std::span<const std::array<std::uint32_t, 3>> triangles) {
  AdjacentCheck check;
  const HalfTable table(triangles);
  const std::span<const Half> halves = table.halves();
  for (std::size_t i = 1; i < halves.size(); ++i)
    if (halves[i].from == halves[i - 1].from && halves[i].to == halves[i - 1].to) check.repeated.push_back({halves[i].from, halves[i].to});
  std::vector<AdjacentEdge> required(edges.begin(), edges.end());
  std::sort(required.begin(), required.end());
  std::vector<std::uint32_t> twin(3 * triangles.size());
  std::vector<AdjacentEdge> border;
  for (const Half& half : halves) {
    twin[half.id] = table.find(half.to, half.from);
    if (twin[half.id] == k_no_half) border.push_back({half.from, half.to});
  }
  // Both lists are in ascending order.
  std::set_difference(required.begin(), required.end(), border.begin(), border.end(), std::back_inserter(check.missing));
  std::set_difference(border.begin(), border.end(), required.begin(), required.end(), std::back_inserter(check.open));
  for (const AdjacentEdge& edge : check.missing)
    if (std::binary_search(border.begin(), border.end(), AdjacentEdge{edge[1], edge[0]})) check.reversed.push_back(edge);
  if (check.missing.empty() && check.open.empty() && check.repeated.empty()) count_topology(twin, check);
  return check;
}

}  // namespace sterna::volmesh
