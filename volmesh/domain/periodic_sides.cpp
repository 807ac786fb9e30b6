// Steps for each pair: find_patch; flatten the first side; match the border vertices of both sides (match_borders) and the direction of the edges between them.
// If the triangles of the second side are the image of those of the first, the vertices of the second are moved onto the images. Otherwise its triangles are
// replaced by those of the first.
#include "volmesh/domain/periodic_sides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/schema.h"
#include "volmesh/domain/flat_patch.h"

namespace sterna::volmesh {
namespace {

constexpr double k_facing_cosine = -0.999;  ///< largest cosine between the normals of opposite sides; k_side_tolerance permits smaller deviations only

constexpr double k_slide = 0.35;      ///< fraction of the shorter edge at a border vertex: largest movement along the border that keeps its triangles valid
constexpr double k_slide_off = 0.03;  ///< fraction of that edge: largest distance of the image from the border, because curved borders are polygons

using Edge = std::array<VertexId, 2>;

class Joiner {
 public:
  Joiner(TriMesh& mesh, const PeriodicNames& names, Column<TriangleId, TriangleId>& sources)
      : mesh_(mesh), names_(names), sources_(sources), tolerance_(k_side_tolerance * bounding_box(mesh).longest_side()) {
    error_.code = ErrorCode::bad_argument;
    error_.attempted = "making \"" + names.first + "\" and \"" + names.second + "\" periodic";
    error_.hint =
        "periodic sides must be flat, face each other, and have the same border vertices, moved by one translation: surface_mesh{ ..., periodic = { { \"" +
        names.first + "\", \"" + names.second + "\" } } } meshes the borders of both model faces alike (sterna surface --periodic \"" + names.first + "," +
        names.second + "\"); for triangulated surfaces, make one side and copy it";
    result_.first = find_patch(names.first);
    result_.second = find_patch(names.second);
    if (result_.first == result_.second) fail("a patch cannot be periodic with itself");
  }

