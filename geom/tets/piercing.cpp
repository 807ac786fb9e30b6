#include "geom/tets/piercing.h"

#include <algorithm>

#include "geom/tets/signs.h"

namespace sterna::tets {
namespace {

constexpr std::size_t k_most_crossings = 5000;  ///< beyond this number the search is not worth continuing

/// Walk from a to b, one element after the other.
class Walk {
 public:
  Walk(Flips& flips, std::uint32_t a, std::uint32_t b) : flips_(flips), mesh_(flips.mesh()), a_(a), b_(b) {}

  std::optional<std::vector<Crossing>> run() {
    std::vector<Crossing> all;
    for (Step step = leave_a(); step != Step::there; step = next_.is_edge ? past_edge() : past_face()) {
      if (step == Step::barred || all.size() >= k_most_crossings) return std::nullopt;
      all.push_back(next_);
    }
    return all;
  }

 private:
  enum class Step { there, on, barred };

  int sign(std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) const {
    return orientation(mesh_.points[p], mesh_.points[q], mesh_.points[r], mesh_.points[s]);
  }
  Step through_face(std::uint32_t face) {
    next_ = {.is_edge = false, .face = face};
    return Step::on;
  }
  Step through_edge(std::uint32_t p, std::uint32_t q) {
    next_ = {.is_edge = true, .edge = {p, q}};
    return Step::on;
  }

  Step leave_a() {
    flips_.star(a_, star_);
    for (const std::uint32_t t : star_)
      if (std::ranges::find(mesh_.nodes[t], b_) != mesh_.nodes[t].end()) return Step::there;
    for (const std::uint32_t t : star_) {
      const std::uint32_t corner = static_cast<std::uint32_t>(std::ranges::find(mesh_.nodes[t], a_) - mesh_.nodes[t].begin());
      const auto& f = k_face[corner];
      const std::array<std::uint32_t, 3> v = {mesh_.nodes[t][f[0]], mesh_.nodes[t][f[1]], mesh_.nodes[t][f[2]]};
      int n_zero = 0;
      std::size_t zero = 0;
      bool is_inside = true;
      for (std::size_t i = 0; i < 3 && is_inside; ++i) {
        const int side = sign(v[(i + 1) % 3], v[i], a_, b_);  // side of b relative to the plane through a and the edge from v[i]
        is_inside = side >= 0;
        if (side != 0) continue;
        ++n_zero;
        zero = i;
      }
      if (!is_inside) continue;
      if (n_zero > 1) return Step::barred;
      return n_zero == 1 ? through_edge(v[zero], v[(zero + 1) % 3]) : through_face(4 * t + corner);
    }
    return Step::barred;
  }

  Step past_face() {
    const std::uint32_t n = mesh_.neighbours[next_.face / 4][next_.face % 4];
    if (n == k_none) return Step::barred;
    const std::uint32_t t = n / 4, corner = n % 4, x = mesh_.nodes[t][corner];
    if (x == b_) return Step::there;
    const auto& f = k_face[corner];
    std::array<int, 3> side{};
    for (std::size_t i = 0; i < 3; ++i) side[i] = sign(a_, b_, x, mesh_.nodes[t][f[i]]);
    for (std::size_t i = 0; i < 3; ++i) {
      const int last = side[(i + 2) % 3], next = side[(i + 1) % 3];
      if (next > 0 && last < 0) return through_face(4 * t + f[i]);
      if (side[i] == 0 && next < 0 && last > 0) return through_edge(mesh_.nodes[t][f[i]], x);
    }
    return Step::barred;
  }

