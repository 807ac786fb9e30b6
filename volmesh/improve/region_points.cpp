// Changes that move, remove or add points.
//
// Smoothing reduces the sum of the costs of the tetrahedra around a point. It moves the point along the gradient with decreasing steps. If the worst tetrahedra
// have conflicting gradients, the direction is the shortest vector in the convex hull of their gradients, along which all of them improve (Freitag and
// Ollivier-Gooch 1997). Insertion removes tetrahedra around a bad one until a new point is well visible from all faces of the cavity (Klingner and Shewchuk
// 2007).

#include <algorithm>
#include <cmath>
#include <functional>

#include "volmesh/improve/region.h"

namespace sterna::volmesh {
namespace {

constexpr int k_max_steps = 14;          ///< largest number of steps of one smoothing
constexpr double k_nearly_worst = 1.08;  ///< tetrahedra whose quality is within this factor of the worst contribute to the direction
constexpr std::size_t k_max_gradients = 8;
constexpr double k_difference = 1e-4;      ///< step of numerical gradients relative to the size of the star; half of the digits of the quality remain
constexpr std::size_t k_max_cavity = 100;  ///< largest number of tetrahedra in a cavity
/// Heights of trial points above a face, in units of the radius of its inscribed circle.
constexpr std::array<double, 3> k_heights = {0.5, 1.0, 2.0};
constexpr std::size_t k_smoothed_locations = 3;

/// Returns the shortest vector in the convex hull of gradients (Gilbert's iteration; a few digits are sufficient).
Vec3 shortest_in_hull(std::span<const Vec3> gradients) {
  Vec3 x = gradients[0];
  for (int i = 0; i < 30; ++i) {
    const Vec3* lowest = &gradients[0];
    for (const Vec3& g : gradients)
      if (dot(g, x) < dot(*lowest, x)) lowest = &g;
    const Vec3 d = *lowest - x;
    const double length2 = norm2(d);
    if (!(length2 > 0.0) || -dot(x, d) <= 1e-3 * norm2(x)) break;
    x += std::clamp(-dot(x, d) / length2, 0.0, 1.0) * d;
  }
  return x;
}

}  // namespace

double Region::sum_of_costs(std::span<const Face> faces, const Vec3& apex, double stop_above) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < faces.size() && sum < stop_above; ++i) sum += cost(faces[i], apex);
  return sum;
}

std::pair<Vec3, double> Region::best_location(std::span<const Face> faces, const Vec3& start) const {
  Vec3 p = start;
  double now = sum_of_costs(faces, p, k_infinite);
  if (now == k_infinite || now == 0.0) return {p, now};
  double longest = 0.0;
  for (const Face& face : faces)
    for (const std::uint32_t v : face) longest = std::max(longest, norm2(points_[v] - p));
  const double size = std::sqrt(longest), step = k_difference * size;
  double reach = 0.2 * size;
  for (int i_step = 0; i_step < k_max_steps && now > 0.0 && reach > 1e-3 * size; ++i_step) {
    // Gradients of the qualities with a nonzero cost, worst first.
    struct Slope {
      double quality;
      Vec3 gradient;
      bool is_boundary;
    };
    std::vector<Slope> slopes;
    for (const Face& face : faces) {
      const double q = grade(face, p).quality;
      if (q >= 2.0 * limits_.target) continue;
      Slope slope{q, {}, touches_boundary(face)};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3 moved = p;
        moved[axis] += step;
        slope.gradient[axis] = (grade(face, moved).quality - q) / step;
      }
      slopes.push_back(slope);
    }
    std::ranges::stable_sort(slopes, {}, &Slope::quality);
    Vec3 down;
    for (const Slope& s : slopes) down += slope_of_cost(s.quality, s.is_boundary) * s.gradient;
    std::array<Vec3, k_max_gradients> worst;
    std::size_t n = 0;
    while (n < std::min(slopes.size(), k_max_gradients) && slopes[n].quality <= k_nearly_worst * slopes[0].quality) {
      worst[n] = slopes[n].gradient;
      ++n;
    }
    bool has_gained = false;
    for (const Vec3& direction : {down, shortest_in_hull({worst.data(), n})}) {
      const double length = norm(direction);
      if (!(length * size > 1e-3 * now)) continue;
      // The step is halved until the sum falls. If the first step succeeds, the next one may be longer.
      double trial = reach;
      for (int halving = 0; halving < 6 && !has_gained; ++halving, trial *= 0.5) {
        const Vec3 moved = p + (trial / length) * direction;
        const double then = sum_of_costs(faces, moved, now);
        if (then >= now) continue;
        p = moved;
        now = then;
        has_gained = true;
        reach = halving == 0 ? 1.5 * trial : trial;
      }
      if (has_gained) break;
    }
    if (!has_gained) reach *= 1.0 / 16.0;
  }
  return {p, now};
}

