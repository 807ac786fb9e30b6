// Computes the metrics of all nodes. Inner nodes of regular lines are measured by LineDual, all others ("special") by NodeDual, which needs the explicit
// cells and boundary faces around a node. The two algorithms agree to rounding; tests compare them with each other and with loops over edges.
#include "geom/mesh/dual_metrics.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "geom/math/constants.h"
#include "geom/mesh/dual_parts.h"
#include "geom/mesh/layer_scans.h"

namespace sterna {
namespace {

using namespace dual_parts;
using check_parts::k_line_chunk;

/// Nodes per chunk, as k_line_chunk.
constexpr std::size_t k_node_chunk = 4096;
/// Corners held at a time: 256 MB.
constexpr std::uint64_t k_most_corners = std::uint64_t{1} << 26;

/// Calls f(number, nodes) for the explicit cells and boundary faces numbered [begin, end), with the numbers of NodeDual.
template <class F>
void for_each_explicit(const HybridMesh& mesh, const RunContext& context, const F& f) {
  std::uint32_t first = 0;
  const auto block = [&](const auto& entities, const auto& nodes_of) {
    parallel_for(context, entities.size(), [&](std::size_t i) { f(static_cast<std::uint32_t>(first + i), std::span<const NodeId>(nodes_of(entities[i]))); });
    first += static_cast<std::uint32_t>(entities.size());
  };
  const auto itself = [](const auto& nodes) -> const auto& { return nodes; };
  const auto of_face = [](const auto& face) -> const auto& { return face.nodes; };
  block(mesh.prisms, itself);
  block(mesh.pyramids, itself);
  block(mesh.hexahedra, itself);
  block(mesh.tetrahedra, itself);
  block(mesh.boundary_triangles, of_face);
  block(mesh.boundary_quads, of_face);
}

class DualWalk {
 public:
  DualWalk(const HybridMesh& mesh, const RunContext& context)
      : mesh_(mesh), context_(context), rings_(mesh.layers), is_regular_(find_regular_lines(mesh.layers, rings_, context)), special_(mesh.points.size()) {
    const LayerBlock& layers = mesh.layers;
    parallel_for(context, layers.n_lines(), [&](std::size_t k) {
      if (rings_.columns(static_cast<std::uint32_t>(k)).empty()) return;
      for (std::uint32_t j = 0, n = n_nodes(k); j < n; ++j)
        if (is_regular_[k] == 0 || j == 0 || j + 1 == n) special_.insert(layers.first_node[k] + j);
    });
    for_each_explicit(mesh, context, [&](std::uint32_t, std::span<const NodeId> nodes) {
      for (const NodeId node : nodes) special_.insert(node.index());
    });
    special_.number();
    nodes_ = special_.members();
    line_of_.assign(nodes_.size(), NodeId::k_invalid);
    parallel_for(context, layers.n_lines(), [&](std::size_t k) {
      for (std::uint32_t j = 0, n = n_nodes(k); j < n; ++j)
        if (special_.contains(layers.first_node[k] + j)) line_of_[special_.index(layers.first_node[k] + j)] = static_cast<std::uint32_t>(k);
    });
  }

  template <class Part>
  struct WithSuspects {
    Part part;
    std::vector<std::uint64_t> suspects;
  };

  /// Returns true if explicit cells or boundary faces touch a node that only lines() should cover.
  bool has_special_inner_node() const {
    const LayerBlock& layers = mesh_.layers;
    return parallel_reduce(
        context_, layers.n_lines(), false,
        [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k)
            for (std::uint32_t j = 1, n = n_nodes(k); is_regular_[k] != 0 && j + 1 < n; ++j)
              if (special_.contains(layers.first_node[k] + j)) return true;
          return false;
        },
        [](bool a, bool b) { return a || b; });
  }

  /// Adds the nodes of lines() on a range of lines. `take(part, node, metrics)` adds a node.
  template <class Part, class Take>
  void add_lines(std::size_t begin, std::size_t end, const Take& take, WithSuspects<Part>& part) const {
    LineDual lines(mesh_, rings_);
    for (std::size_t k = begin; k < end; ++k) {
      if (is_regular_[k] == 0) continue;
      std::uint32_t node = mesh_.layers.first_node[k];
      for (const NodeMetrics& metrics : lines.measure(static_cast<std::uint32_t>(k)))
        if (!special_.contains(++node)) take(part.part, node, metrics);
    }
    part.suspects = lines.take_suspects();
  }