  Step past_edge() {
    const auto [p, q] = next_.edge;
    if (!flips_.find_ring(p, q, ring_)) return Step::barred;
    const std::size_t n = ring_.vertices.size();
    if (std::ranges::find(ring_.vertices, b_) != ring_.vertices.end()) return Step::there;
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t r = ring_.vertices[i], s = ring_.vertices[(i + 1) % n];
      const int from_r = sign(p, q, r, b_), to_s = sign(p, q, b_, s);
      if (from_r < 0 || to_s < 0) continue;
      if (from_r == 0 && to_s == 0) continue;
      if (from_r == 0 || to_s == 0) {
        const std::uint32_t flat = from_r == 0 ? r : s, beside = from_r == 0 ? s : r;
        const int side = sign(a_, b_, beside, flat);
        if (side == 0) return Step::barred;
        return through_edge(side == sign(a_, b_, beside, p) ? q : p, flat);
      }
      const int between = sign(a_, b_, r, s);
      if (between == 0) return through_edge(r, s);
      const std::uint32_t exit_without = between == sign(a_, b_, p, r) ? q : p;  // the exit face contains the other vertex
      const Corners& v = mesh_.nodes[ring_.tets[i]];
      return through_face(4 * ring_.tets[i] + static_cast<std::uint32_t>(std::ranges::find(v, exit_without) - v.begin()));
    }
    return Step::barred;
  }

  Flips& flips_;
  const TetMesh& mesh_;
  std::uint32_t a_, b_;
  Crossing next_;
  std::vector<std::uint32_t> star_;
  Ring ring_;
};

}  // namespace

std::optional<std::vector<Crossing>> crossings(Flips& flips, std::uint32_t a, std::uint32_t b) { return Walk(flips, a, b).run(); }

bool pierces(const TetMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t u, std::uint32_t v, std::uint32_t w) {
  for (const std::uint32_t end : {a, b})
    if (end == u || end == v || end == w) return false;
  const auto sign = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k, std::uint32_t l) {
    return orientation(mesh.points[i], mesh.points[j], mesh.points[k], mesh.points[l]);
  };
  if (sign(u, v, w, a) * sign(u, v, w, b) >= 0) return false;
  const int first = sign(a, b, u, v);
  return first != 0 && sign(a, b, v, w) == first && sign(a, b, w, u) == first;
}

std::optional<std::vector<Edge>> piercing_edges(Flips& flips, const Facet& facet) {
  const TetMesh& mesh = flips.mesh();
  const auto [a, b, c] = facet;
  Ring ring;
  if (!flips.find_ring(a, b, ring)) return std::nullopt;
  if (std::ranges::find(ring.vertices, c) != ring.vertices.end()) return std::vector<Edge>{};
  std::vector<Edge> found;
  const auto sign = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k, std::uint32_t l) {
    return orientation(mesh.points[i], mesh.points[j], mesh.points[k], mesh.points[l]);
  };
  for (std::size_t i = 0; i < ring.vertices.size(); ++i) {
    const std::uint32_t r = ring.vertices[i], s = ring.vertices[(i + 1) % ring.vertices.size()];
    if (sign(a, b, r, c) <= 0 || sign(a, b, c, s) <= 0) continue;
    if (pierces(mesh, r, s, a, b, c)) found.push_back({std::min(r, s), std::max(r, s)});
    break;
  }
  if (found.empty()) return std::nullopt;
  // Move from tetrahedron to tetrahedron around each piercing edge.
  for (std::size_t k = 0; k < found.size() && found.size() < k_most_crossings; ++k) {
    const auto [p, q] = found[k];
    if (!flips.find_ring(p, q, ring)) return std::nullopt;
    const std::size_t n = ring.vertices.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t r = ring.vertices[i], s = ring.vertices[(i + 1) % n];
      for (const Edge& e : {Edge{p, r}, Edge{q, r}, Edge{r, s}}) {
        const Edge sorted = {std::min(e[0], e[1]), std::max(e[0], e[1])};
        if (std::ranges::find(found, sorted) == found.end() && pierces(mesh, e[0], e[1], a, b, c)) found.push_back(sorted);
      }
    }
  }
  return found;
}

}  // namespace sterna::tets
