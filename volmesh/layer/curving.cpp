#include "volmesh/layer/curving.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"

namespace sterna::volmesh {
namespace {

constexpr int k_sweeps = 3;  ///< number of averaging sweeps; the minimum filter is surrounded by as many rings of transition

/// Returns `vertices` and all vertices within `rings` edges, ascending.
std::vector<VertexId> dilated(const LayerBase& base, std::vector<VertexId> vertices, int rings) {
  std::vector<VertexId> front = vertices;
  const auto make_unique = [](std::vector<VertexId>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  make_unique(vertices);
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<VertexId> around, fresh, all;
    for (const VertexId v : front) {
      const auto neighbours = base.topology.neighbours(v);
      around.insert(around.end(), neighbours.begin(), neighbours.end());
    }
    make_unique(around);
    std::set_difference(around.begin(), around.end(), vertices.begin(), vertices.end(), std::back_inserter(fresh));
    std::merge(vertices.begin(), vertices.end(), fresh.begin(), fresh.end(), std::back_inserter(all));
    vertices = std::move(all);
    front = std::move(fresh);
  }
  return vertices;
}

}  // namespace

Curving::Curving(Borrowed<const LayerBase> base, double target)
    : base_(base), target_(target), c_t_(base->wall.n_vertices(), target), limit_(base->wall.n_vertices(), target) {}

void Curving::limit(VertexId v, double c_t) {
  for_each_alike(base_, v, [&](VertexId w) {
    if (c_t >= limit_[w]) return;
    if (limit_[w] == target_) limited_.push_back(w);
    limit_[w] = c_t;
  });
}

std::vector<VertexId> Curving::smooth(const RunContext& context) {
  std::vector<VertexId> region = dilated(base_, limited_, 1 + k_sweeps);
  if (!base_.groups.empty()) {
    std::vector<VertexId> alike;
    for (const VertexId v : region) for_each_alike(base_, v, [&](VertexId w) { alike.push_back(w); });
    std::sort(alike.begin(), alike.end());
    alike.erase(std::unique(alike.begin(), alike.end()), alike.end());
    region = std::move(alike);
  }
  std::vector<double> before(region.size()), next(region.size());
  const auto sweep = [&](const auto& value) {
    parallel_for(context, region.size(), [&](std::size_t i) { next[i] = value(region[i]); });
    parallel_for(context, region.size(), [&](std::size_t i) { c_t_[region[i]] = next[i]; });
  };
  for (std::size_t i = 0; i < region.size(); ++i) before[i] = c_t_[region[i]];
  sweep([&](VertexId v) {
    double least = limit_[v];
    for (const VertexId other : base_.topology.neighbours(v)) least = std::min(least, limit_[other]);
    return least;
  });
  for (int k = 0; k < k_sweeps; ++k)
    sweep([&](VertexId v) {
      const auto around = base_.topology.neighbours(v);
      double sum = 0.0;
      for (const VertexId other : around) sum += c_t_[other];
      return std::min(limit_[v], 0.5 * (c_t_[v] + sum / static_cast<double>(around.size())));
    });
  if (!base_.groups.empty())
    sweep([&](VertexId v) {
      double least = c_t_[v];
      for_each_alike(base_, v, [&](VertexId w) { least = std::min(least, c_t_[w]); });
      return least;
    });
  std::vector<VertexId> changed;
  for (std::size_t i = 0; i < region.size(); ++i)
    if (c_t_[region[i]] != before[i]) changed.push_back(region[i]);
  return changed;
}

std::array<std::int64_t, 5> Curving::distribution() const {
  std::array<std::int64_t, 5> count{};
  for (const double c : c_t_) {
    if (c >= target_) continue;
    ++count[c <= 0.0 ? 0 : std::min<std::size_t>(1 + static_cast<std::size_t>(4.0 * c / target_), 4)];
  }
  return count;
}

}  // namespace sterna::volmesh