  /// Measures the inner nodes of regular lines. `make()` returns an empty part; `take(part, node, metrics)` adds a node to it; `merge(all, part)`.
  template <class Part, class Make, class Take, class Merge>
  WithSuspects<Part> lines(const Make& make, const Take& take, const Merge& merge) const {
    return parallel_reduce(
        context_, mesh_.layers.n_lines(), WithSuspects<Part>{make(), {}},
        [&](std::size_t begin, std::size_t end) {
          WithSuspects<Part> part{make(), {}};
          add_lines(begin, end, take, part);
          return part;
        },
        joined<Part>(merge), k_line_chunk);
  }

  /// Measures all nodes that lines() leaves out, and adds them to its result.
  template <class Part, class Make, class Take, class Merge>
  WithSuspects<Part> others(WithSuspects<Part> all, const Make& make, const Take& take, const Merge& merge) const {
    std::vector<std::uint32_t> cursor(nodes_.size(), 0);
    for_each_explicit(mesh_, context_, [&](std::uint32_t, std::span<const NodeId> nodes) {
      for (const NodeId node : nodes) std::atomic_ref<std::uint32_t>(cursor[special_.index(node.index())]).fetch_add(1, std::memory_order_relaxed);
    });
    std::vector<std::uint64_t> first(nodes_.size() + 1, 0);
    for (std::size_t i = 0; i < nodes_.size(); ++i) first[i + 1] = first[i] + cursor[i];
    std::vector<std::uint32_t> corners;
    for (std::size_t begin_node = 0; begin_node < nodes_.size();) {
      std::size_t end_node = begin_node + 1;
      while (end_node < nodes_.size() && first[end_node + 1] - first[begin_node] <= k_most_corners) ++end_node;
      const std::uint64_t first_corner = first[begin_node];
      corners.resize(first[end_node] - first_corner);
      std::fill(cursor.begin() + static_cast<std::ptrdiff_t>(begin_node), cursor.begin() + static_cast<std::ptrdiff_t>(end_node), 0u);
      for_each_explicit(mesh_, context_, [&](std::uint32_t number, std::span<const NodeId> nodes) {
        for (const NodeId node : nodes) {
          const std::size_t i = special_.index(node.index());
          if (i < begin_node || i >= end_node) continue;
          corners[first[i] - first_corner + std::atomic_ref<std::uint32_t>(cursor[i]).fetch_add(1, std::memory_order_relaxed)] = number;
        }
      });
      all = parallel_reduce(
          context_, end_node - begin_node, std::move(all),
          [&](std::size_t begin, std::size_t end) {
            WithSuspects<Part> part{make(), {}};
            NodeDual nodes(mesh_, rings_);
            for (std::size_t i = begin_node + begin; i < begin_node + end; ++i) {
              const std::span<std::uint32_t> around(corners.data() + (first[i] - first_corner), first[i + 1] - first[i]);
              std::sort(around.begin(), around.end());  // the corners were filled in no particular order
              take(part.part, nodes_[i], nodes.measure(nodes_[i], line_of_[i], around));
            }
            part.suspects = nodes.take_suspects();
            return part;
          },
          joined<Part>(merge), k_node_chunk);
      begin_node = end_node;
    }
    std::sort(all.suspects.begin(), all.suspects.end());
    all.suspects.erase(std::unique(all.suspects.begin(), all.suspects.end()), all.suspects.end());
    return all;
  }

 private:
  template <class Part, class Merge>
  static auto joined(const Merge& merge) {
    return [&merge](WithSuspects<Part> all, WithSuspects<Part> more) {
      merge(all.part, std::move(more.part));
      all.suspects.insert(all.suspects.end(), more.suspects.begin(), more.suspects.end());
      return all;
    };
  }
  std::uint32_t n_nodes(std::size_t line) const { return static_cast<std::uint32_t>(mesh_.layers.n_steps(line)) + 1u; }

  const HybridMesh& mesh_;
  const RunContext& context_;
  LineRings rings_;
  std::vector<std::uint8_t> is_regular_;
  NodeSubset special_;
  std::vector<std::uint32_t> nodes_;    ///< the special nodes, ascending
  std::vector<std::uint32_t> line_of_;  ///< line of each special node; NodeId::k_invalid = on no line
};

}  // namespace

