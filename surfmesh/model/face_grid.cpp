#include "surfmesh/model/face_grid.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace sterna::surfmesh {
namespace {

/// Largest length of a cell, relative to the target edge. Bilinear interpolation is then within about 5 % of sizes that grow by 0.2.
constexpr double k_cell_sizes = 2.0;
/// Sources larger than this fraction of the largest size are ignored.
constexpr double k_level = 0.999;
/// Node coordinates in a direction are multiples of 1 / 2^24 of the box.
constexpr int k_levels = 24;
/// Smallest number of halvings in each direction for a curved face. Without it a cell whose ends meet would count as small.
constexpr int k_least_levels = 3;
/// Number of border segments per bin of the inside test, and largest number of bins.
constexpr std::size_t k_per_bin = 4, k_most_bins = 2048;

/// Nodes on the border of the box are tested farther inside: they are moved by this fraction of the distance to the middle of the box.
constexpr double k_grid_inwards = 1e-6;

struct Segment {
  Uv a, b;
};

/// Tests if a point is inside by the parity of crossings. Segments are sorted into bins of u.
class Inside {
 public:
  explicit Inside(std::span<const std::vector<Uv>> loops) {
    for (const std::vector<Uv>& loop : loops)
      for (std::size_t i = 0; i < loop.size(); ++i) segments_.push_back({loop[i], loop[(i + 1) % loop.size()]});
    if (segments_.empty()) return;
    low_ = high_ = segments_.front().a.u;
    for (const Segment& s : segments_) {
      low_ = std::min({low_, s.a.u, s.b.u});
      high_ = std::max({high_, s.a.u, s.b.u});
    }
    bins_.resize(std::clamp<std::size_t>(segments_.size() / k_per_bin, 1, k_most_bins));
    for (std::uint32_t i = 0; i < segments_.size(); ++i)
      for (std::size_t b = bin_of(std::min(segments_[i].a.u, segments_[i].b.u)); b <= bin_of(std::max(segments_[i].a.u, segments_[i].b.u)); ++b)
        bins_[b].push_back(i);
  }
  const std::vector<Segment>& segments() const { return segments_; }
  bool operator()(Uv at) const {
    if (segments_.empty()) return true;
    if (at.u < low_ || at.u > high_) return false;
    bool is_inside = false;
    for (const std::uint32_t i : bins_[bin_of(at.u)]) {
      const auto& [a, b] = segments_[i];
      if ((a.u <= at.u) != (b.u <= at.u) && a.v + (at.u - a.u) / (b.u - a.u) * (b.v - a.v) > at.v) is_inside = !is_inside;
    }
    return is_inside;
  }

 private:
  std::size_t bin_of(double u) const {
    const double share = high_ > low_ ? (u - low_) / (high_ - low_) : 0.0;
    return static_cast<std::size_t>(std::clamp(share * static_cast<double>(bins_.size()), 0.0, static_cast<double>(bins_.size() - 1)));
  }
  std::vector<Segment> segments_;
  std::vector<std::vector<std::uint32_t>> bins_;
  double low_ = 0.0, high_ = 0.0;
};

}  // namespace

class FaceGridBuilder {
 public:
  FaceGridBuilder(FaceGrid& grid, const Surface& surface, std::span<const std::vector<Uv>> loops, const FaceGrid::Bounds& bounds)
      : grid_(grid), surface_(surface), bounds_(bounds), inside_(loops), least_levels_(surface.kind() == "plane" ? 0 : k_least_levels) {}

  void run() {
    Cell root{.tree = 0, .u = 0, .v = 0, .levels_u = 0, .levels_v = 0, .corners = {}};
    for (std::uint32_t k = 0; k < 4; ++k) root.corners[k] = node_at((k & 1u) << k_levels, (k >> 1u) << k_levels);
    for (std::uint32_t i = 0; i < inside_.segments().size(); ++i) crossing_.push_back(i);
    grid_.tree_.push_back(0);
    divide(root, 0, crossing_.size(), false);
    for (FaceGridCell& cell : grid_.leaves_)
      if (cell.is_used)
        for (const std::uint32_t n : cell.nodes) is_needed_[n] = 1;
    for (std::uint32_t n = 0; n < grid_.nodes_.size(); ++n)
      if (is_needed_[n] != 0 && !grid_.nodes_[n].is_inside) grid_.nodes_[n].is_inside = inside_(inwards(grid_.nodes_[n].uv));
    find_hanging();
  }

 private:
  struct Cell {
    std::uint32_t tree;      ///< index in grid_.tree_
    std::uint32_t u, v;      ///< lower corner, in 1 / 2^k_levels of the box
    int levels_u, levels_v;  ///< halvings so far
    std::array<std::uint32_t, 4> corners;
  };

