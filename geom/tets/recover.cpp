#include "geom/tets/recover.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <optional>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/tets/bulk_insert.h"
#include "geom/tets/flips.h"
#include "geom/tets/hilbert_curve.h"
#include "geom/tets/piercing.h"

namespace sterna::tets {
namespace {

/// Width of the box relative to that of the points: its corners must be far from all points.
constexpr double k_box_factor = 8.0;
/// Number of points in the first round. Each following round has k_round_factor times as many points as were inserted before.
constexpr std::size_t k_first_points = 64, k_round_factor = 8;
constexpr int k_most_tries = 4;  ///< attempts per point
/// Largest effort for Delaunay insertion. A point far from all others sees the whole hull: the corners of a room around an aircraft of 300 000 points have
/// cavities of more than 4000 tetrahedra.
constexpr std::size_t k_delaunay_effort = std::size_t{1} << 18;
/// Recursion limit of remove_edge().
constexpr int k_most_depth = 3;
constexpr int k_most_points = 3;  ///< points in the volume per edge or facet
constexpr int k_most_passes = 6;  ///< passes over the missing entities, not counting the first one
/// Distance of new points from a facet's plane, relative to the length of the crossing entities.
constexpr double k_beside = 0.3;
/// Displacement of a new point from a crossing towards an end of the other edge, as a fraction of the way.
constexpr double k_aside = 0.1;
/// Number of halvings of the distance if the surrounding faces are not visible.
constexpr int k_most_edge_halvings = 30;
constexpr std::size_t k_stop_tries = 256;

/// Returns a pseudo-random key, so that neighbours in the list are not neighbours in space (Steele, Lea and Flood 2014).
std::uint64_t shuffled(std::uint64_t i) {
  std::uint64_t z = i + 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

/// Returns the Delaunay mesh of the points and the eight corners of a box, which follow them. Empty if a point could not be inserted, which is reported.
TetMesh delaunay(std::span<const Vec3> points, RecoverFailure& failure, const RunContext& context) {
  const Extent extent = extent_of(points);
  const Vec3 center = 0.5 * (extent.low + extent.high);
  const double reach = 0.5 * k_box_factor * extent.longest_side();
  std::vector<Vec3> corners;
  for (const double z : {-reach, reach})
    for (const double y : {-reach, reach})
      for (const double x : {-reach, reach}) corners.push_back(center + Vec3{x, y, z});
  constexpr std::array<Corners, 6> k_cube = {{{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};
  TetMesh mesh = connect(corners, k_cube, context);

  const std::size_t n = points.size();
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order(n);
  parallel_for(context, n, [&](std::size_t i) { order[i] = {shuffled(i), static_cast<std::uint32_t>(i)}; });
  parallel_sort(context, order, [](const auto& a, const auto& b) { return a < b; });
  // Points are inserted in this order, after the corners. `number` maps each of them to its given index; the corners come last in the given order.
  std::vector<std::uint32_t> number(corners.size());
  std::iota(number.begin(), number.end(), static_cast<std::uint32_t>(n));
  {
    BulkInserter inserter(mesh, context, 0, k_delaunay_effort);
    for (std::size_t first = 0, count = k_first_points; first < n; first += count, count = (k_round_factor - 1) * first) {
      count = std::min(count, n - first);
      std::vector<std::uint32_t> round(count);
      for (std::size_t i = 0; i < count; ++i) round[i] = order[first + i].second;
      // In long and thin regions the walk to some points is too long; it is shorter once their neighbours are inserted.
      for (int tries = 0; tries < k_most_tries && !round.empty(); ++tries) {
        std::vector<Seed> seeds(round.size());
        for (std::size_t i = 0; i < round.size(); ++i) seeds[i].position = points[round[i]];
        inserter.find_starts(seeds, context);
        const std::vector<Insertion> results = inserter.insert(seeds, context);
        number.insert(number.end(), round.begin(), round.end());
        std::size_t n_left = 0;
        for (std::size_t i = 0; i < round.size(); ++i)
          if (results[i] != Insertion::done) round[n_left++] = round[i];
        round.resize(n_left);
      }
      for (const std::uint32_t v : round)
        if (failure.n_locations++ < static_cast<std::int64_t>(k_max_locations)) failure.locations.push_back(points[v]);
    }
  }
  if (failure.n_locations > 0) {
    failure.problem = std::to_string(failure.n_locations) + " points of the boundary cannot be inserted into the tetrahedral mesh";
    return {};
  }
  parallel_for(context, mesh.nodes.size(), [&](std::size_t t) {
    if (!mesh.is_alive(static_cast<std::uint32_t>(t))) return;
    for (std::uint32_t& v : mesh.nodes[t]) v = number[v];
  });
  mesh.points.assign(points.begin(), points.end());
  mesh.points.insert(mesh.points.end(), corners.begin(), corners.end());
  return mesh;
}

/// Returns the numbers of indexed entities that the mesh does not contain.
template <class Mark>
std::vector<std::uint32_t> missing(std::size_t n, const TetMesh& mesh, const Mark& mark, const RunContext& context) {
  std::vector<std::uint8_t> is_there(n, 0);
  parallel_for(context, mesh.nodes.size(), [&](std::size_t t) {
    if (!mesh.is_alive(static_cast<std::uint32_t>(t))) return;
    mark(mesh.nodes[t], [&](std::uint32_t i) {
      if (i != FacetIndex::k_missing) std::atomic_ref(is_there[i]).store(1, std::memory_order_relaxed);
    });
  });
  std::vector<std::uint32_t> list;
  for (std::uint32_t i = 0; i < n; ++i)
    if (!is_there[i]) list.push_back(i);
  return list;
}

class Recoverer {
 public:
  Recoverer(TetMesh& mesh, const FacetIndex& required, const RunContext& context)
      : mesh_(mesh), required_(required), context_(context), flips_(mesh, required) {}

  /// Recovers edges, then facets. Remaining ones are reported.
  void run(RecoverReport& report, RecoverFailure& failure);

 private:
  enum class Made { no, yes, barred };
  Made make_edge(const Edge& edge, int depth);
  Made make_facet(const Facet& facet, int depth);
  bool add_points_beside(const Vec3& at, const Vec3& normal, double length, std::uint32_t start, RecoverReport& report);
  bool add_points_in_ring(const Edge& edge, const Edge& across, const Vec3& at, const Vec3& normal, double length, RecoverReport& report);
  bool help_edge(const Edge& edge, int n_before, RecoverReport& report);
  bool help_facet(const Facet& facet, int n_before, RecoverReport& report);
  template <class Make, class Help>
  void make_all(std::vector<std::uint32_t>& list, const Make& make, const Help& help);
  /// Makes the changes by `flip`, and keeps them if `count` decreases.
  template <class Flip, class Count>
  bool try_flip(const Flip& flip, const Count& count, std::size_t n_before);

  TetMesh& mesh_;
  const FacetIndex& required_;
  const RunContext& context_;
  Flips flips_;
};

template <class Flip, class Count>
bool Recoverer::try_flip(const Flip& flip, const Count& count, std::size_t n_before) {
  const std::size_t before = flips_.state();
  if (!flip()) return false;
  const auto now = count();
  if (now && now->size() < n_before) {
    flips_.accept();
    return true;
  }
  flips_.undo(before);
  return false;
}

Recoverer::Made Recoverer::make_edge(const Edge& edge, int depth) {
  const auto count = [&] { return crossings(flips_, edge[0], edge[1]); };
  const FlipCosts costs{.edge = {},
                        .face = [&](std::uint32_t u, std::uint32_t v, std::uint32_t w) { return pierces(mesh_, edge[0], edge[1], u, v, w) ? 1 : 0; }};
  for (;;) {
    const std::optional<std::vector<Crossing>> way = count();
    if (!way) return Made::barred;
    if (way->empty()) return Made::yes;
    const std::size_t n = way->size();
    bool has_changed = false;
    std::vector<Edge> tried;
    const auto try_edge = [&](std::uint32_t p, std::uint32_t q) {
      const Edge e = {std::min(p, q), std::max(p, q)};
      if (std::ranges::find(tried, e) != tried.end()) return false;
      tried.push_back(e);
      return try_flip([&] { return flips_.remove_edge(p, q, depth, costs); }, count, n);
    };
    for (const Crossing& c : *way) {
      if (c.is_edge) {
        has_changed = try_edge(c.edge[0], c.edge[1]);
      } else {
        has_changed = try_flip([&] { return flips_.flip_face(c.face); }, count, n);
        const Corners v = mesh_.nodes[c.face / 4];
        const auto& f = k_face[c.face % 4];
        for (std::size_t i = 0; i < 3 && !has_changed; ++i) has_changed = try_edge(v[f[i]], v[f[(i + 1) % 3]]);
      }
      if (has_changed) break;
    }
    if (!has_changed) return Made::no;
  }
}

Recoverer::Made Recoverer::make_facet(const Facet& facet, int depth) {
  const auto count = [&] { return piercing_edges(flips_, facet); };
  const FlipCosts costs{.edge = [&](std::uint32_t p, std::uint32_t q) { return pierces(mesh_, p, q, facet[0], facet[1], facet[2]) ? 1 : 0; }, .face = {}};
  for (;;) {
    const std::optional<std::vector<Edge>> edges = count();
    if (!edges) return Made::barred;
    if (edges->empty()) return Made::yes;
    bool has_changed = false;
    for (const Edge& e : *edges) {
      has_changed = try_flip([&] { return flips_.remove_edge(e[0], e[1], depth, costs); }, count, edges->size());
      if (has_changed) break;
    }
    if (!has_changed) return Made::no;
  }
}

/// Returns a length for new points. It is the shorter of two crossing lengths first; in later tries it approaches the width of the region that the crossings
/// span, which is much smaller for slivers.
double between(double a, double b, double area, int n_before) {
  const double width = area / std::max(a, b), share = std::min(1.0, n_before / static_cast<double>(k_most_points - 1));
  return std::min(a, b) * std::pow(std::min(1.0, width / std::min(a, b)), share);
}

/// Adds a point on each side of a plane, at a distance relative to the local size. Connections across the plane then end at these points.
bool Recoverer::add_points_beside(const Vec3& at, const Vec3& normal, double length, std::uint32_t start, RecoverReport& report) {
  bool is_done = false;
  for (const double side : {k_beside, -k_beside}) {
    if (!mesh_.is_alive(start)) start = flips_.tet_at(static_cast<std::uint32_t>(mesh_.points.size() - 1));
    if (!flips_.add_point(at + side * length * normalized(normal), start)) continue;
    flips_.accept();
    ++report.n_points;
    is_done = true;
  }
  return is_done;
}

/// Adds points for an edge that crosses one other edge in its plane and nothing else, one on each side. The points are so near that the whole ring around the
/// other edge is visible from them; that edge can then always be replaced.
bool Recoverer::add_points_in_ring(const Edge& edge, const Edge& across, const Vec3& at, const Vec3& normal, double length, RecoverReport& report) {
  const auto [p, q] = across;
  const Vec3 from = mesh_.points[p];
  const Vec3 aside = at + k_aside * (from - at);  // off the crossing: otherwise the edge between both points would be as good as the required one
  const double side = dot(cross(mesh_.points[q] - from, mesh_.points[edge[0]] - from), normal) > 0.0 ? 1.0 : -1.0;
  for (const bool is_first : {true, false}) {
    const Edge ends = is_first ? edge : Edge{edge[1], edge[0]};
    double beside = (is_first ? side : -side) * k_beside * length;
    int n_halvings = 0;
    while (!flips_.add_point_in_ring(p, q, ends[0], ends[1], aside + beside * normalized(normal))) {
      if (++n_halvings > k_most_edge_halvings) return false;
      beside *= 0.5;
    }
    flips_.accept();
    ++report.n_points;
  }
  return true;
}

bool Recoverer::help_edge(const Edge& edge, int n_before, RecoverReport& report) {
  const std::optional<std::vector<Crossing>> way = crossings(flips_, edge[0], edge[1]);
  if (!way || way->empty()) return false;
  const Crossing& c = (*way)[way->size() / 2];
  const Vec3 &a = mesh_.points[edge[0]], &b = mesh_.points[edge[1]];
  if (c.is_edge) {
    const Vec3 &p = mesh_.points[c.edge[0]], &q = mesh_.points[c.edge[1]];
    const Vec3 normal = cross(b - a, q - p);
    const double t = dot(cross(p - a, q - p), normal) / norm2(normal);  // crossing of the two edges
    if (!std::isfinite(t)) return false;
    const Vec3 at = a + std::clamp(t, 0.0, 1.0) * (b - a);
    const double length = between(norm(b - a), norm(q - p), norm(normal), n_before);
    if (way->size() == 1 && add_points_in_ring(edge, c.edge, at, normal, length, report)) return true;
    return add_points_beside(at, normal, length, flips_.tet_with_edge(c.edge[0], c.edge[1]), report);
  }
  const Corners& v = mesh_.nodes[c.face / 4];
  const Vec3 middle = 0.25 * (mesh_.points[v[0]] + mesh_.points[v[1]] + mesh_.points[v[2]] + mesh_.points[v[3]]);
  if (!flips_.add_point(middle, c.face / 4)) return false;
  flips_.accept();
  ++report.n_points;
  return true;
}

bool Recoverer::help_facet(const Facet& facet, int n_before, RecoverReport& report) {
  const std::optional<std::vector<Edge>> edges = piercing_edges(flips_, facet);
  if (!edges || edges->empty()) return false;
  const Edge& e = (*edges)[edges->size() / 2];
  const Vec3 &a = mesh_.points[facet[0]], &p = mesh_.points[e[0]], &q = mesh_.points[e[1]];
  const Vec3 normal = cross(mesh_.points[facet[1]] - a, mesh_.points[facet[2]] - a);
  const double t = dot(a - p, normal) / dot(q - p, normal);  // piercing point of the edge
  if (!std::isfinite(t)) return false;
  const double length = std::max(distance(a, mesh_.points[facet[1]]), distance(a, mesh_.points[facet[2]]));
  return add_points_beside(p + std::clamp(t, 0.0, 1.0) * (q - p), normal, between(length, norm(q - p), norm(normal), n_before),
                           flips_.tet_with_edge(e[0], e[1]), report);
}

/// Recovers the edges or facets of the list. Afterwards the list contains those that could not be recovered. The list is processed in several passes, because
/// some become recoverable when others exist.
template <class Make, class Help>
void Recoverer::make_all(std::vector<std::uint32_t>& list, const Make& make, const Help& help) {
  std::size_t n_tries = 0;
  for (int pass = 0; pass <= k_most_passes && !list.empty(); ++pass) {
    const std::size_t n_before = list.size();
    const bool may_help = pass >= 2;
    std::vector<std::uint32_t> left;
    for (const std::uint32_t i : list) {
      if (++n_tries % k_stop_tries == 0) context_.check_stop();
      Made made = Made::no;
      for (int n_points = 0; made == Made::no; ++n_points) {
        for (int depth = 0; made == Made::no && depth <= std::min(pass + 1, k_most_depth); ++depth) made = make(i, depth);
        if (made != Made::no || !may_help || n_points >= k_most_points || !help(i, n_points)) break;
      }
      if (made != Made::yes) left.push_back(i);
    }
    list = std::move(left);
    if (list.size() == n_before && may_help) break;
  }
}

void Recoverer::run(RecoverReport& report, RecoverFailure& failure) {
  const auto describe = [&](const std::string& what, std::size_t n, const auto& location) {
    failure.problem = std::to_string(n) + " " + what + " of the boundary could not be recovered in the mesh";
    failure.n_locations = static_cast<std::int64_t>(n);
    for (std::size_t i = 0; i < std::min(n, k_max_locations); ++i) failure.locations.push_back(location(i));
  };
  const auto mark_edges = [&](const Corners& v, const auto& mark) {
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) mark(required_.find_edge(v[i], v[j]));
  };
  std::vector<std::uint32_t> edges = missing(required_.n_edges(), mesh_, mark_edges, context_);
  report.n_missing_edges = static_cast<std::int64_t>(edges.size());
  make_all(
      edges, [&](std::uint32_t i, int depth) { return make_edge(required_.edge(i), depth); },
      [&](std::uint32_t i, int n_before) { return help_edge(required_.edge(i), n_before, report); });
  if (!edges.empty())
    return describe("edges", edges.size(),
                    [&](std::size_t i) { return 0.5 * (mesh_.points[required_.edge(edges[i])[0]] + mesh_.points[required_.edge(edges[i])[1]]); });

  const auto mark_facets = [&](const Corners& v, const auto& mark) {
    for (const auto& f : k_face) mark(required_.find_facet(v[f[0]], v[f[1]], v[f[2]]));
  };
  std::vector<std::uint32_t> facets = missing(required_.facets().size(), mesh_, mark_facets, context_);
  report.n_missing_facets = static_cast<std::int64_t>(facets.size());
  make_all(
      facets, [&](std::uint32_t i, int depth) { return make_facet(required_.facets()[i], depth); },
      [&](std::uint32_t i, int n_before) { return help_facet(required_.facets()[i], n_before, report); });
  if (!facets.empty())
    return describe("triangles", facets.size(), [&](std::size_t i) {
      const Facet& f = required_.facets()[facets[i]];
      return (mesh_.points[f[0]] + mesh_.points[f[1]] + mesh_.points[f[2]]) / 3.0;
    });
}

/// Keeps the tetrahedra on the side of the facets to which their normals point. Returns false if that is not a single side.
bool keep_domain(TetMesh& mesh, const FacetIndex& required, std::size_t n_facets, std::size_t n_points, const RunContext& context) {
  // First give facets no neighbour on either side. Then let the inside grow from the inner side of each facet.
  constexpr std::uint8_t k_outside = 0, k_inside = 1;
  std::vector<std::uint8_t> side(mesh.nodes.size(), k_outside);
  struct Cut {
    std::uint32_t face, facet;
  };
  const std::vector<Cut> cuts = parallel_collect<Cut>(context, mesh.nodes.size(), [&](std::size_t begin, std::size_t end, std::vector<Cut>& list) {
    for (std::size_t t = begin; t < end; ++t) {
      if (!mesh.is_alive(static_cast<std::uint32_t>(t))) continue;
      const Corners& v = mesh.nodes[t];
      for (std::uint32_t corner = 0; corner < 4; ++corner) {
        const auto& f = k_face[corner];
        const std::uint32_t facet = required.find_facet(v[f[0]], v[f[1]], v[f[2]]);
        if (facet < n_facets) list.push_back({static_cast<std::uint32_t>(4 * t + corner), facet});
      }
    }
  });
  std::vector<std::uint32_t> reached, behind;
  for (const Cut& cut : cuts) {
    const std::uint32_t t = cut.face / 4;
    mesh.neighbours[t][cut.face % 4] = k_none;
    const Facet& facet = required.facets()[cut.facet];
    const auto& f = k_face[cut.face % 4];
    const std::size_t at = static_cast<std::size_t>(std::ranges::find(facet, mesh.nodes[t][f[0]]) - facet.begin());
    if (facet[(at + 1) % 3] == mesh.nodes[t][f[1]]) {
      if (side[t] != k_inside) reached.push_back(t);
      side[t] = k_inside;
    } else {
      behind.push_back(t);
    }
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const std::uint32_t n : mesh.neighbours[reached[i]]) {
      if (n == k_none || side[n / 4] == k_inside) continue;
      side[n / 4] = k_inside;
      reached.push_back(n / 4);
    }
  }
  for (const std::uint32_t t : behind)
    if (side[t] == k_inside) return false;
  for (const std::uint32_t t : reached)
    for (const std::uint32_t v : mesh.nodes[t])
      if (v >= n_points && v < n_points + 8) return false;  // a corner of the box
  for (std::size_t t = 0; t < mesh.nodes.size(); ++t)
    if (side[t] != k_inside) mesh.nodes[t] = {k_none, k_none, k_none, k_none};
  return true;
}

}  // namespace

Recovery recover(std::span<const Vec3> points, std::span<const Facet> facets, std::span<const Facet> baffles, const RunContext& context) {
  Recovery recovery;
  recovery.mesh = delaunay(points, recovery.failure, context);
  if (!recovery.failure.problem.empty()) return recovery;
  std::vector<Facet> all(facets.begin(), facets.end());
  all.insert(all.end(), baffles.begin(), baffles.end());
  const FacetIndex required(all, points.size(), context);
  recovery.report.n_edges = static_cast<std::int64_t>(required.n_edges());
  recovery.report.n_facets = static_cast<std::int64_t>(all.size());
  Recoverer(recovery.mesh, required, context).run(recovery.report, recovery.failure);
  if (recovery.failure.problem.empty() && !keep_domain(recovery.mesh, required, facets.size(), points.size(), context))
    recovery.failure.problem = "the normals of the boundary do not all point to the same side";
  if (!recovery.failure.problem.empty()) {
    recovery.mesh = {};
    return recovery;
  }
  compact(recovery.mesh, static_cast<std::uint32_t>(points.size()));
  recovery.report.n_points = static_cast<std::int64_t>(recovery.mesh.points.size() - points.size());  // points outside have been removed
  return recovery;
}

}  // namespace sterna::tets
