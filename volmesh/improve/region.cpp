#include "volmesh/improve/region.h"

#include <algorithm>
#include <cmath>

#include "geom/math/predicates.h"

namespace sterna::volmesh {
namespace {

/// Cost factor of a bad tetrahedron away from the boundary, relative to one at the boundary.
constexpr double k_interior_weight = 20.0;

/// Cost factor of a tetrahedron beyond the hard limits, relative to one that only misses the targets.
constexpr double k_hard_weight = 3.0;

/// Largest initial cost of a detour, and its largest number of changes. A detour is the most expensive operation. Each tetrahedron therefore gets only one,
/// after other tetrahedra around it have been tried.
constexpr double k_detour = 2.0;
constexpr int k_detour_steps = 12;
constexpr int k_failures_before_detour = 2;
constexpr double k_slender = 0.1;  ///< ratio of the shortest to the longest edge
constexpr int k_max_failures_inside = 16;
constexpr int k_max_failures_slender = 3;
constexpr int k_max_failures = 8;

}  // namespace

std::optional<double> quality_on_layer(const TetShape& shape, const std::array<std::uint32_t, 4>& corners, std::span<const LayerFace> faces,
                                       std::uint32_t n_boundary, const QualityLimits& limits) {
  std::optional<double> quality;
  for (std::size_t k = 0; k < 4 && !faces.empty(); ++k) {
    LayerFace face{{corners[(k + 1) % 4], corners[(k + 2) % 4], corners[(k + 3) % 4]}};
    if (std::ranges::max(face.corners) >= n_boundary) continue;
    std::ranges::sort(face.corners);
    const auto found = std::lower_bound(faces.begin(), faces.end(), face);
    if (found == faces.end() || found->corners != face.corners) continue;
    quality = std::min(quality.value_or(1.0), quality_among(shape, found->weight, limits));
  }
  return quality;
}

void Region::assign(std::span<const Vec3> points, std::span<const VertexRole> roles, std::span<const Corners> tets, const Sizes& sizes) {
  points_.assign(points.begin(), points.end());
  roles_.assign(roles.begin(), roles.end());
  size_weights_.assign(points.size(), 1.0);
  std::ranges::copy(sizes.vertex_weights, size_weights_.begin());
  layer_faces_.assign(sizes.layer_faces.begin(), sizes.layer_faces.end());
  n_boundary_ = static_cast<std::uint32_t>(std::ranges::find_if_not(roles, is_of_boundary) - roles.begin());
  changed_.assign(points.size(), 0);
  clock_ = 1;
  effort_ = 0;
  for (auto& list : incident_) list.clear();
  incident_.resize(std::max(incident_.size(), points.size()));
  tets_.clear();
  for (const Corners& corners : tets) add(corners);
}

void Region::add(const Corners& c) {
  for (const std::uint32_t v : c) incident_[v].push_back(static_cast<std::uint32_t>(tets_.size()));
  const Grade g = grade(c);
  tets_.push_back({c, g.of_angles, g.quality, cost_of(g.quality, touches_boundary(c))});
}

/// On top of the layer, the size of a tetrahedron is compared with the last prism. Elsewhere it is compared with the sizes around its vertices.
Region::Grade Region::grade(const TetShape& shape, const Corners& c, double weights) const {
  ++effort_;
  const std::optional<double> on_layer = quality_on_layer(shape, c, layer_faces_, n_boundary_, limits_);
  return {shape.quality, on_layer ? *on_layer : quality_among(shape, weights, limits_)};
}

Region::Grade Region::grade(const Corners& c) const {
  return grade(tet_shape(points_[c[0]], points_[c[1]], points_[c[2]], points_[c[3]], limits_.obtuse_weight), c,
               size_weights_[c[0]] * size_weights_[c[1]] * size_weights_[c[2]] * size_weights_[c[3]]);
}

Region::Grade Region::grade(const Face& f, const Vec3& apex) const {
  return grade(tet_shape(points_[f[0]], points_[f[1]], points_[f[2]], apex, limits_.obtuse_weight), {f[0], f[1], f[2], k_none},
               size_weights_[f[0]] * size_weights_[f[1]] * size_weights_[f[2]] * apex_weight_);
}

double Region::mean_weight(const Corners& c) const {
  return std::sqrt(std::sqrt(size_weights_[c[0]] * size_weights_[c[1]] * size_weights_[c[2]] * size_weights_[c[3]]));
}

bool Region::touches_boundary(const Corners& c) const {
  return std::ranges::any_of(c, [&](std::uint32_t v) { return v < roles_.size() && is_of_boundary(roles_[v]); });
}
bool Region::touches_boundary(const Face& face) const {
  return std::ranges::any_of(face, [&](std::uint32_t v) { return is_of_boundary(roles_[v]); });
}

double Region::weight_of(double quality, bool is_boundary) const {
  return (is_boundary ? 1.0 : k_interior_weight) * (quality < limits_.hard ? k_hard_weight : 1.0);
}

/// Returns the cost of a quality. Below the target it has a step, so that the number of tetrahedra counts, and a slope, so that the worst tetrahedra gain most.
/// From the target to twice the target there is a small cost, so that tetrahedra stay away from the target. Beyond the hard limits the cost is multiplied by a
/// factor.
double Region::cost_of(double quality, bool is_boundary) const {
  const double x = quality / limits_.target;
  if (x >= 2.0) return 0.0;
  const double soft = 0.25 * (1.0 - 0.5 * x) * (1.0 - 0.5 * x);
  return x >= 1.0 ? soft : (soft + 1.0 - 0.5 * x) * weight_of(quality, is_boundary);
}

double Region::slope_of_cost(double quality, bool is_boundary) const {
  const double x = quality / limits_.target;
  if (x >= 2.0) return 0.0;
  const double soft = 0.25 * (1.0 - 0.5 * x);
  return (x >= 1.0 ? soft : (soft + 0.5) * weight_of(quality, is_boundary)) / limits_.target;
}

void Region::compare_with(std::span<const std::uint32_t> removed) {
  cost_before_ = 0.0;
  worst_allowed_ = limits_.floor;
  for (const std::uint32_t t : removed) {
    cost_before_ += tets_[t].cost;
    worst_allowed_ = std::min(worst_allowed_, tets_[t].angle_quality);
  }
}

double Region::cost(const Corners& c) const {
  const Grade g = grade(c);
  return g.of_angles < worst_allowed_ || g.of_angles <= 0.0 ? k_infinite : g.quality >= 2.0 * limits_.target ? 0.0 : cost_of(g.quality, touches_boundary(c));
}

double Region::cost(const Face& face, const Vec3& apex) const {
  const Grade g = grade(face, apex);
  return g.of_angles < worst_allowed_ || g.of_angles <= 0.0 ? k_infinite : g.quality >= 2.0 * limits_.target ? 0.0 : cost_of(g.quality, touches_boundary(face));
}

Region::Face Region::opposite(const Corners& c, std::size_t corner) {
  constexpr std::uint8_t k_faces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  return {c[k_faces[corner][0]], c[k_faces[corner][1]], c[k_faces[corner][2]]};
}

bool Region::apply(const Change& change, double least_drop) {
  if (!(change.drop > least_drop) || change.removed.empty()) return false;
  const auto location = [&](std::uint32_t v) -> const Vec3& { return v == change.moved ? change.location : points_[v]; };
  const auto weight = [&](std::uint32_t v) { return v == change.moved ? change.size_weight : size_weights_[v]; };
  compare_with(change.removed);
  double sum = 0.0;
  for (const Corners& c : change.added) {
    const Vec3 &p0 = location(c[0]), &p1 = location(c[1]), &p2 = location(c[2]), &p3 = location(c[3]);
    if (orient3d(p0, p1, p2, p3) <= 0) return false;
    const Grade g = grade(tet_shape(p0, p1, p2, p3, limits_.obtuse_weight), c, weight(c[0]) * weight(c[1]) * weight(c[2]) * weight(c[3]));
    if (g.of_angles < worst_allowed_ || g.of_angles <= 0.0) return false;
    sum += cost_of(g.quality, touches_boundary(c));
  }
  const double drop = cost_before_ - sum;
  if (!(drop > least_drop)) return false;

  if (is_logging_) {
    log_.push_back({change.removed, change.added.size(), change.moved, change.moved == points_.size(), {}, drop});
    if (change.moved < points_.size()) log_.back().location = points_[change.moved];
  }
  if (change.moved == points_.size()) {
    points_.push_back(change.location);
    roles_.push_back(VertexRole::free);
    size_weights_.push_back(change.size_weight);
    changed_.push_back(0);
    incident_.resize(std::max(incident_.size(), points_.size()));
  } else if (change.moved != k_none) {
    points_[change.moved] = change.location;
  }
  ++clock_;
  for (const std::uint32_t t : change.removed) {
    tets_[t].is_alive = false;
    for (const std::uint32_t v : tets_[t].corners) {
      std::erase(incident_[v], t);
      changed_[v] = clock_;
    }
  }
  for (const Corners& c : change.added) {
    add(c);
    for (const std::uint32_t v : c) changed_[v] = clock_;
  }
  return true;
}

bool Region::is_stuck(std::uint32_t tet) const {
  return std::ranges::all_of(tets_[tet].corners, [&](std::uint32_t v) { return changed_[v] <= tets_[tet].tried; }) && tets_[tet].tried > 0;
}

bool Region::help_with_what_is_there(std::uint32_t tet) {
  Change flip;
  try_edges_and_faces(tet, flip);
  if (apply(flip)) return true;
  Change move;
  try_smoothing(tet, move);
  if (apply(move)) return true;
  Change contraction;
  try_contractions(tet, contraction);
  return apply(contraction);
}

bool Region::help(std::uint32_t tet) {
  if (help_with_what_is_there(tet)) return true;
  Change insertion;
  try_insertions(tet, insertion);
  return apply(insertion) || (tets_[tet].n_failures == k_failures_before_detour && detour(tet));
}

void Region::undo(std::size_t log_size) {
  for (; log_.size() > log_size; log_.pop_back()) {
    const Applied& last = log_.back();
    for (std::size_t i = 0; i < last.n_added; ++i) {
      const auto t = static_cast<std::uint32_t>(tets_.size() - 1);
      for (const std::uint32_t v : tets_[t].corners) std::erase(incident_[v], t);
      tets_.pop_back();
    }
    for (const std::uint32_t t : last.removed) {
      tets_[t].is_alive = true;
      for (const std::uint32_t v : tets_[t].corners) incident_[v].push_back(t);
    }
    if (last.is_new) {
      points_.pop_back();
      roles_.pop_back();
      size_weights_.pop_back();
      changed_.pop_back();
    } else if (last.moved != k_none) {
      points_[last.moved] = last.location;
    }
  }
}

bool Region::settle(const Change& change) {
  const std::vector<std::uint32_t> stamps = changed_;
  const std::uint32_t clock = clock_;
  const std::size_t n_before = tets_.size();
  log_.clear();
  is_logging_ = true;
  bool is_better = false;
  if (apply(change, -k_detour)) {
    double sum = 0.0;
    for (int i = 0; i < k_detour_steps; ++i) {
      sum = 0.0;
      for (const Applied& a : log_) sum += a.drop;
      if (sum > k_least_drop) break;
      std::uint32_t worst = k_none;
      for (auto t = static_cast<std::uint32_t>(n_before); t < tets_.size(); ++t)
        if (tets_[t].is_alive && tets_[t].quality < limits_.target && !is_stuck(t) && (worst == k_none || tets_[t].quality < tets_[worst].quality)) worst = t;
      if (worst == k_none) break;
      if (!help_with_what_is_there(worst)) tets_[worst].tried = clock_;
    }
    sum = 0.0;
    for (const Applied& a : log_) sum += a.drop;
    is_better = sum > k_least_drop;
    if (!is_better) undo(0);
  }
  is_logging_ = false;
  if (!is_better) {
    changed_ = stamps;
    clock_ = clock;
  } else {
    for (auto t = static_cast<std::uint32_t>(n_before); t < tets_.size(); ++t) tets_[t].tried = 0;
  }
  return is_better;
}

bool Region::detour(std::uint32_t tet) {
  Change by_insertion{.drop = -k_detour};
  try_insertions(tet, by_insertion);
  if (settle(by_insertion)) return true;
  Change by_flip{.drop = -k_detour};
  try_edges_and_faces(tet, by_flip);
  if (settle(by_flip)) return true;
  Change by_contraction{.drop = -k_detour};
  try_contractions(tet, by_contraction);
  return settle(by_contraction);
}

int max_failures(const std::array<Vec3, 4>& corners, bool is_at_boundary) {
  if (!is_at_boundary) return k_max_failures_inside;
  double shortest = norm2(corners[1] - corners[0]), longest = shortest;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double length = norm2(corners[i] - corners[j]);
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
  return shortest < k_slender * k_slender * longest ? k_max_failures_slender : k_max_failures;
}

bool Region::is_given_up(std::uint32_t tet) const {
  const Corners& c = tets_[tet].corners;
  const int n = tets_[tet].n_failures;
  return n > 0 && n >= std::min(limits_.max_failures, max_failures({points_[c[0]], points_[c[1]], points_[c[2]], points_[c[3]]}, touches_boundary(c)));
}

bool Region::has_all_neighbours(std::uint32_t tet) const {
  return std::ranges::all_of(tets_[tet].corners, [&](std::uint32_t v) { return roles_[v] == VertexRole::free || roles_[v] == VertexRole::boundary; });
}

bool Region::improve(std::span<const std::uint32_t> tets, std::span<const std::uint8_t> n_failures, std::uint64_t most_effort) {
  std::vector<std::uint32_t> work(tets.begin(), tets.end());
  for (std::size_t i = 0; i < tets.size(); ++i) tets_[tets[i]].n_failures = n_failures[i];
  const std::uint32_t start = clock_;
  for (;;) {
    std::uint32_t worst = k_none;
    std::erase_if(work, [&](std::uint32_t t) { return !tets_[t].is_alive || tets_[t].quality >= limits_.target || is_given_up(t); });
    for (const std::uint32_t t : work)
      if (!is_stuck(t) && (worst == k_none || tets_[t].quality < tets_[worst].quality)) worst = t;
    if (worst == k_none || effort_ > most_effort) return clock_ > start;
    const std::size_t n_before = tets_.size();
    if (!help(worst)) {
      tets_[worst].tried = clock_;
      tets_[worst].n_failures += has_all_neighbours(worst);
    }
    for (std::size_t t = n_before; t < tets_.size(); ++t) work.push_back(static_cast<std::uint32_t>(t));
  }
}

}  // namespace sterna::volmesh