DualScan::DualScan(const GateTable& limits)
    : closure(info_of(Measure::dual_closure), limits[Measure::dual_closure]),
      orthogonality(info_of(Measure::orthogonality), limits[Measure::orthogonality]),
      sub_volume_ratio(info_of(Measure::sub_volume_ratio), limits[Measure::sub_volume_ratio]),
      face_area_ratio(info_of(Measure::face_area_ratio), limits[Measure::face_area_ratio]),
      relative_face_area_ratio(info_of(Measure::relative_face_area_ratio), limits[Measure::relative_face_area_ratio]),
      edge_ratio(info_of(Measure::edge_ratio), limits[Measure::edge_ratio]) {}

void DualScan::add(std::uint64_t node, const NodeMetrics& metrics) {
  if (std::isnan(metrics.closure)) return;  // no cells
  closure.add(metrics.closure, node);
  orthogonality.add(metrics.orthogonality, node);
  sub_volume_ratio.add(metrics.sub_volume_ratio, node);
  face_area_ratio.add(metrics.face_area_ratio, node);
  if (!std::isnan(metrics.relative_face_area_ratio)) relative_face_area_ratio.add(metrics.relative_face_area_ratio, node);
  if (!std::isnan(metrics.edge_ratio)) edge_ratio.add(metrics.edge_ratio, node);
  volume.add(metrics.volume);
}

void DualScan::merge(DualScan&& other) {
  closure.merge(other.closure);
  orthogonality.merge(other.orthogonality);
  sub_volume_ratio.merge(other.sub_volume_ratio);
  face_area_ratio.merge(other.face_area_ratio);
  relative_face_area_ratio.merge(other.relative_face_area_ratio);
  edge_ratio.merge(other.edge_ratio);
  volume.add(other.volume);
}

namespace {

/// Callbacks with which DualWalk fills a DualScan.
struct ScanSteps {
  const GateTable& limits;
  auto make() const {
    return [this] { return DualScan(limits); };
  }
  static void take(DualScan& part, std::uint32_t node, const NodeMetrics& metrics) { part.add(node, metrics); }
  static void merge(DualScan& all, DualScan&& part) { all.merge(std::move(part)); }
};

DualScan with_suspects(DualWalk::WithSuspects<DualScan> found) {
  found.part.suspects = std::move(found.suspects);
  return std::move(found.part);
}

}  // namespace

DualScan scan_dual(const HybridMesh& mesh, const GateTable& limits, const RunContext& context, const DualScan* lines) {
  const DualWalk walk(mesh, context);
  const ScanSteps steps{limits};
  DualWalk::WithSuspects<DualScan> found = lines && !walk.has_special_inner_node() ? DualWalk::WithSuspects<DualScan>{*lines, lines->suspects}
                                                                                   : walk.lines<DualScan>(steps.make(), steps.take, steps.merge);
  return with_suspects(walk.others<DualScan>(std::move(found), steps.make(), steps.take, steps.merge));
}

DualScan scan_lines(const HybridMesh& mesh, const GateTable& limits, const RunContext& context) {
  const ScanSteps steps{limits};
  return with_suspects(DualWalk(mesh, context).lines<DualScan>(steps.make(), steps.take, steps.merge));
}

namespace check_parts {

DualScan joined(DualScan all, DualScan more) {
  all.suspects.insert(all.suspects.end(), more.suspects.begin(), more.suspects.end());
  all.merge(std::move(more));
  return all;
}

void fill_lines(ScanChunks<DualScan>& chunks, const HybridMesh& mesh, const GateTable& limits, const RunContext& context) {
  const DualWalk walk(mesh, context);
  chunks.fill(context, [&](std::size_t begin, std::size_t end) {
    DualWalk::WithSuspects<DualScan> part{DualScan(limits), {}};
    walk.add_lines(begin, end, ScanSteps::take, part);
    return with_suspects(std::move(part));
  });
}

}  // namespace check_parts

Column<NodeId, NodeMetrics> dual_metrics(const HybridMesh& mesh, const RunContext& context) {
  Column<NodeId, NodeMetrics> result(mesh.points.size(), NodeMetrics{k_nan, k_nan, k_nan, k_nan, k_nan, k_nan, 0.0});
  struct Nothing {};
  const DualWalk walk(mesh, context);
  const auto make = [] { return Nothing{}; };
  const auto take = [&](Nothing&, std::uint32_t node, const NodeMetrics& m) { result.raw()[node] = m; };
  const auto merge = [](Nothing&, Nothing&&) {};
  walk.others<Nothing>(walk.lines<Nothing>(make, take, merge), make, take, merge);
  return result;
}

}  // namespace sterna