  PeriodicPatches join(const RunContext& context) {
    for (const PatchId side : {result_.first, result_.second}) mesh_.patches[side].kind = PatchKind::interface;
    const Vec3 first_normal = flatten(result_.first), second_normal = flatten(result_.second);
    if (dot(first_normal, second_normal) > k_facing_cosine) fail("the normals of the two sides do not point in opposite directions");
    const std::vector<Edge> first = border_of(result_.first), second = border_of(result_.second);
    find_translation(vertices_of(first), vertices_of(second));
    if (!match(vertices_of(first), vertices_of(second), partner_, false) && !slide(first, second, context)) {
      partner_.clear();
      match(vertices_of(first), vertices_of(second), partner_, true);
    }
    require_same_edges(first, second);
    if (!match_inside()) copy_inside(context);
    for (const auto& [a, b] : partner_) {
      mesh_.points[b] = mesh_.points[a] + result_.translation;
      result_.vertices.push_back({a, b});
    }
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(std::string problem) {
    error_.problem = std::move(problem);
    throw Error(std::move(error_));
  }
  void note(const Point& location, std::string what) {
    ++error_.n_locations;
    if (error_.locations.size() < k_max_locations) error_.locations.push_back({location, std::move(what)});
  }
  static std::string metres(double x) { return in_metres(x, 3); }

  PatchId find_patch(const std::string& name) {
    std::vector<std::string> known;
    for (const Patch& patch : mesh_.patches) known.push_back(patch.name);
    const auto found = std::ranges::find(known, name);
    if (found != known.end()) return PatchId(static_cast<std::size_t>(found - known.begin()));
    std::string all;
    for (const std::string& one : known) all += (all.empty() ? "" : ", ") + one;
    const std::string nearest = nearest_name(name, known);
    error_.hint = "the patches are " + all;
    fail("there is no patch \"" + name + "\"" + (nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?"));
  }

  /// Moves a side into its plane. Returns the normal of the plane.
  Vec3 flatten(PatchId side) {
    const PatchVertices vertices(mesh_, side);
    if (vertices.vertices().empty()) fail("patch \"" + mesh_.patches[side].name + "\" has no triangles");
    const FlatFit flat = vertices.fit([&](const Point&) { return tolerance_; });
    if (!flat.is_flat) {
      if (flat.farthest.is_valid()) note(mesh_.points[flat.farthest], "distance from the plane " + metres(flat.distance));
      fail("patch \"" + mesh_.patches[side].name + "\" is not flat: a vertex is " + metres(flat.distance) + " from its mean plane, limit " +
           metres(tolerance_));
    }
    if (side == result_.second) return flat.normal;  // the second side is moved later, onto the image of the first
    for (const VertexId v : vertices.vertices()) {
      Point& p = mesh_.points[v];
      p -= dot(p - flat.point, flat.normal) * flat.normal;
      for (std::size_t k = 0; k < 3; ++k)
        if (std::abs(flat.normal[k]) == 1.0) p[k] = flat.point[k];
    }
    return flat.normal;
  }

  /// Returns the half-edges of a side's triangles that have no twin among these triangles, in order.
  std::vector<Edge> border_of(PatchId side) {
    std::set<Edge> edges;
    for (const TriangleId t : mesh_.triangles.ids()) {
      if (mesh_.triangle_patch[t] != side) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId a = mesh_.triangles[t][k], b = mesh_.triangles[t][(k + 1) % 3];
        if (edges.erase({b, a}) == 0) edges.insert({a, b});
      }
    }
    if (edges.empty()) fail("patch \"" + mesh_.patches[side].name + "\" has no border");
    return {edges.begin(), edges.end()};
  }
  static std::vector<VertexId> vertices_of(const std::vector<Edge>& edges) {
    std::vector<VertexId> vertices;
    for (const Edge& edge : edges) vertices.insert(vertices.end(), edge.begin(), edge.end());
    std::ranges::sort(vertices);
    const auto rest = std::ranges::unique(vertices);
    vertices.erase(rest.begin(), rest.end());
    return vertices;
  }

  void find_translation(const std::vector<VertexId>& first, const std::vector<VertexId>& second) {
    // Medians of coordinates are used, because the median of the image is the image of the median, and a few displaced vertices do not affect it.
    const auto median = [&](const std::vector<VertexId>& vertices, std::size_t axis) {
      std::vector<double> values;
      for (const VertexId v : vertices) values.push_back(mesh_.points[v][axis]);
      std::ranges::sort(values);
      return values[values.size() / 2];
    };
    for (std::size_t k = 0; k < 3; ++k) result_.translation[k] = median(second, k) - median(first, k);
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(result_.translation[k]) <= tolerance_) result_.translation[k] = 0.0;
  }

  /// Matches vertices of `first` with vertices of `second` and adds the pairs to `partner`. Returns true if each vertex has its own partner. \throws if not all
  /// match and `must` is set
  bool match(const std::vector<VertexId>& first, const std::vector<VertexId>& second, std::map<VertexId, VertexId>& partner, bool must) {
    std::vector<std::pair<double, VertexId>> sorted;
    const auto key = [](const Point& p) {
      return p.x + 0.7 * p.y + 0.4 * p.z;
    };  // key that differs between the points of sides along coordinate axes; it changes by at most sqrt(3) times the distance moved
    for (const VertexId v : second) sorted.emplace_back(key(mesh_.points[v]), v);
    std::ranges::sort(sorted);
    std::set<VertexId> is_taken;
    bool is_matched = true;
    for (const VertexId v : first) {
      const Point image = mesh_.points[v] + result_.translation;
      double least = std::numeric_limits<double>::infinity();
      VertexId nearest;
      for (auto it = std::ranges::lower_bound(sorted, std::pair(key(image) - 2.0 * tolerance_, VertexId(0u)));
           it != sorted.end() && it->first <= key(image) + 2.0 * tolerance_; ++it) {
        const double d = distance(image, mesh_.points[it->second]);
        if (d > tolerance_ || d >= least) continue;
        least = d;
        nearest = it->second;
      }
      if (nearest.is_valid() && is_taken.insert(nearest).second) {
        partner[v] = nearest;
        continue;
      }
      is_matched = false;
      if (must) note(mesh_.points[v], "no vertex at the periodic image; the nearest vertex is " + metres(distance_to(second, image)) + " away");
    }
    is_matched = is_matched && first.size() == second.size();
    if (!must) return is_matched;
    for (const VertexId v : second)
      if (!is_taken.contains(v))
        note(mesh_.points[v],
             "not the periodic image of a vertex; the nearest image is " + metres(distance_to(first, mesh_.points[v] - result_.translation)) + " away");
    if (error_.n_locations > 0)
      fail(std::to_string(error_.n_locations) + " border vertices have no partner within " + metres(tolerance_) + " (" + std::to_string(first.size()) +
           " on \"" + names_.first + "\", " + std::to_string(second.size()) + " on \"" + names_.second + "\", " + format_point(result_.translation) +
           " m between the sides)");
    return true;
  }
  /// Matches borders that follow the same lines with equally many edges but different vertex locations. Such borders come from meshers whose sizes on the two
  /// sides differ slightly. The translation is then that of the boxes of the sides, and vertices of the second side move along its border to the images.
  /// Returns true if that is possible.
  bool slide(const std::vector<Edge>& first, const std::vector<Edge>& second, const RunContext& context) {
    const std::vector<VertexId> of_first = vertices_of(first), of_second = vertices_of(second);
    if (of_first.size() != of_second.size()) return false;
    Box here, there;
    for (const VertexId v : of_first) here.add(mesh_.points[v]);
    for (const VertexId v : of_second) there.add(mesh_.points[v]);
    const Vec3 by_median = result_.translation;
    result_.translation = 0.5 * (there.min - here.min) + 0.5 * (there.max - here.max);
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(result_.translation[k]) <= tolerance_) result_.translation[k] = 0.0;
    std::map<VertexId, std::vector<VertexId>> around;
    for (const auto& [a, b] : second) {
      around[a].push_back(b);
      around[b].push_back(a);
    }
    std::map<VertexId, VertexId> partner;
    std::set<VertexId> is_taken;
    double farthest = 0.0;
    for (const VertexId v : of_first) {
      const Point image = mesh_.points[v] + result_.translation;
      const VertexId nearest = *std::ranges::min_element(of_second, {}, [&](VertexId w) { return distance(image, mesh_.points[w]); });
      double edge = 1e300, off = 1e300;
      for (const VertexId w : around[nearest]) {
        const Vec3 along = mesh_.points[w] - mesh_.points[nearest], way = image - mesh_.points[nearest];
        edge = std::min(edge, norm(along));
        off = std::min(off, norm(way - std::clamp(dot(way, along) / norm2(along), 0.0, 1.0) * along));
      }
      const double moved = distance(image, mesh_.points[nearest]);
      if (moved > k_slide * edge || off > k_slide_off * edge || !is_taken.insert(nearest).second) {
        result_.translation = by_median;
        return false;
      }
      farthest = std::max(farthest, moved);
      partner[v] = nearest;
    }
    partner_ = std::move(partner);
    context.info("border vertices of periodic side \"" + names_.second + "\" are moved along the border to the images of the border vertices of \"" +
                 names_.first + "\", by " + metres(farthest) + " at most");
    return true;
  }