void Region::try_smoothing(std::uint32_t tet, Change& best) {
  std::vector<Face> faces;
  for (const std::uint32_t v : tets_[tet].corners) {
    if (roles_[v] != VertexRole::free) continue;
    faces.clear();
    for (const std::uint32_t t : incident_[v]) {
      const Corners& c = tets_[t].corners;
      faces.push_back(opposite(c, static_cast<std::size_t>(std::ranges::find(c, v) - c.begin())));
    }
    compare_with(incident_[v]);
    apex_weight_ = size_weights_[v];
    const auto [location, after] = best_location(faces, points_[v]);
    if (cost_before_ - after <= best.drop) continue;
    best = Change{.drop = cost_before_ - after, .removed = incident_[v], .moved = v, .location = location, .size_weight = apex_weight_};
    for (const Face& face : faces) best.added.push_back({face[0], face[1], face[2], v});
  }
}

void Region::try_contractions(std::uint32_t tet, Change& best) {
  std::vector<std::uint32_t> neighbours;
  for (const std::uint32_t v : tets_[tet].corners) {
    if (roles_[v] != VertexRole::free) continue;
    neighbours.clear();
    for (const std::uint32_t t : incident_[v])
      for (const std::uint32_t u : tets_[t].corners)
        if (u != v) neighbours.push_back(u);
    std::ranges::sort(neighbours);
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    compare_with(incident_[v]);
    for (const std::uint32_t u : neighbours) {
      Change change{.removed = incident_[v]};
      double sum = 0.0;
      const double limit = cost_before_ - best.drop;
      for (const std::uint32_t t : incident_[v]) {
        Corners c = tets_[t].corners;
        if (std::ranges::find(c, u) != c.end()) continue;
        *std::ranges::find(c, v) = u;
        sum += cost(c);
        if (sum >= limit) break;
        change.added.push_back(c);
      }
      if (sum >= limit) continue;
      change.drop = cost_before_ - sum;
      best = std::move(change);
    }
  }
}

