// Counts separate locations of items beyond a limit. All nodes of an item belong together. Nodes of different items belong together if they share a cell, so
// cells that touch each other, or touch the same cell, form one location. One pass over all cells joins the nodes of all measures.
#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>
#include <optional>

#include "geom/math/measures.h"
#include "geom/mesh/gate_items.h"

namespace sterna::check_parts {
namespace {

/// Disjoint sets of numbers that any thread may join in any order. The root of a set is its smallest number, so the result does not depend on the order.
class SharedSets {
 public:
  explicit SharedSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  void join(std::uint32_t a, std::uint32_t b) {
    for (;;) {
      a = root(a);
      b = root(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      std::uint32_t expected = a;
      if (std::atomic_ref<std::uint32_t>(parent_[a]).compare_exchange_strong(expected, b, std::memory_order_relaxed)) return;
    }
  }
  std::uint32_t root(std::uint32_t a) {
    for (;;) {
      const std::uint32_t up = std::atomic_ref<std::uint32_t>(parent_[a]).load(std::memory_order_relaxed);
      if (up == a) return a;
      a = up;
    }
  }

 private:
  std::vector<std::uint32_t> parent_;
};

double cell_volume(const HybridMesh& mesh, const Cell& cell) {
  const auto p = [&](std::size_t k) { return mesh.points[cell.nodes[k]]; };
  switch (cell.kind) {
    case CellKind::tetrahedron: return tet_volume(p(0), p(1), p(2), p(3));
    case CellKind::pyramid: return pyramid_volume({p(0), p(1), p(2), p(3), p(4)});
    case CellKind::prism: return wedge_volume({p(0), p(1), p(2), p(3), p(4), p(5)});
    case CellKind::hexahedron: return hexahedron_volume({p(0), p(1), p(2), p(3), p(4), p(5), p(6), p(7)});
  }
  return 0.0;
}

/// Nodes that belong to any of several sets of items, with the sets of each node.
class FlaggedNodes {
 public:
  FlaggedNodes(const HybridMesh& mesh, std::span<const GateExtent* const> sets) : is_flagged_(mesh.points.size(), 0) {
    for (const GateExtent* set : sets)
      for (const std::uint32_t node : set->nodes) is_flagged_[node] = 1;
    for (std::uint32_t node = 0; node < is_flagged_.size(); ++node)
      if (is_flagged_[node] != 0) nodes_.push_back(node);
    sets_of_.assign(nodes_.size(), 0);
    for (std::size_t i = 0; i < sets.size(); ++i)
      for (const std::uint32_t node : sets[i]->nodes) sets_of_[index(node)] |= std::uint64_t{1} << i;
  }
  std::size_t size() const { return nodes_.size(); }
  bool contains(std::uint32_t node) const { return is_flagged_[node] != 0; }
  /// \pre contains(node)
  std::uint32_t index(std::uint32_t node) const { return static_cast<std::uint32_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin()); }
  /// Returns the sets of a node; bit i: the node belongs to set i.
  std::uint64_t sets_of(std::uint32_t index) const { return sets_of_[index]; }

 private:
  std::vector<std::uint8_t> is_flagged_;
  std::vector<std::uint32_t> nodes_;  ///< ascending
  std::vector<std::uint64_t> sets_of_;
};

/// Calls `visit(cell)` for every cell of the mesh, in parallel over ranges of columns, then of explicit cells; sums are gathered chunk by chunk.
template <class Sum, class Visit, class Combine>
Sum over_all_cells(const HybridMesh& mesh, const CellNumbers& cells, const RunContext& context, const Sum& none, const Visit& visit, const Combine& combine) {
  const LayerBlock& layers = mesh.layers;
  Sum sum = parallel_reduce(
      context, layers.n_columns(), none,
      [&](std::size_t begin, std::size_t end) {
        Sum part = none;
        for (std::size_t c = begin; c < end; ++c)
          for (int j = 0, n = layers.layers_of_column(c); j < n; ++j) visit(layers.cell(c, j), part);
        return part;
      },
      combine);
  const std::uint64_t first = cells.first_prism();
  const std::size_t n_explicit = mesh.prisms.size() + mesh.pyramids.size() + mesh.hexahedra.size() + mesh.tetrahedra.size();
  return parallel_reduce(
      context, n_explicit, std::move(sum),
      [&](std::size_t begin, std::size_t end) {
        Sum part = none;
        for (std::size_t i = begin; i < end; ++i) visit(cells.cell(first + i), part);
        return part;
      },
      combine);
}

/// Number of locations and volume of sets of items.
class LocationCount {
 public:
  LocationCount(const HybridMesh& mesh, std::vector<const GateExtent*> sets) : mesh_(mesh), sets_(std::move(sets)), flagged_(mesh, sets_) {
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      SharedSets& joined = joined_.emplace_back(flagged_.size());
      const GateExtent& set = *sets_[i];
      for (std::size_t item = 0; item + 1 < set.first.size(); ++item)
        for (std::uint32_t k = set.first[item] + 1; k < set.first[item + 1]; ++k)
          joined.join(flagged_.index(set.nodes[set.first[item]]), flagged_.index(set.nodes[k]));
    }
  }

  /// Joins the flagged nodes of each cell. Sums for each set the share of the cell volumes that belongs to the set's nodes.
  void walk(const CellNumbers& cells, const RunContext& context) {
    volumes_ = over_all_cells(
        mesh_, cells, context, std::vector<double>(sets_.size(), 0.0), [&](const Cell& cell, std::vector<double>& volumes) { add(cell, volumes); },
        [](std::vector<double> all, const std::vector<double>& more) {
          for (std::size_t i = 0; i < all.size(); ++i) all[i] += more[i];
          return all;
        });
  }