  double distance_to(const std::vector<VertexId>& vertices, const Point& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const VertexId v : vertices) least = std::min(least, distance(p, mesh_.points[v]));
    return least;
  }

  void require_same_edges(const std::vector<Edge>& first, const std::vector<Edge>& second) {
    const std::set<Edge> others(second.begin(), second.end());
    for (const Edge& edge : first)
      if (!others.contains({partner_.at(edge[1]), partner_.at(edge[0])}))
        note(0.5 * (mesh_.points[edge[0]] + mesh_.points[edge[1]]), "no border edge at the periodic image");
    if (error_.n_locations > 0) fail("the borders have the same vertices, but " + std::to_string(error_.n_locations) + " edges differ");
  }

  std::vector<TriangleId> triangles_of(PatchId side) const {
    std::vector<TriangleId> triangles;
    for (const TriangleId t : mesh_.triangles.ids())
      if (mesh_.triangle_patch[t] == side) triangles.push_back(t);
    return triangles;
  }
  std::vector<VertexId> inner_of(PatchId side, const std::vector<VertexId>& border) const {
    std::vector<VertexId> inner;
    std::ranges::set_difference(PatchVertices(mesh_, side).vertices(), border, std::back_inserter(inner));
    return inner;
  }

  /// Returns true if the interior vertices and the triangles also match. All partners are then known.
  bool match_inside() {
    std::vector<VertexId> of_first, of_second;
    for (const auto& [a, b] : partner_) {
      of_first.push_back(a);
      of_second.push_back(b);
    }
    std::ranges::sort(of_second);
    std::map<VertexId, VertexId> all = partner_;
    if (!match(inner_of(result_.first, of_first), inner_of(result_.second, of_second), all, false)) return false;
    const auto in_order = [](TriangleVertices v) {
      std::rotate(v.begin(), std::ranges::min_element(v), v.end());
      return v;
    };
    std::set<TriangleVertices> others;
    for (const TriangleId t : triangles_of(result_.second)) others.insert(in_order(mesh_.triangles[t]));
    const std::vector<TriangleId> triangles = triangles_of(result_.first);
    if (triangles.size() != others.size()) return false;
    for (const TriangleId t : triangles) {
      const TriangleVertices& v = mesh_.triangles[t];
      if (!others.contains(in_order({all.at(v[0]), all.at(v[2]), all.at(v[1])}))) return false;
    }
    partner_ = std::move(all);
    return true;
  }

