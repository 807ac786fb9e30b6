// Computes orders of graphs, and measures their quality.
#include "geom/mesh/numbering.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "geom/base/error.h"

namespace sterna {
namespace {

constexpr int k_most_restarts = 8;  ///< limit for the search of a peripheral vertex, which usually ends after 2 to 4 restarts

class LevelOrder {
 public:
  explicit LevelOrder(const NeighbourGraph& graph) : graph_(graph), level_(graph.size(), k_none) { order_.reserve(graph.size()); }

  std::vector<std::uint32_t> run() {
    std::vector<std::uint32_t> by_degree(graph_.size());
    std::iota(by_degree.begin(), by_degree.end(), 0u);
    std::ranges::stable_sort(by_degree, {}, [&](std::uint32_t v) { return degree(v); });
    for (const std::uint32_t start : by_degree)
      if (level_[start] == k_none) add_component(start);
    std::ranges::reverse(order_);
    return std::move(order_);
  }

 private:
  std::uint64_t degree(std::uint32_t v) const { return graph_.first[v + 1] - graph_.first[v]; }

  /// Orders all vertices reachable from `start`, after the vertices that are already ordered. \returns the number of levels
  std::uint32_t visit(std::uint32_t start) {
    std::vector<std::uint32_t> fresh;
    const std::size_t begin = order_.size();
    level_[start] = 0;
    order_.push_back(start);
    for (std::size_t i = begin; i < order_.size(); ++i) {
      const std::uint32_t v = order_[i];
      fresh.clear();
      for (std::uint64_t k = graph_.first[v]; k < graph_.first[v + 1]; ++k) {
        const std::uint32_t other = graph_.neighbours[k];
        if (level_[other] != k_none) continue;
        level_[other] = level_[v] + 1;
        fresh.push_back(other);
      }
      std::sort(fresh.begin(), fresh.end(), [&](std::uint32_t a, std::uint32_t b) { return degree(a) != degree(b) ? degree(a) < degree(b) : a < b; });
      order_.insert(order_.end(), fresh.begin(), fresh.end());
    }
    return level_[order_.back()] + 1;
  }

  void forget_from(std::size_t begin) {
    for (std::size_t i = begin; i < order_.size(); ++i) level_[order_[i]] = k_none;
    order_.resize(begin);
  }

  void add_component(std::uint32_t start) {
    const std::size_t begin = order_.size();
    std::uint32_t n_levels = visit(start);
    for (int i = 0; i < k_most_restarts; ++i) {
      // The vertex of the last level with the fewest neighbours is closer to the periphery.
      const std::uint32_t last = level_[order_.back()];
      std::uint32_t next = order_.back();
      for (std::size_t k = order_.size(); k-- > begin && level_[order_[k]] == last;)
        if (std::pair(degree(order_[k]), order_[k]) < std::pair(degree(next), next)) next = order_[k];
      forget_from(begin);
      const std::uint32_t n = visit(next);
      if (n <= n_levels) return;
      n_levels = n;
    }
  }

  const NeighbourGraph& graph_;
  std::vector<std::uint32_t> level_, order_;
};

}  // namespace

Numbering numbering_of(std::string_view name) {
  if (name == "lines") return Numbering::lines;
  if (name == "bandwidth") return Numbering::bandwidth;
  if (name == "both") return Numbering::both;
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "numbering",
               .problem = "unknown numbering \"" + std::string(name) + "\", expected lines, bandwidth or both"});
}

std::vector<std::uint32_t> bandwidth_order(const NeighbourGraph& graph) { return LevelOrder(graph).run(); }

NumberingMeasure measure_numbering(const NeighbourGraph& graph, const std::vector<std::uint32_t>& new_number) {
  NumberingMeasure measure;
  double profile = 0.0;
  const auto number = [&](std::uint32_t v) { return new_number.empty() ? v : new_number[v]; };
  for (std::uint32_t v = 0; v < graph.size(); ++v) {
    std::uint32_t lowest = number(v);
    for (std::uint64_t k = graph.first[v]; k < graph.first[v + 1]; ++k) lowest = std::min(lowest, number(graph.neighbours[k]));
    measure.bandwidth = std::max<std::uint64_t>(measure.bandwidth, number(v) - lowest);
    profile += number(v) - lowest;
  }
  if (graph.size() > 0) measure.mean_profile = profile / static_cast<double>(graph.size());
  return measure;
}

}  // namespace sterna
