// Why positive tetrahedra with the same hull fill the same region: their signed volumes cover each point of it as often as the old tetrahedra did, that is
// once, and no volume counts negatively.

#include "geom/tets/flips.h"

#include <algorithm>
#include <array>

#include "geom/tets/insert.h"
#include "geom/tets/ring_fill.h"
#include "geom/tets/signs.h"

namespace sterna::tets {
namespace {

/// Larger rings are not processed, because the effort grows with the cube of their size.
constexpr std::size_t k_largest_ring = 60;
/// Limit for the ring of an edge that only obstructs another one.
constexpr std::size_t k_largest_other_ring = 24;
/// Upper limit of the sum of the length costs of all diagonals of a ring. It is less than the smallest of the other costs.
constexpr double k_length_cost = 0.5;
/// Largest number of edges that are tried in order to remove one edge.
constexpr int k_most_effort = 400;
/// Largest number of tetrahedra that are replaced by a new point.
constexpr std::size_t k_most_cavity = 200;
constexpr int k_most_walk = 2000;  ///< steps of the walk to a new point

}  // namespace

Flips::Flips(Borrowed<TetMesh> mesh, Borrowed<const FacetIndex> required) : mesh_(mesh), required_(required) {
  tet_at_.assign(mesh->points.size(), k_none);
  for (std::uint32_t t = 0; t < mesh->nodes.size(); ++t) {
    if (!mesh->is_alive(t)) continue;
    for (const std::uint32_t v : mesh->nodes[t]) tet_at_[v] = t;
  }
}

bool Flips::is_positive(const Corners& v) const { return orientation(mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]], mesh_.points[v[3]]) > 0; }

void Flips::star(std::uint32_t v, std::vector<std::uint32_t>& tets) {
  seen_.resize(mesh_.nodes.size(), 0);
  ++stamp_;
  tets.assign(1, tet_at_[v]);
  seen_[tet_at_[v]] = stamp_;
  for (std::size_t i = 0; i < tets.size(); ++i) {
    const std::uint32_t t = tets[i];
    for (std::size_t corner = 0; corner < 4; ++corner) {
      if (mesh_.nodes[t][corner] == v) continue;
      const std::uint32_t n = mesh_.neighbours[t][corner];
      if (n == k_none || seen_[n / 4] == stamp_) continue;
      seen_[n / 4] = stamp_;
      tets.push_back(n / 4);
    }
  }
}

std::uint32_t Flips::tet_with_edge(std::uint32_t p, std::uint32_t q) {
  star(p, star_);
  for (const std::uint32_t t : star_)
    if (has(mesh_.nodes[t], q)) return t;
  return k_none;
}

bool Flips::find_ring(std::uint32_t p, std::uint32_t q, Ring& ring) {
  const std::uint32_t first = tet_with_edge(p, q);
  if (first == k_none) return false;
  ring.tets.clear();
  ring.vertices.clear();
  std::uint32_t t = first;
  auto [r, s] = other_two(mesh_.nodes[first], p, q);
  for (;;) {
    ring.tets.push_back(t);
    ring.vertices.push_back(r);
    const std::uint32_t n = mesh_.neighbours[t][corner_of(mesh_.nodes[t], r)];
    if (n == k_none) return false;
    t = n / 4;
    if (t == first) return true;
    r = s;
    s = mesh_.nodes[t][n % 4];
  }
}

bool Flips::has_facet(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  star(a, star_);
  return std::ranges::any_of(star_, [&](std::uint32_t t) { return has(mesh_.nodes[t], b) && has(mesh_.nodes[t], c); });
}

void Flips::save(std::uint32_t t) { journal_.push_back({t, mesh_.nodes[t], mesh_.neighbours[t], static_cast<std::uint32_t>(mesh_.nodes.size())}); }

void Flips::undo(std::size_t state) {
  const std::size_t end = journal_.size();
  std::size_t n_tets = mesh_.nodes.size();
  for (std::size_t i = end; i-- > state;) {
    const Entry& entry = journal_[i];
    mesh_.nodes[entry.tet] = entry.nodes;
    mesh_.neighbours[entry.tet] = entry.neighbours;
    n_tets = entry.n_tets;
  }
  mesh_.nodes.resize(n_tets);
  mesh_.neighbours.resize(n_tets);
  seen_.resize(std::min(seen_.size(), n_tets));
  for (std::size_t i = state; i < end; ++i) {
    const std::uint32_t t = journal_[i].tet;
    if (t >= n_tets || !mesh_.is_alive(t)) continue;
    for (const std::uint32_t v : mesh_.nodes[t]) tet_at_[v] = t;
  }
  journal_.resize(state);
}