  /// Moves a node on the border of the box inwards, so that it counts as inside of polygons that run along the border.
  Uv inwards(Uv at) const {
    const ParameterBox& box = grid_.box_;
    const auto moved = [](const Interval& range, double t) { return t + k_grid_inwards * (0.5 * (range.from + range.to) - t); };
    return {moved(box.u, at.u), moved(box.v, at.v)};
  }

  std::uint32_t node_at(std::uint32_t u, std::uint32_t v) {
    const auto [it, is_new] = node_of_.try_emplace((static_cast<std::uint64_t>(u) << 32) | v, static_cast<std::uint32_t>(grid_.nodes_.size()));
    if (!is_new) return it->second;
    const ParameterBox& box = grid_.box_;
    const auto at = [](const Interval& range, std::uint32_t k) { return range.from + std::ldexp(static_cast<double>(k), -k_levels) * range.length(); };
    FaceGridNode node{.uv = {at(box.u, u), at(box.v, v)}};
    node.point = surface_.point(node.uv);
    node.bound = bounds_.at(node.point);
    grid_.nodes_.push_back(node);
    is_needed_.push_back(0);
    lattice_.push_back({u, v});
    return it->second;
  }

  /// Returns the cell that contains the lattice square with the lower corner (u, v).
  std::uint32_t cell_of(std::uint32_t u, std::uint32_t v) const {
    std::uint32_t entry = grid_.tree_.front();
    std::uint32_t bit_u = 1u << (k_levels - 1), bit_v = bit_u;
    while ((entry & FaceGrid::k_is_leaf) == 0) {
      const bool is_v = (entry & FaceGrid::k_is_v) != 0;
      std::uint32_t& bit = is_v ? bit_v : bit_u;
      const bool is_upper = ((is_v ? v : u) & bit) != 0;
      bit >>= 1u;
      entry = grid_.tree_[(entry & FaceGrid::k_index) + (is_upper ? 1 : 0)];
    }
    return entry & FaceGrid::k_index;
  }
  void find_hanging() {
    constexpr std::uint32_t k_end = 1u << k_levels;
    for (std::uint32_t n = 0; n < lattice_.size(); ++n) {
      if (is_needed_[n] == 0) continue;
      const auto [u, v] = lattice_[n];
      for (const std::uint32_t below_u : {0u, 1u})
        for (const std::uint32_t below_v : {0u, 1u}) {
          if (u < below_u || v < below_v || u - below_u >= k_end || v - below_v >= k_end) continue;
          const std::uint32_t c = cell_of(u - below_u, v - below_v);
          const FaceGridCell& cell = grid_.leaves_[c];
          if (cell.is_used && std::find(cell.nodes.begin(), cell.nodes.end(), n) == cell.nodes.end()) grid_.hanging_.push_back({c, n});
        }
    }
    std::sort(grid_.hanging_.begin(), grid_.hanging_.end());
    grid_.hanging_.erase(std::unique(grid_.hanging_.begin(), grid_.hanging_.end()), grid_.hanging_.end());
  }

  /// Returns true if a segment meets the cell (or passes near a corner of it).
  bool meets(const Segment& s, Uv low, Uv high) const {
    if (std::max(s.a.u, s.b.u) < low.u || std::min(s.a.u, s.b.u) > high.u || std::max(s.a.v, s.b.v) < low.v || std::min(s.a.v, s.b.v) > high.v) return false;
    const Uv along = s.b - s.a;
    const auto side = [&](double u, double v) { return along.u * (v - s.a.v) - along.v * (u - s.a.u); };
    const double a = side(low.u, low.v), b = side(high.u, low.v), c = side(low.u, high.v), d = side(high.u, high.v);
    return !((a > 0.0 && b > 0.0 && c > 0.0 && d > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0 && d < 0.0));
  }

