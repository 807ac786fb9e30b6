#include "geom/mesh/wall_sections.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "geom/base/disjoint_sets.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/mesh/body_patches.h"

namespace sterna {
namespace {

/// Returns the rank of a boundary face, best first: walls under layers, walls, walls around bodies, boundaries near the body, any.
int rank_of(PatchKind kind, bool is_layer_base, bool is_outer) {
  if (kind == PatchKind::wall) return is_outer ? 2 : is_layer_base ? 0 : 1;
  return kind == PatchKind::farfield || kind == PatchKind::inflow || kind == PatchKind::outflow ? 4 : 3;
}

/// Returns true if the patches of all boundary faces are known.
bool has_patches(const HybridMesh& mesh) {
  const auto is_known = [&](const auto& face) { return face.patch.index() < mesh.patches.size(); };
  return std::ranges::all_of(mesh.boundary_triangles, is_known) && std::ranges::all_of(mesh.boundary_quads, is_known);
}

}  // namespace

WallSections::WallSections(Borrowed<const HybridMesh> mesh, const RunContext& context) : mesh_(mesh) {
  choose_triangles(mesh);
  edges_.reserve(3 * triangles_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const auto& nodes = triangles_[t].nodes;
    for (std::size_t k = 0; k < 3; ++k) {
      box_.add(point(nodes[k]));
      edges_.push_back({std::min(nodes[k], nodes[(k + 1) % 3]), std::max(nodes[k], nodes[(k + 1) % 3]), t});
    }
  }
  parallel_sort(context, edges_, std::less<>{});
}

void WallSections::choose_triangles(const HybridMesh& mesh) {
  std::vector<std::uint8_t> is_base_vertex(mesh.points.size(), 0);
  for (std::size_t line = 0; line < mesh.layers.n_lines(); ++line)
    if (!mesh.layers.is_collapsed[line]) is_base_vertex[mesh.layers.first_node[line]] = 1;
  const std::vector<std::uint8_t> is_outer = has_patches(mesh) ? outer_walls(mesh) : std::vector<std::uint8_t>(mesh.patches.size(), 0);
  const auto rank = [&](const auto& face) {
    const bool is_base = std::all_of(face.nodes.begin(), face.nodes.end(), [&](NodeId node) { return is_base_vertex[node.index()] != 0; });
    if (face.patch.index() >= mesh.patches.size()) return rank_of(PatchKind::farfield, is_base, false);
    return rank_of(mesh.patches[face.patch].kind, is_base, is_outer[face.patch.index()] != 0);
  };
  int best = std::numeric_limits<int>::max();
  for (const BoundaryTriangle& face : mesh.boundary_triangles) best = std::min(best, rank(face));
  for (const BoundaryQuad& face : mesh.boundary_quads) best = std::min(best, rank(face));
  for (const BoundaryTriangle& face : mesh.boundary_triangles)
    if (rank(face) == best) triangles_.push_back({{face.nodes[0].value(), face.nodes[2].value(), face.nodes[1].value()}, face.patch});
  for (const BoundaryQuad& face : mesh.boundary_quads) {
    if (rank(face) != best) continue;
    triangles_.push_back({{face.nodes[0].value(), face.nodes[2].value(), face.nodes[1].value()}, face.patch});
    triangles_.push_back({{face.nodes[0].value(), face.nodes[3].value(), face.nodes[2].value()}, face.patch});
  }
}

std::vector<SectionPiece> WallSections::section(const Point& origin, const Vec3& normal) const {
  struct Segment {
    std::array<Point, 2> ends;
    std::array<std::uint64_t, 2> keys;
  };
  std::vector<Segment> segments;
  for (const WallTriangle& triangle : triangles_) {
    std::array<double, 3> height;
    for (std::size_t k = 0; k < 3; ++k) height[k] = dot(point(triangle.nodes[k]) - origin, normal);
    Segment segment;
    std::size_t n = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if ((height[k] >= 0.0) == (height[next] >= 0.0) || n == 2) continue;
      const Point &a = point(triangle.nodes[k]), &b = point(triangle.nodes[next]);
      segment.ends[n] = a + (height[k] / (height[k] - height[next])) * (b - a);
      segment.keys[n++] = (std::uint64_t{std::min(triangle.nodes[k], triangle.nodes[next])} << 32) | std::max(triangle.nodes[k], triangle.nodes[next]);
    }
    if (n == 2) segments.push_back(segment);
  }
  DisjointSets sets(segments.size());
  std::unordered_map<std::uint64_t, std::size_t> seen;
  for (std::size_t i = 0; i < segments.size(); ++i)
    for (const std::uint64_t key : segments[i].keys)
      if (const auto [found, is_new] = seen.emplace(key, i); !is_new) sets.join(static_cast<std::uint32_t>(found->second), static_cast<std::uint32_t>(i));
  std::vector<SectionPiece> pieces;
  std::vector<std::size_t> piece_of(segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::size_t root = sets.root(static_cast<std::uint32_t>(i));
    if (root == i) {
      piece_of[i] = pieces.size();
      pieces.emplace_back();
    }
    SectionPiece& piece = pieces[piece_of[root]];
    piece.segments.push_back(segments[i].ends);
    for (const Point& p : segments[i].ends) piece.box.add(p);
  }
  return pieces;
}