  std::int64_t n_locations(std::size_t set) {
    std::vector<std::uint32_t> roots;
    for (std::uint32_t i = 0; i < flagged_.size(); ++i)
      if ((flagged_.sets_of(i) >> set & 1u) != 0) roots.push_back(joined_[set].root(i));
    std::sort(roots.begin(), roots.end());
    return std::unique(roots.begin(), roots.end()) - roots.begin();
  }

  /// Returns the volume in m^3: that of the cells if the items are cells or have cells; else each node contributes its share of the cells around it.
  double volume(std::size_t set, const CellNumbers& cells) const {
    if (sets_[set]->cells.empty()) return volumes_[set];
    std::vector<std::uint64_t> numbers = sets_[set]->cells;
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    double volume = 0.0;
    for (const std::uint64_t number : numbers) volume += cell_volume(mesh_, cells.cell(number));
    return volume;
  }

 private:
  void add(const Cell& cell, std::vector<double>& volumes) {
    std::array<std::uint32_t, 8> indices{};
    std::size_t n = 0;
    for (const NodeId node : cell.span())
      if (flagged_.contains(node.value())) indices[n++] = flagged_.index(node.value());
    if (n == 0) return;
    const double share = cell_volume(mesh_, cell) / static_cast<double>(cell.span().size());
    std::uint64_t seen = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const std::uint64_t own = flagged_.sets_of(indices[k]);
      for (std::uint64_t left = own; left != 0; left &= left - 1) {
        const auto set = static_cast<std::size_t>(std::countr_zero(left));
        volumes[set] += share;
        if ((seen >> set & 1u) == 0) continue;
        for (std::size_t before = 0; before < k; ++before)
          if ((flagged_.sets_of(indices[before]) >> set & 1u) != 0) {
            joined_[set].join(indices[before], indices[k]);
            break;
          }
      }
      seen |= own;
    }
  }

  const HybridMesh& mesh_;
  std::vector<const GateExtent*> sets_;
  FlaggedNodes flagged_;
  std::vector<SharedSets> joined_;
  std::vector<double> volumes_;
};

/// Items of the gates that decide the verdict for a consumer, as one set.
struct ConsumerItems {
  GateExtent extent;
  bool is_complete = true;  ///< true: every gate keeps all of its items
  std::int64_t n_beyond(Consumer consumer) const {
    std::vector<std::uint64_t> items = extent.cells;
    if (consumer == Consumer::node_centred) items.assign(extent.nodes.begin(), extent.nodes.end());
    std::sort(items.begin(), items.end());
    return std::unique(items.begin(), items.end()) - items.begin();
  }
};

ConsumerItems deciding_items(const CheckReport& report, Consumer consumer) {
  ConsumerItems all;
  const GateState worst = report.quality_state(consumer);
  if (worst != GateState::warn && worst != GateState::fail) return all;
  for (const GateResult& gate : report.gates) {
    if (state_for(gate, consumer) != worst) continue;
    all.is_complete = all.is_complete && (!gate.extent.empty() || gate.n_too_small + gate.n_too_large == 0);
    const auto shift = static_cast<std::uint32_t>(all.extent.nodes.size());
    for (std::size_t item = 1; item < gate.extent.first.size(); ++item) all.extent.first.push_back(shift + gate.extent.first[item]);
    all.extent.nodes.insert(all.extent.nodes.end(), gate.extent.nodes.begin(), gate.extent.nodes.end());
    all.extent.cells.insert(all.extent.cells.end(), gate.extent.cells.begin(), gate.extent.cells.end());
  }
  return all;
}

}  // namespace

void count_locations(const HybridMesh& mesh, const CellNumbers& cells, const RunContext& context, CheckReport& report) {
  static_assert(k_n_measures + k_consumers.size() <= 64);  // bits of FlaggedNodes::sets_of
  std::vector<GateResult*> gates;
  std::vector<const GateExtent*> sets;
  for (GateResult& gate : report.gates) {
    if (gate.extent.empty()) continue;
    gates.push_back(&gate);
    sets.push_back(&gate.extent);
  }
  std::array<ConsumerItems, k_consumers.size()> verdicts;
  for (std::size_t k = 0; k < verdicts.size(); ++k) {
    verdicts[k] = deciding_items(report, k_consumers[k]);
    sets.push_back(&verdicts[k].extent);
  }
  LocationCount count(mesh, sets);
  if (!gates.empty()) count.walk(cells, context);
  for (std::size_t i = 0; i < gates.size(); ++i) {
    gates[i]->n_locations = count.n_locations(i);
    if (info_of(gates[i]->measure).counted != "area" && report.total_volume > 0.0) gates[i]->share_beyond = count.volume(i, cells) / report.total_volume;
  }
  for (std::size_t k = 0; k < verdicts.size(); ++k) {
    ConsumerLocations& locations = report.verdict_locations.emplace_back(ConsumerLocations{.consumer = k_consumers[k], .n_locations = {}});
    locations.n_beyond = verdicts[k].n_beyond(k_consumers[k]);
    if (verdicts[k].is_complete) locations.n_locations = count.n_locations(gates.size() + k);
  }
  for (GateResult* gate : gates) gate->extent = {};
}

}  // namespace sterna::check_parts