  /// The segments that may cross the cell are crossing_[first, first + count). A cell without segments is entirely inside or outside.
  void divide(const Cell& cell, std::size_t first, std::size_t count, bool is_known_inside) {
    const auto& nodes = grid_.nodes_;
    const std::array<Point, 4> p{nodes[cell.corners[0]].point, nodes[cell.corners[1]].point, nodes[cell.corners[2]].point, nodes[cell.corners[3]].point};
    const Uv low = nodes[cell.corners[0]].uv, high = nodes[cell.corners[3]].uv;
    const bool is_uncut = count == 0;
    const bool is_inside = is_uncut ? is_known_inside || inside_(0.5 * (low + high)) : false;
    const bool is_used = !is_uncut || is_inside;
    const double along_u = std::max(distance(p[0], p[1]), distance(p[2], p[3])), along_v = std::max(distance(p[0], p[2]), distance(p[1], p[3]));
    double bound = bounds_.largest;
    for (const std::uint32_t n : cell.corners) bound = std::min(bound, nodes[n].bound);
    bool is_small = !is_used || std::max(along_u, along_v) <= k_cell_sizes * bound;
    bool is_level = false;
    if (!is_small && bound >= k_level * bounds_.largest) {
      const Point middle = 0.25 * (p[0] + p[1] + p[2] + p[3]);
      double reach2 = 0.0;
      for (const Point& q : p) reach2 = std::max(reach2, norm2(q - middle));
      is_small = is_level = bounds_.is_level_within(middle, std::sqrt(reach2));
    }
    const bool has_levels = cell.levels_u < k_levels && cell.levels_v < k_levels;
    const bool lacks_u = is_used && cell.levels_u < least_levels_, lacks_v = is_used && cell.levels_v < least_levels_;
    if ((is_small && !lacks_u && !lacks_v) || !has_levels) {
      grid_.tree_[cell.tree] = FaceGrid::k_is_leaf | static_cast<std::uint32_t>(grid_.leaves_.size());
      grid_.leaves_.push_back({cell.corners, is_used, is_level});
      if (is_inside)
        for (const std::uint32_t n : cell.corners) grid_.nodes_[n].is_inside = true;
      return;
    }
    const bool is_v = is_small ? (lacks_v && !(lacks_u && along_u >= along_v)) : along_v > along_u;
    const auto child = static_cast<std::uint32_t>(grid_.tree_.size());
    grid_.tree_[cell.tree] = child | (is_v ? FaceGrid::k_is_v : 0u);
    grid_.tree_.resize(child + 2);
    Cell lower = cell, upper = cell;
    lower.tree = child;
    upper.tree = child + 1;
    const std::uint32_t size_u = 1u << (k_levels - cell.levels_u), size_v = 1u << (k_levels - cell.levels_v);
    if (is_v) {
      const std::uint32_t v = cell.v + size_v / 2, a = node_at(cell.u, v), b = node_at(cell.u + size_u, v);
      upper.v = v;
      lower.levels_v = upper.levels_v = cell.levels_v + 1;
      lower.corners = {cell.corners[0], cell.corners[1], a, b};
      upper.corners = {a, b, cell.corners[2], cell.corners[3]};
    } else {
      const std::uint32_t u = cell.u + size_u / 2, a = node_at(u, cell.v), b = node_at(u, cell.v + size_v);
      upper.u = u;
      lower.levels_u = upper.levels_u = cell.levels_u + 1;
      lower.corners = {cell.corners[0], a, cell.corners[2], b};
      upper.corners = {a, cell.corners[1], b, cell.corners[3]};
    }
    for (const Cell& half : {lower, upper}) {
      const std::size_t begin = crossing_.size();
      const Uv from = grid_.nodes_[half.corners[0]].uv, to = grid_.nodes_[half.corners[3]].uv;
      for (std::size_t k = first; k < first + count; ++k)
        if (meets(inside_.segments()[crossing_[k]], from, to)) crossing_.push_back(crossing_[k]);
      divide(half, begin, crossing_.size() - begin, is_inside);
      crossing_.resize(begin);
    }
  }

  FaceGrid& grid_;
  const Surface& surface_;
  const FaceGrid::Bounds& bounds_;
  Inside inside_;
  int least_levels_;
  std::unordered_map<std::uint64_t, std::uint32_t> node_of_;
  std::vector<std::uint8_t> is_needed_;
  std::vector<std::array<std::uint32_t, 2>> lattice_;  ///< lattice coordinates of each node
  std::vector<std::uint32_t> crossing_;
};

FaceGrid::FaceGrid(const Surface& surface, const ParameterBox& box, std::span<const std::vector<Uv>> loops, const Bounds& bounds) : box_(box) {
  const ParameterBox domain = surface.domain();
  period_ = {surface.is_periodic_u() ? domain.u.length() : 0.0, surface.is_periodic_v() ? domain.v.length() : 0.0};
  FaceGridBuilder(*this, surface, loops, bounds).run();
}

FaceGrid::Location FaceGrid::find(Uv at) const {
  const auto share = [](const Interval& range, double period, double t) {
    if (period > 0.0 && (t > range.to || t < range.from)) {
      const double moved = t - std::floor((t - range.from) / period) * period;
      if (moved <= range.to) t = moved;
    }
    return range.length() > 0.0 ? std::clamp((t - range.from) / range.length(), 0.0, 1.0) : 0.0;
  };
  Location location{0, share(box_.u, period_.u, at.u), share(box_.v, period_.v, at.v)};
  std::uint32_t entry = tree_.front();
  while ((entry & k_is_leaf) == 0) {
    double& x = (entry & k_is_v) != 0 ? location.t : location.s;
    x *= 2.0;
    const bool is_upper = x >= 1.0;
    if (is_upper) x -= 1.0;
    entry = tree_[(entry & k_index) + (is_upper ? 1 : 0)];
  }
  location.cell = entry & k_index;
  return location;
}

void FaceGrid::forget_nodes() {
  nodes_ = {};
  leaves_ = {};
  hanging_ = {};
}

}  // namespace sterna::surfmesh