  /// Replaces the triangles of the second side by the reversed triangles of the first.
  void copy_inside(const RunContext& context) {
    context.info("periodic side \"" + names_.second + "\" gets the triangles of \"" + names_.first + "\"");
    Column<TriangleId, TriangleVertices> triangles;
    Column<TriangleId, PatchId> patches;
    Column<TriangleId, TriangleId> sources;
    const auto keep_source = [&](TriangleId t) { sources.push_back(sources_.empty() ? t : sources_[t]); };
    for (const TriangleId t : mesh_.triangles.ids()) {
      if (mesh_.triangle_patch[t] == result_.second) continue;
      triangles.push_back(mesh_.triangles[t]);
      patches.push_back(mesh_.triangle_patch[t]);
      keep_source(t);
    }
    for (const TriangleId t : triangles_of(result_.first)) {
      TriangleVertices v = mesh_.triangles[t];
      for (VertexId& corner : v) {
        const auto [at, is_new] = partner_.try_emplace(corner);
        if (is_new) at->second = mesh_.points.push_back(mesh_.points[corner] + result_.translation);
        corner = at->second;
      }
      triangles.push_back({v[0], v[2], v[1]});
      patches.push_back(result_.second);
      keep_source(t);
    }
    sources_ = std::move(sources);
    mesh_.triangles = std::move(triangles);
    mesh_.triangle_patch = std::move(patches);
  }

  TriMesh& mesh_;
  const PeriodicNames& names_;
  Column<TriangleId, TriangleId>& sources_;  ///< sources of the triangles of the boundary, as in JoinedSides
  double tolerance_;
  ErrorInfo error_;
  PeriodicPatches result_;
  std::map<VertexId, VertexId> partner_;
};

void require_one_pair_each(std::span<const PeriodicNames> names) {
  std::set<std::string> seen;
  for (const PeriodicNames& pair : names)
    for (const std::string& name : {pair.first, pair.second})
      if (pair.first != pair.second && !seen.insert(name).second)
        throw Error({.code = ErrorCode::bad_argument,
                     .attempted = "making sides periodic",
                     .problem = "patch \"" + name + "\" is in two pairs",
                     .hint = "give each side one partner"});
}

}  // namespace

JoinedSides join_periodic_sides(TriMesh& boundary, std::span<const PeriodicNames> names, const RunContext& context) {
  require_one_pair_each(names);
  JoinedSides joined;
  for (const PeriodicNames& pair : names) joined.pairs.push_back(Joiner(boundary, pair, joined.sources).join(context));
  return joined;
}

std::vector<PeriodicPatches> move_onto_images(TriMesh& boundary, std::span<const PeriodicNames> names, const RunContext& context) {
  if (names.empty()) return {};
  TriMesh joined = boundary;
  // Nothing is logged here, because the sides are logged when they are finally joined.
  std::vector<PeriodicPatches> pairs = join_periodic_sides(joined, names, RunContext({.threads = context.threads()})).pairs;
  for (PeriodicPatches& pair : pairs)
    std::erase_if(pair.vertices, [&](const std::array<VertexId, 2>& vertices) { return vertices[1].index() >= boundary.n_vertices(); });
  std::copy_n(joined.points.begin(), boundary.n_vertices(), boundary.points.begin());
  return pairs;
}

}  // namespace sterna::volmesh
