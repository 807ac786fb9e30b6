#include "geom/tets/facets.h"

#include <algorithm>
#include <numeric>

#include "geom/base/parallel.h"

namespace sterna::tets {

FacetIndex::FacetIndex(std::span<const Facet> facets, std::size_t n_points, const RunContext& context) : facets_(facets) {
  first_facet_.assign(n_points + 1, 0);
  for (const Facet& f : facets) ++first_facet_[std::ranges::min(f) + 1];
  std::partial_sum(first_facet_.begin(), first_facet_.end(), first_facet_.begin());
  at_point_.resize(facets.size());
  std::vector<std::uint32_t> next(first_facet_.begin(), first_facet_.end() - 1);
  for (std::uint32_t i = 0; i < facets.size(); ++i) {
    Facet f = facets[i];
    std::ranges::sort(f);
    at_point_[next[f[0]]++] = {f[1], f[2], i};
  }

  // Stores each edge of a facet at its lower corner, then removes duplicates of edges that two facets share.
  std::vector<std::uint32_t> first(n_points + 1, 0);
  const auto each_edge = [&](const auto& f) {
    for (const Facet& corners : facets)
      for (std::size_t i = 0; i < 3; ++i) f(std::minmax(corners[i], corners[(i + 1) % 3]));
  };
  each_edge([&](const auto& edge) { ++first[edge.first + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> ends(first.back());
  next.assign(first.begin(), first.end() - 1);
  each_edge([&](const auto& edge) { ends[next[edge.first]++] = edge.second; });
  first_edge_.assign(n_points + 1, 0);
  parallel_for(context, n_points, [&](std::size_t v) {
    const auto begin = ends.begin() + first[v], end = ends.begin() + first[v + 1];
    std::sort(begin, end);
    first_edge_[v + 1] = static_cast<std::uint32_t>(std::unique(begin, end) - begin);
  });
  std::partial_sum(first_edge_.begin(), first_edge_.end(), first_edge_.begin());
  low_.resize(first_edge_.back());
  high_.resize(first_edge_.back());
  parallel_for(context, n_points, [&](std::size_t v) {
    for (std::uint32_t i = first_edge_[v]; i < first_edge_[v + 1]; ++i) {
      low_[i] = static_cast<std::uint32_t>(v);
      high_[i] = ends[first[v] + (i - first_edge_[v])];
    }
  });
}

std::uint32_t FacetIndex::find_edge(std::uint32_t a, std::uint32_t b) const {
  if (a > b) std::swap(a, b);
  if (a + 1 >= first_edge_.size()) return k_none;
  for (std::uint32_t i = first_edge_[a]; i < first_edge_[a + 1]; ++i)
    if (high_[i] == b) return i;
  return k_none;
}

std::uint32_t FacetIndex::find_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  if (a + 1 >= first_facet_.size()) return k_none;
  for (std::uint32_t i = first_facet_[a]; i < first_facet_[a + 1]; ++i)
    if (at_point_[i].middle == b && at_point_[i].high == c) return at_point_[i].facet;
  return k_none;
}

}  // namespace sterna::tets