std::uint32_t WallSections::extreme_node(const Vec3& direction) const {
  std::uint32_t best = triangles_.front().nodes[0];
  for (const WallTriangle& triangle : triangles_)
    for (const std::uint32_t node : triangle.nodes) {
      const double lead = dot(point(node), direction) - dot(point(best), direction);
      if (lead > 0.0 || (lead == 0.0 && node < best)) best = node;
    }
  return best;
}

Point WallSections::nearest_to(const Point& origin, const Vec3& normal) const {
  Point best;
  double least = std::numeric_limits<double>::infinity();
  for (const WallTriangle& triangle : triangles_) {
    const Point middle = (point(triangle.nodes[0]) + point(triangle.nodes[1]) + point(triangle.nodes[2])) / 3.0;
    const double away = std::abs(dot(middle - origin, normal));
    if (away >= least) continue;
    least = away;
    best = middle;
  }
  return best;
}

EdgeChain WallSections::longest_chain(double least, bool is_concave, bool between_patches) const {
  std::vector<std::array<std::uint32_t, 2>> sharp;
  for (std::size_t i = 0; i + 1 < edges_.size(); ++i) {
    const Edge &a = edges_[i], &b = edges_[i + 1];
    const auto has = [&](std::size_t e) { return e < edges_.size() && edges_[e].lower == a.lower && edges_[e].upper == a.upper; };
    if (!has(i + 1) || has(i + 2) || (i > 0 && has(i - 1))) continue;
    const WallTriangle &s = triangles_[a.triangle], &t = triangles_[b.triangle];
    if (between_patches && s.patch == t.patch) continue;
    const auto normal = [&](const WallTriangle& w) { return area_vector(point(w.nodes[0]), point(w.nodes[1]), point(w.nodes[2])); };
    if (!(angle_between(normal(s), normal(t)) > least)) continue;
    std::uint32_t apex = t.nodes[0];
    for (const std::uint32_t node : t.nodes)
      if (node != a.lower && node != a.upper) apex = node;
    if ((dot(normal(s), point(apex) - point(a.lower)) > 0.0) == is_concave) sharp.push_back({a.lower, a.upper});
  }
  const auto n_sharp = static_cast<std::uint32_t>(sharp.size());
  DisjointSets sets(n_sharp);
  std::unordered_map<std::uint32_t, std::uint32_t> seen;
  for (std::uint32_t i = 0; i < n_sharp; ++i)
    for (const std::uint32_t node : sharp[i])
      if (const auto [found, is_new] = seen.emplace(node, i); !is_new) sets.join(found->second, i);
  std::vector<double> lengths(n_sharp, 0.0);
  for (std::uint32_t i = 0; i < n_sharp; ++i) lengths[sets.root(i)] += distance(point(sharp[i][0]), point(sharp[i][1]));
  EdgeChain chain;
  if (sharp.empty()) return chain;
  const auto longest = static_cast<std::uint32_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
  chain.length = lengths[longest];
  for (std::uint32_t i = 0; i < n_sharp; ++i)
    if (sets.root(i) == longest) chain.edges.push_back(sharp[i]);
  return chain;
}

double WallSections::edge_near(const Point& p) const {
  std::uint32_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const WallTriangle& triangle : triangles_)
    for (const std::uint32_t node : triangle.nodes)
      if (const double away = norm2(point(node) - p); away < least || (away == least && node < nearest)) {
        least = away;
        nearest = node;
      }
  double sum = 0.0;
  std::size_t n = 0;
  for (const Edge& edge : edges_) {
    if (edge.lower != nearest && edge.upper != nearest) continue;
    sum += distance(point(edge.lower), point(edge.upper));
    ++n;
  }
  return n > 0 ? sum / static_cast<double>(n) : 0.0;
}

double WallSections::layer_near(const Point& p) const {
  const LayerBlock& layers = mesh_.layers;
  double height = 0.0, least = std::numeric_limits<double>::infinity();
  for (std::size_t line = 0; line < layers.n_lines(); ++line) {
    const Point& base_point = point(layers.first_node[line]);
    const double away = norm2(base_point - p);
    if (away >= least) continue;
    least = away;
    height = distance(base_point, mesh_.points[layers.top(static_cast<std::uint32_t>(line))]);
  }
  return height;
}

}  // namespace sterna
