// Changes that move, remove or add points.
// Smoothing climbs the worst quality around a point, which is a maximum of a minimum: the direction is the shortest vector in the convex hull of the gradients of the
// nearly worst tetrahedra, along which all of them gain (Freitag and Ollivier-Gooch 1997). Insertion takes tetrahedra away around a bad one until the cavity's faces
// see a new point well (Klingner and Shewchuk 2007).

#include <algorithm>
#include <cmath>
#include <limits>

#include "volmesh/improve/region.h"

namespace sterna::volmesh {
namespace {

constexpr int k_max_climbs = 12;          ///< steps of one smoothing
constexpr double k_nearly_worst = 1.08;   ///< qualities within this factor of the worst share the direction
constexpr std::size_t k_max_gradients = 8;
constexpr double k_difference = 1e-4;     ///< step of the numerical gradients over the size of the star: half of the digits of the quality
constexpr std::size_t k_max_cavity = 40;  ///< tetrahedra

/// Shortest vector in the convex hull of gradients (Gilbert's iteration, a few digits are plenty).
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

double Region::worst_gain(std::span<const Face> faces, std::span<const std::uint8_t> is_boundary, const Vec3& apex, double stop_below) const {
  double result = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < faces.size() && result > stop_below; ++i) result = std::min(result, gain(faces[i], apex, is_boundary[i] != 0));
  return result;
}

std::pair<Vec3, double> Region::best_place(std::span<const Face> faces, const Vec3& start) const {
  Vec3 p = start;
  double longest = 0.0;
  for (const Face& face : faces)
    for (const std::uint32_t v : face) longest = std::max(longest, norm2(points_[v] - p));
  const double size = std::sqrt(longest);
  std::vector<std::uint8_t> is_boundary(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) is_boundary[i] = touches_boundary(faces[i]);
  std::vector<double> gains(faces.size());
  double reach = 0.2 * size;
  double now = worst_gain(faces, is_boundary, p, -1.0);
  for (int climb = 0; climb < k_max_climbs && now > 0.0 && reach > 1e-4 * size; ++climb) {
    for (std::size_t i = 0; i < faces.size(); ++i) gains[i] = gain(faces[i], p, is_boundary[i] != 0);
    std::array<Vec3, k_max_gradients> gradients;
    std::size_t n = 0;
    for (std::size_t i = 0; i < faces.size() && n < k_max_gradients; ++i) {
      if (gains[i] > k_nearly_worst * now) continue;
      const double step = k_difference * size;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3 moved = p;
        moved[axis] += step;
        gradients[n][axis] = (gain(faces[i], moved, is_boundary[i] != 0) - gains[i]) / step;
      }
      ++n;
    }
    const Vec3 direction = shortest_in_hull({gradients.data(), n});
    const double slope = norm(direction);
    if (!(slope * size > 1e-3 * now)) break;
    // Halve the step until the worst gains; a step that gains at once may be longer next time.
    bool has_gained = false;
    for (int halving = 0; halving < 8; ++halving) {
      const Vec3 moved = p + (reach / slope) * direction;
      const double then = worst_gain(faces, is_boundary, moved, now);
      if (then > now) {
        p = moved;
        now = then;
        has_gained = true;
        reach *= halving == 0 ? 1.5 : 1.0;
        break;
      }
      reach *= 0.5;
    }
    if (!has_gained) break;
  }
  return {p, now};
}

bool Region::smooth(std::uint32_t tet) {
  Change best;
  std::vector<Face> faces;
  for (const std::uint32_t v : tets_[tet].corners) {
    if (roles_[v] != VertexRole::free) continue;
    faces.clear();
    for (const std::uint32_t t : incident_[v]) {
      const Corners& c = tets_[t].corners;
      faces.push_back(opposite(c, static_cast<std::size_t>(std::ranges::find(c, v) - c.begin())));
    }
    compare_with(incident_[v]);
    const auto [place, after] = best_place(faces, points_[v]);
    if (after <= best.gain) continue;
    best = Change{.gain = after, .removed = incident_[v], .moved = v, .place = place};
    for (const Face& face : faces) best.added.push_back({face[0], face[1], face[2], v});
  }
  return apply(best);
}

bool Region::contract(std::uint32_t tet) {
  Change best;
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
      Change change{.gain = std::numeric_limits<double>::infinity(), .removed = incident_[v]};
      for (const std::uint32_t t : incident_[v]) {
        Corners c = tets_[t].corners;
        if (std::ranges::find(c, u) != c.end()) continue;
        *std::ranges::find(c, v) = u;
        change.gain = std::min(change.gain, gain(c));
        if (change.gain <= std::max(best.gain, 1.0)) break;
        change.added.push_back(c);
      }
      if (change.gain > std::max(best.gain, 1.0)) best = std::move(change);
    }
  }
  return apply(best);
}

bool Region::insert(std::uint32_t tet) {
  struct Side {
    Face face;
    std::uint32_t inside;
    double gain;
  };
  const Corners start = tets_[tet].corners;
  const Vec3 p = 0.25 * (points_[start[0]] + points_[start[1]] + points_[start[2]] + points_[start[3]]);
  std::vector<std::uint32_t> cavity, best_cavity;
  std::vector<Side> sides, best_sides;
  double best_gain = -1.0;
  const auto in_cavity = [&](std::uint32_t t) { return std::ranges::find(cavity, t) != cavity.end(); };
  const auto add = [&](std::uint32_t t) {
    cavity.push_back(t);
    std::erase_if(sides, [&](const Side& side) { return across(side.inside, side.face) == t; });
    for (std::size_t k = 0; k < 4; ++k) {
      const Face face = opposite(tets_[t].corners, k);
      if (const std::uint32_t beyond = across(t, face); beyond == k_none || !in_cavity(beyond)) sides.push_back({face, t, gain(face, p, touches_boundary(face))});
    }
  };
  // Its last tetrahedron gone, a vertex would be lost within the cavity.
  const auto keeps_vertices = [&](std::uint32_t t) {
    return std::ranges::all_of(tets_[t].corners, [&](std::uint32_t v) {
      return std::ranges::any_of(incident_[v], [&](std::uint32_t other) { return other != t && !in_cavity(other); }) || roles_[v] != VertexRole::free;
    });
  };
  compare_with(std::span(&tet, 1));
  add(tet);
  while (cavity.size() < k_max_cavity) {
    const auto lowest = std::ranges::min_element(sides, {}, &Side::gain);
    if (lowest->gain > best_gain) {
      best_gain = lowest->gain;
      best_cavity = cavity;
      best_sides = sides;
    }
    const std::uint32_t beyond = across(lowest->inside, lowest->face);
    if (beyond == k_none || !keeps_vertices(beyond)) break;
    add(beyond);
  }
  if (best_gain <= 0.0) return false;
  compare_with(best_cavity);
  std::vector<Face> faces;
  for (const Side& side : best_sides) faces.push_back(side.face);
  const auto [place, after] = best_place(faces, p);
  Change change{.gain = after, .removed = best_cavity, .moved = static_cast<std::uint32_t>(points_.size()), .place = place};
  for (const Face& face : faces) change.added.push_back({face[0], face[1], face[2], change.moved});
  return apply(change);
}

}  // namespace sterna::volmesh
