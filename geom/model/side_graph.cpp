// Half-edges are sorted by angle around every node. Each face is then traversed so that it lies on the left (de Berg et al., Computational Geometry, ch. 2).
#include "geom/model/side_graph.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geom/base/error.h"

namespace sterna {

void SideGraph::add(EdgeId edge, Uv from, Uv to, Mark left, Mark right) {
  if (!(from == to)) lines_.push_back({edge, from, to, left, right});
}

std::vector<SideGraph::Loop> SideGraph::loops() const {
  // Half-edge 2 i runs along line i, 2 i + 1 against it.
  const auto from = [&](std::size_t h) { return h % 2 == 0 ? lines_[h / 2].from : lines_[h / 2].to; };
  const auto to = [&](std::size_t h) { return from(h ^ 1u); };
  const auto angle = [&](std::size_t h) { return std::atan2(to(h).v - from(h).v, to(h).u - from(h).u); };
  std::map<std::pair<double, double>, std::vector<std::size_t>> leaving;
  for (std::size_t h = 0; h < 2 * lines_.size(); ++h) leaving[{from(h).u, from(h).v}].push_back(h);
  for (auto& [location, around] : leaving) std::sort(around.begin(), around.end(), [&](std::size_t a, std::size_t b) { return angle(a) < angle(b); });
  const auto next = [&](std::size_t h) {  // the first half-edge clockwise from the previous one
    const std::vector<std::size_t>& around = leaving.at({to(h).u, to(h).v});
    const auto back = std::find(around.begin(), around.end(), h ^ 1u);
    return back == around.begin() ? around.back() : *(back - 1);
  };
  std::vector<Loop> loops;
  std::vector<bool> is_done(2 * lines_.size(), false);
  for (std::size_t start = 0; start < 2 * lines_.size(); ++start) {
    if (is_done[start]) continue;
    Loop loop;
    double area = 0.0;
    for (std::size_t h = start; !is_done[h]; h = next(h)) {
      is_done[h] = true;
      const Line& line = lines_[h / 2];
      loop.sides.push_back({line.edge, from(h), to(h)});
      area += 0.5 * (from(h).u * to(h).v - to(h).u * from(h).v);
      if (!loop.mark) loop.mark = h % 2 == 0 ? line.left : line.right;
    }
    if (area > 0.0) loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace sterna