/// Replaces tetrahedra. \pre the new ones are positive. Returns false, and changes nothing, if they have another hull.
bool Flips::replace(std::span<const std::uint32_t> gone, std::span<const Corners> made) {
  sides_.clear();
  const auto sorted = [](const Corners& v, std::size_t corner) {
    Facet f = {v[k_face[corner][0]], v[k_face[corner][1]], v[k_face[corner][2]]};
    std::ranges::sort(f);
    return f;
  };
  for (const std::uint32_t t : gone) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::uint32_t n = mesh_.neighbours[t][corner];
      if (n != k_none && std::ranges::find(gone, n / 4) != gone.end()) continue;
      sides_.push_back({sorted(mesh_.nodes[t], corner), n, true});
    }
  }
  // Pairs of faces. The new tetrahedra are first numbered by their position in the list.
  std::vector<std::array<std::uint32_t, 4>> links(made.size(), {k_none, k_none, k_none, k_none});
  std::vector<std::array<bool, 4>> is_outer(made.size(), std::array<bool, 4>{});
  for (std::uint32_t i = 0; i < made.size(); ++i) {
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
      const Facet f = sorted(made[i], corner);
      const auto other = std::ranges::find(sides_, f, &Side::corners);
      if (other == sides_.end()) {
        sides_.push_back({f, 4 * i + corner, false});
        continue;
      }
      links[i][corner] = other->face;
      is_outer[i][corner] = other->is_outer;
      if (!other->is_outer) links[other->face / 4][other->face % 4] = 4 * i + corner;
      *other = sides_.back();
      sides_.pop_back();
    }
  }
  if (!sides_.empty()) return false;

  std::vector<std::uint32_t> locations(gone.begin(), gone.end());
  for (const std::uint32_t t : gone) save(t);
  while (locations.size() < made.size()) {
    const auto t = static_cast<std::uint32_t>(mesh_.nodes.size());
    // The slot is saved before it exists, so that undo removes it.
    journal_.push_back({t, {k_none, k_none, k_none, k_none}, {k_none, k_none, k_none, k_none}, t});
    mesh_.nodes.push_back({k_none, k_none, k_none, k_none});
    mesh_.neighbours.push_back({k_none, k_none, k_none, k_none});
    locations.push_back(t);
  }
  for (const std::uint32_t t : gone) mesh_.nodes[t] = {k_none, k_none, k_none, k_none};
  for (std::size_t i = 0; i < made.size(); ++i) {
    const std::uint32_t t = locations[i];
    mesh_.nodes[t] = made[i];
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
      std::uint32_t& n = mesh_.neighbours[t][corner];
      if (is_outer[i][corner]) {
        n = links[i][corner];
        if (n == k_none) continue;
        save(n / 4);
        mesh_.neighbours[n / 4][n % 4] = 4 * t + corner;
      } else {
        n = 4 * locations[links[i][corner] / 4] + links[i][corner] % 4;
      }
    }
    for (const std::uint32_t v : made[i]) tet_at_[v] = t;
  }
  return true;
}

bool Flips::flip_face(std::uint32_t face) {
  const std::uint32_t t = face / 4, n = mesh_.neighbours[t][face % 4];
  if (n == k_none) return false;
  const auto& f = k_face[face % 4];
  const std::uint32_t a = mesh_.nodes[t][f[0]], b = mesh_.nodes[t][f[1]], c = mesh_.nodes[t][f[2]];
  const std::uint32_t top = mesh_.nodes[t][face % 4], bottom = mesh_.nodes[n / 4][n % 4];
  if (required_.find_facet(a, b, c) != k_none) return false;
  const std::array<Corners, 3> made = {{{a, b, bottom, top}, {b, c, bottom, top}, {c, a, bottom, top}}};
  if (!std::ranges::all_of(made, [&](const Corners& v) { return is_positive(v); })) return false;
  return replace(std::array{t, n / 4}, made);
}

