// Matches sides of columns without making them explicit. Two columns that share a base edge with opposite sense have the same line nodes there, layer by layer.
// The shape of the side (quad, triangle, nothing) follows from the two lines alone, so one test of the base edge proves all its faces. Every edge that is not
// shared by exactly one column in each sense is open. Its faces go to the general matching, which reports the fault or finds their partners.
#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {
namespace {

/// A base edge in the bucket of its lower line.
struct BaseEdge {
  std::uint32_t upper_line;
  std::uint32_t side;  ///< 3 * column + corner
  bool is_reversed;    ///< the column runs from the upper line to the lower one
};

}  // namespace

std::vector<OpenSide> find_open_sides(const LayerBlock& layers, const RunContext& context, std::vector<std::uint32_t>* neighbours) {
  const std::size_t n_lines = layers.n_lines();
  const std::uint64_t n_sides = 3 * layers.n_columns();
  if (n_sides >= 0xffffffffu) throw_id_overflow(n_sides);
  const auto ends_of = [&](std::size_t side) {
    const auto& b = layers.base[side / 3];
    return std::pair(b[side % 3], b[(side % 3 + 1) % 3]);
  };
  std::vector<std::uint64_t> first(n_lines + 1, 0);
  for (std::size_t side = 0; side < n_sides; ++side) {
    const auto [u, v] = ends_of(side);
    ++first[std::min(u, v) + 1];
  }
  for (std::size_t k = 0; k < n_lines; ++k) first[k + 1] += first[k];
  std::vector<BaseEdge> edges(n_sides);
  {
    std::vector<std::uint64_t> cursor(first.begin(), first.end() - 1);
    for (std::size_t side = 0; side < n_sides; ++side) {
      const auto [u, v] = ends_of(side);
      edges[cursor[std::min(u, v)]++] = {std::max(u, v), static_cast<std::uint32_t>(side), u > v};
    }
  }
  if (neighbours) neighbours->assign(n_sides, k_none);
  std::vector<std::uint32_t> open = parallel_reduce(
      context, n_lines, std::vector<std::uint32_t>{},
      [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> found;
        for (std::size_t k = begin; k < end; ++k) {
          BaseEdge* const bucket = edges.data() + first[k];
          const std::size_t n = first[k + 1] - first[k];
          std::sort(bucket, bucket + n, [](const BaseEdge& a, const BaseEdge& b) { return std::pair(a.upper_line, a.side) < std::pair(b.upper_line, b.side); });
          for (std::size_t i = 0, e = 0; i < n; i = e) {
            for (e = i; e < n && bucket[e].upper_line == bucket[i].upper_line;) ++e;
            const bool is_pair = e - i == 2 && bucket[i].is_reversed != bucket[i + 1].is_reversed;
            const bool has_no_faces = layers.is_collapsed[k] && layers.is_collapsed[bucket[i].upper_line];
            if (is_pair && neighbours) {
              (*neighbours)[bucket[i].side] = bucket[i + 1].side / 3;
              (*neighbours)[bucket[i + 1].side] = bucket[i].side / 3;
            }
            if (is_pair || has_no_faces) continue;
            for (std::size_t s = i; s < e; ++s) found.push_back(bucket[s].side);
          }
        }
        return found;
      },
      concatenate<std::uint32_t>);
  std::sort(open.begin(), open.end());
  std::vector<OpenSide> sides;
  sides.reserve(open.size());
  for (const std::uint32_t side : open) sides.push_back({side / 3, static_cast<std::uint8_t>(side % 3)});
  return sides;
}

}  // namespace sterna::check_parts
