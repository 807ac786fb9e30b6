#include "volmesh/envelope/layer_folds.h"

#include <algorithm>

#include "geom/base/parallel.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

constexpr double k_watched_cosine = 0.5;  ///< cosine of the angle between the normals; the angle between the triangles is then 120 degrees

bool is_watched(const Fold& fold) { return fold.is_concave && fold.cosine < k_watched_cosine; }

}  // namespace

LayerFolds::LayerFolds(const LayerBase& base, const Envelope& start, const std::vector<std::uint8_t>& is_moving, const RunContext& context) {
  using List = std::vector<HalfedgeId>;
  const List watched = parallel_reduce(
      context, base.topology.n_halfedges(), List{},
      [&](std::size_t begin, std::size_t end) {
        List list;
        for (std::size_t i = begin; i < end; ++i) {
          const HalfedgeId h(i);
          if (base.topology.is_boundary(h) || base.topology.twin(h) < h) continue;
          const EdgeDiamond diamond = edge_diamond(base, h);
          if (std::none_of(diamond.begin(), diamond.end(), [&](VertexId v) { return is_moving[v.index()] != 0; })) continue;
          if (is_watched(fold_of(wall_points(base, diamond))) || is_watched(fold_of(envelope_points(base, start, diamond)))) list.push_back(h);
        }
        return list;
      },
      [](List a, const List& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
  for (const HalfedgeId h : watched) {
    const EdgeDiamond diamond = edge_diamond(base, h);
    corners_.push_back({diamond[0].value(), diamond[1].value(), diamond[2].value(), diamond[3].value()});
    limits_.push_back(fold_limit(wall_points(base, diamond)));
  }
  index(base.wall.n_vertices());
}

void LayerFolds::index(std::size_t n_vertices) {
  first_.assign(n_vertices + 1, 0);
  for (const Corners& corners : corners_)
    for (const std::uint32_t v : corners) ++first_[v + 1];
  for (std::size_t v = 0; v < n_vertices; ++v) first_[v + 1] += first_[v];
  list_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t fold = 0; fold < corners_.size(); ++fold)
    for (const std::uint32_t v : corners_[fold]) list_[next[v]++] = fold;
}

std::vector<std::uint32_t> LayerFolds::drop_infeasible(const LayerBase& base, const Envelope& start) {
  std::vector<std::uint32_t> stuck;
  std::size_t kept = 0;
  for (std::size_t fold = 0; fold < corners_.size(); ++fold) {
    const Corners& c = corners_[fold];
    const EdgeDiamond diamond = {VertexId(c[0]), VertexId(c[1]), VertexId(c[2]), VertexId(c[3])};
    if (fold_slack(fold_of(envelope_points(base, start, diamond)), limits_[fold]) > 0.0) {
      corners_[kept] = c;
      limits_[kept++] = limits_[fold];
    } else {
      stuck.insert(stuck.end(), c.begin(), c.end());
    }
  }
  corners_.resize(kept);
  limits_.resize(kept);
  index(base.wall.n_vertices());
  return stuck;
}

}  // namespace sterna::volmesh