/// Finds the best triangulation of the ring's polygon. Each triangle forms a tetrahedron with p and one with q.
bool Flips::fill_ring(std::uint32_t p, std::uint32_t q, const Ring& ring, const FlipCosts& costs) {
  const std::size_t n = ring.vertices.size();
  constexpr double k_impossible = 1e9;
  const auto r = [&](std::size_t i) { return ring.vertices[i]; };
  const auto length2 = [&](std::size_t i, std::size_t j) { return norm2(mesh_.points[r(i)] - mesh_.points[r(j)]); };
  double longest = 0.0;
  for (std::size_t i = 0; i < n; ++i) longest = std::max(longest, length2(i, (i + n / 2) % n));
  const double length_cost = longest > 0.0 ? 0.25 * k_length_cost / (static_cast<double>(n) * longest) : 0.0;  // no two corners are more than twice as far
                                                                                                               // apart
  const auto with_triangle = [&](std::size_t i, std::size_t j, std::size_t k, double sum, double bound) {
    if (!is_positive({r(i), r(j), r(k), q}) || !is_positive({r(i), r(k), r(j), p})) return bound;
    return sum + (costs.face ? costs.face(r(i), r(j), r(k)) : 0);
  };
  const auto with_diagonal = [&](std::size_t i, std::size_t k, double sum) {
    sum += std::min(length_cost * length2(i, k), k_length_cost / static_cast<double>(n));
    if (costs.edge) sum += costs.edge(r(i), r(k));
    if (costs.face) sum += costs.face(r(i), r(k), p) + costs.face(r(i), r(k), q);
    return sum;
  };
  RingFill<k_largest_ring> fill;
  if (!fill.find(n, k_impossible, with_triangle, with_diagonal)) return false;
  std::vector<Corners> made;
  fill.for_triangles([&](std::size_t i, std::size_t j, std::size_t k) {
    made.push_back({r(i), r(j), r(k), q});
    made.push_back({r(i), r(k), r(j), p});
  });
  return replace(ring.tets, made);
}

bool Flips::remove_edge(std::uint32_t p, std::uint32_t q, int depth, const FlipCosts& costs) {
  if (required_.find_edge(p, q) != k_none) return false;
  const bool is_first = effort_ == 0;
  if (is_first) effort_ = k_most_effort;
  const std::size_t before = state();
  bool is_gone = false;
  Ring ring;
  for (bool has_changed = true; has_changed && !is_gone;) {
    has_changed = false;
    if (!find_ring(p, q, ring)) break;
    const std::size_t n_most = is_first ? k_largest_ring : k_largest_other_ring;
    if (ring.vertices.size() > n_most) break;
    if (fill_ring(p, q, ring, costs)) {
      is_gone = true;
      break;
    }
    const std::size_t n = ring.vertices.size();
    if (depth == 0) break;
    for (std::size_t i = 0; i < n && !has_changed; ++i) {
      const std::uint32_t last = ring.vertices[(i + n - 1) % n], at = ring.vertices[i], next = ring.vertices[(i + 1) % n];
      for (const bool is_top : {true, false}) {
        // An ear that can be cut on this side is not an obstruction.
        if (is_top ? is_positive({last, at, next, q}) : is_positive({last, next, at, p})) continue;
        if (--effort_ <= 0) break;
        const std::size_t step = state();
        if (!remove_edge(is_top ? q : p, at, depth - 1, costs)) continue;
        Ring smaller;
        if (find_ring(p, q, smaller) && smaller.vertices.size() < n) {
          has_changed = true;
          break;
        }
        undo(step);
      }
      if (effort_ <= 0) break;
    }
    // Cutting an ear may make others possible.
    for (std::size_t i = 0; i < n && !has_changed && effort_ > 0; ++i) {
      const std::uint32_t t = ring.tets[i], next = ring.vertices[(i + 1) % n];
      has_changed = flip_face(4 * t + static_cast<std::uint32_t>(corner_of(mesh_.nodes[t], next)));
    }
  }
  if (!is_gone) undo(before);
  if (is_first) effort_ = 0;
  return is_gone;
}

/// Returns a tetrahedron of the cavity at a required edge that is not on the cavity's hull, but not the cavity's first tetrahedron; k_none if there is no such
/// edge.
std::uint32_t Flips::tet_around_lost_edge(std::span<const std::uint32_t> cavity, std::span<const Facet> hull) const {
  for (const std::uint32_t t : cavity) {
    const Corners& v = mesh_.nodes[t];
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (required_.find_edge(v[i], v[j]) == k_none) continue;
        const auto is_on = [&](const Facet& f) { return std::ranges::find(f, v[i]) != f.end() && std::ranges::find(f, v[j]) != f.end(); };
        if (std::ranges::any_of(hull, is_on)) continue;
        for (const std::uint32_t other : cavity.subspan(1))
          if (has(mesh_.nodes[other], v[i]) && has(mesh_.nodes[other], v[j])) return other;
      }
    }
  }
  return k_none;
}

