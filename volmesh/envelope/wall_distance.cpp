#include "volmesh/envelope/wall_distance.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>
#include <vector>

namespace sterna::volmesh {
namespace {

/// Returns the largest value at c for which the linear function over the triangle (a, b, c) rises by at most `slope` per metre, for given values ha and hb. If
/// the steepest rise to c comes from inside the triangle, this is the eikonal update of Kimmel & Sethian (1998); otherwise the rise along the edges determines
/// the value.
double slope_bound(const Point& a, double ha, const Point& b, double hb, const Point& c, double slope) {
  const double along_edges = std::min(ha + slope * distance(a, c), hb + slope * distance(b, c));
  const Vec3 base = b - a;
  const double length = norm(base);
  if (length == 0.0) return along_edges;
  const Vec3 x = base / length;
  const double rise = (hb - ha) / length;  // derivative of the function along the edge a-b
  if (std::abs(rise) >= slope) return along_edges;
  const Vec3 to_c = c - a;
  const double u = dot(to_c, x);
  const double height = norm(to_c - u * x);
  const double across = std::sqrt(slope * slope - rise * rise);
  const double base_point = u - height * rise / across;  // location at which the line of steepest rise through c intersects a-b
  const double value = ha + rise * u + across * height;
  return base_point > 0.0 && base_point < length && value >= std::max(ha, hb) ? value : along_edges;
}

/// A vertex and a candidate for its value.
using Offer = std::pair<double, std::uint32_t>;

/// Queue of candidate values, smallest first. Most vertices keep their initial value. The initial values are sorted once, and the heap contains only lowered
/// values.
class Offers {
 public:
  explicit Offers(const Column<VertexId, double>& start) {
    start_.reserve(start.size());
    for (const VertexId v : start.ids()) start_.emplace_back(start[v], v.value());
    std::ranges::sort(start_);
  }
  bool empty() const { return n_taken_ == start_.size() && lowered_.empty(); }
  void add(double value, VertexId v) { lowered_.emplace(value, v.value()); }
  VertexId take() {
    if (lowered_.empty() || (n_taken_ < start_.size() && start_[n_taken_] < lowered_.top())) return VertexId(start_[n_taken_++].second);
    const VertexId v(lowered_.top().second);
    lowered_.pop();
    return v;
  }

 private:
  std::vector<Offer> start_;
  std::size_t n_taken_ = 0;
  std::priority_queue<Offer, std::vector<Offer>, std::greater<>> lowered_;
};

}  // namespace

void limit_gradient(const LayerBase& base, double gradient, Column<VertexId, double>& height) {
  Offers offers(height);
  Column<VertexId, std::uint8_t> is_final(height.size(), 0);
  const auto& points = base.wall.points;
  const auto offer = [&](VertexId v, double bound) {
    if (is_final[v] || bound >= height[v]) return;
    height[v] = bound;
    offers.add(bound, v);
  };
  const auto offer_corner = [&](VertexId v, VertexId b, VertexId c) {
    const double along_edge = height[v] + gradient * distance(points[v], points[c]);
    offer(c, is_final[b] ? slope_bound(points[v], height[v], points[b], height[b], points[c], gradient) : along_edge);
  };
  while (!offers.empty()) {
    const VertexId v = offers.take();
    if (is_final[v]) continue;
    is_final[v] = 1;
    for (const HalfedgeId h : base.topology.outgoing(v)) {
      const VertexId b = base.topology.to(h);
      const VertexId c = base.topology.from(previous(h));
      offer_corner(v, b, c);
      offer_corner(v, c, b);
    }
  }
}

}  // namespace sterna::volmesh