/// Tries to insert a point at the tetrahedron's centre and above its faces. (Above a face, the point is useful for two flat triangles that one flat tetrahedron
/// joins.) If that fails, tries the centres of its neighbours and the midpoints of its edges. The locations are ranked without smoothing, and only the best are
/// smoothed.
void Region::try_insertions(std::uint32_t tet, Change& best) {
  const Corners c = tets_[tet].corners;
  const auto center = [&](const Corners& x) { return 0.25 * (points_[x[0]] + points_[x[1]] + points_[x[2]] + points_[x[3]]); };
  apex_weight_ = mean_weight(c);
  std::vector<Cavity> cavities;
  const auto add = [&](const Vec3& location) {
    if (std::optional<Cavity> cavity = cavity_of(tet, location)) cavities.push_back(std::move(*cavity));
  };
  add(center(c));
  for (std::size_t k = 0; k < 4; ++k) {
    const Face f = opposite(c, k);
    const Vec3 &p0 = points_[f[0]], &p1 = points_[f[1]], &p2 = points_[f[2]];
    const double opposite_0 = norm(p2 - p1), opposite_1 = norm(p0 - p2), opposite_2 = norm(p1 - p0), perimeter = opposite_0 + opposite_1 + opposite_2;
    const Vec3 normal = cross(p1 - p0, p2 - p0);
    const Vec3 in_circle_center = (opposite_0 * p0 + opposite_1 * p1 + opposite_2 * p2) / perimeter;
    for (const double height : k_heights) add(in_circle_center + (height / perimeter) * normal);
  }
  if (tets_[tet].n_failures > 0) {
    for (std::size_t k = 0; k < 4; ++k)
      if (const std::uint32_t beyond = across(tet, opposite(c, k)); beyond != k_none) add(center(tets_[beyond].corners));
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) add(0.5 * (points_[c[i]] + points_[c[j]]));
  }
  std::ranges::stable_sort(cavities, std::ranges::greater(), &Cavity::drop);
  for (std::size_t i = 0; i < std::min(cavities.size(), k_smoothed_locations); ++i) try_insertion(cavities[i], best);
}

std::optional<Region::Cavity> Region::cavity_of(std::uint32_t tet, const Vec3& p) const {
  struct Side {
    Face face;
    std::uint32_t beyond;
    double quality;  ///< quality of the angles
    double cost;
  };
  std::vector<std::uint32_t> cavity;
  std::vector<Side> sides, best_sides;
  std::size_t best_size = 0;
  double best_drop = -k_infinite;
  const auto in_cavity = [&](std::uint32_t t) { return std::ranges::find(cavity, t) != cavity.end(); };
  const auto add = [&](std::uint32_t t) {
    cavity.push_back(t);
    std::erase_if(sides, [&](const Side& side) { return side.beyond == t; });
    for (std::size_t k = 0; k < 4; ++k) {
      const Face face = opposite(tets_[t].corners, k);
      const std::uint32_t beyond = across(t, face);
      if (beyond != k_none && in_cavity(beyond)) continue;
      const Grade g = grade(face, p);
      sides.push_back({face, beyond, g.of_angles, g.quality >= 2.0 * limits_.target ? 0.0 : cost_of(g.quality, touches_boundary(face))});
    }
  };
  add(tet);
  double cost_before = tets_[tet].cost, worst_allowed = std::min(limits_.floor, tets_[tet].angle_quality);
  while (cavity.size() < k_max_cavity) {
    double sum = 0.0;
    const Side* lowest = &sides[0];
    for (const Side& side : sides) {
      if (side.quality < lowest->quality) lowest = &side;
      sum += side.cost;
    }
    if (lowest->quality > 0.0 && lowest->quality >= worst_allowed && cost_before - sum > best_drop) {
      best_drop = cost_before - sum;
      best_size = cavity.size();
      best_sides = sides;
    }
    const std::uint32_t beyond = lowest->beyond;
    if (beyond == k_none) break;
    cost_before += tets_[beyond].cost;
    worst_allowed = std::min(worst_allowed, tets_[beyond].angle_quality);
    add(beyond);
  }
  if (best_drop == -k_infinite) return std::nullopt;
  cavity.resize(best_size);
  Cavity result{.tets = std::move(cavity), .location = p, .drop = best_drop};
  for (const Side& side : best_sides) result.faces.push_back(side.face);
  return result;
}

void Region::try_insertion(const Cavity& cavity, Change& best) {
  compare_with(cavity.tets);
  const auto [location, after] = best_location(cavity.faces, cavity.location);
  if (cost_before_ - after <= best.drop) return;
  best = Change{.drop = cost_before_ - after,
                .removed = cavity.tets,
                .moved = static_cast<std::uint32_t>(points_.size()),
                .location = location,
                .size_weight = apex_weight_};
  for (const Face& face : cavity.faces) best.added.push_back({face[0], face[1], face[2], best.moved});
}

}  // namespace sterna::volmesh