bool Flips::add_point(const Vec3& position, std::uint32_t start) {
  // Walk to the tetrahedron that contains the point.
  std::uint32_t base = start;
  for (int step = 0;; ++step) {
    if (step == k_most_walk) return false;
    const Corners& v = mesh_.nodes[base];
    std::uint32_t next = base;
    for (std::size_t i = 0; i < 4 && next == base; ++i) {
      const std::size_t corner = (i + static_cast<std::size_t>(step)) % 4;
      const auto& f = k_face[corner];
      if (orientation(mesh_.points[v[f[0]]], mesh_.points[v[f[1]]], mesh_.points[v[f[2]]], position) >= 0) continue;
      if (mesh_.neighbours[base][corner] == k_none) return false;
      next = mesh_.neighbours[base][corner] / 4;
    }
    if (next == base) break;
    base = next;
  }
  const auto point = static_cast<std::uint32_t>(mesh_.points.size());
  mesh_.points.push_back(position);
  tet_at_.push_back(k_none);

  // Collect the tetrahedra whose spheres contain the point, except those behind required facets. Then remove some of them until all faces are visible and no
  // required edge is lost.
  std::vector<std::uint32_t> cavity = {base};
  std::vector<std::uint32_t> barred;
  const auto is_in = [](const std::vector<std::uint32_t>& list, std::uint32_t t) { return std::ranges::find(list, t) != list.end(); };
  std::vector<Facet> hull;
  for (;;) {
    cavity.assign(1, base);
    for (std::size_t i = 0; i < cavity.size() && cavity.size() < k_most_cavity; ++i) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const std::uint32_t n = mesh_.neighbours[cavity[i]][corner];
        if (n == k_none || is_in(cavity, n / 4) || is_in(barred, n / 4)) continue;
        const Corners& v = mesh_.nodes[cavity[i]];
        const auto& f = k_face[corner];
        if (required_.find_facet(v[f[0]], v[f[1]], v[f[2]]) != k_none) continue;
        if (perturbed_sphere_side(mesh_, mesh_.nodes[n / 4], point) > 0) cavity.push_back(n / 4);
      }
    }
    hull.clear();
    std::uint32_t bad = k_none;
    for (const std::uint32_t t : cavity) {
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const std::uint32_t n = mesh_.neighbours[t][corner];
        if (n != k_none && is_in(cavity, n / 4)) continue;
        const Corners& v = mesh_.nodes[t];
        const Facet f = {v[k_face[corner][0]], v[k_face[corner][1]], v[k_face[corner][2]]};
        hull.push_back(f);
        if (orientation(mesh_.points[f[0]], mesh_.points[f[1]], mesh_.points[f[2]], position) <= 0) bad = t;
      }
    }
    if (bad == k_none) bad = tet_around_lost_edge(cavity, hull);
    if (bad == k_none) break;
    if (bad == base) {
      hull.clear();
      break;
    }
    barred.push_back(bad);
  }
  std::vector<Corners> made;
  for (const Facet& f : hull) made.push_back({f[0], f[1], f[2], point});
  if (!made.empty() && replace(cavity, made)) return true;
  mesh_.points.pop_back();
  tet_at_.pop_back();
  return false;
}

bool Flips::add_point_in_ring(std::uint32_t p, std::uint32_t q, std::uint32_t a, std::uint32_t b, const Vec3& position) {
  Ring ring;
  if (!find_ring(p, q, ring)) return false;
  const std::size_t n = ring.vertices.size();
  const auto first = static_cast<std::size_t>(std::ranges::find(ring.vertices, a) - ring.vertices.begin());
  if (first == n || std::ranges::find(ring.vertices, b) == ring.vertices.end()) return false;
  const auto point = static_cast<std::uint32_t>(mesh_.points.size());
  std::vector<std::uint32_t> cavity;
  std::vector<Corners> made = {{p, q, a, point}, {p, q, point, b}};
  for (std::size_t i = first; ring.vertices[i] != b; i = (i + 1) % n) {
    const std::uint32_t r = ring.vertices[i], s = ring.vertices[(i + 1) % n];
    cavity.push_back(ring.tets[i]);
    made.push_back({p, point, r, s});
    made.push_back({point, q, r, s});
  }
  mesh_.points.push_back(position);
  tet_at_.push_back(k_none);
  if (std::ranges::all_of(made, [&](const Corners& v) { return is_positive(v); }) && replace(cavity, made)) return true;
  mesh_.points.pop_back();
  tet_at_.pop_back();
  return false;
}

}  // namespace sterna::tets
