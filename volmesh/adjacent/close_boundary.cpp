// Steps: tops replace the vertices of the open boundary; chains between adjacent patches are divided again beyond the layer (`cut_chain`); each adjacent patch
// is triangulated within its loops. Loops consist of borders to other patches, chains, and the edges of the open boundary between tops. On periodic sides, the
// second side gets the translated chains and triangles of the first.
#include "volmesh/adjacent/close_boundary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "geom/base/error.h"
#include "geom/mesh/bvh.h"
#include "geom/mesh/topology.h"
#include "volmesh/adjacent/adjacent_surface.h"
#include "volmesh/adjacent/copy_translated.h"

namespace sterna::volmesh {
namespace {

constexpr double k_least_chain = 1e-6;  ///< fraction of a chain's length that the layers must leave free

using Edge = std::array<VertexId, 2>;  ///< edge between two vertices of the result

/// Positions along a polygon, measured by arc length.
class Polyline {
 public:
  explicit Polyline(std::vector<Point> points) : points_(std::move(points)), at_(points_.size(), 0.0) {
    for (std::size_t i = 1; i < points_.size(); ++i) at_[i] = at_[i - 1] + distance(points_[i - 1], points_[i]);
  }
  double length() const { return at_.back(); }
  Point point(double s) const {
    const std::size_t i = segment(s);
    const double share = (s - at_[i]) / (at_[i + 1] - at_[i]);
    return points_[i] + share * (points_[i + 1] - points_[i]);
  }
  double edge(double s) const {
    const std::size_t i = segment(s);
    return at_[i + 1] - at_[i];
  }
  double first_edge() const { return at_[1]; }
  double last_edge() const { return at_.back() - at_[at_.size() - 2]; }

 private:
  std::size_t segment(double s) const {
    const auto next = std::upper_bound(at_.begin(), at_.end(), s);
    return std::clamp<std::size_t>(static_cast<std::size_t>(next - at_.begin()), 1, at_.size() - 1) - 1;
  }
  std::vector<Point> points_;
  std::vector<double> at_;
};

/// Returns positions between s0 and s1 (excluded), such that edges have lengths of about size(s).
template <class Size>
std::vector<double> spaced(double s0, double s1, const Size& size) {
  constexpr int k_samples_per_edge = 8;
  std::vector<double> at = {s0}, count = {0.0};
  while (at.back() < s1) {
    const double here = size(at.back());
    const double step = std::min(here / k_samples_per_edge, s1 - at.back());
    const double next = s1 - at.back() <= step * (1.0 + 1e-9) ? s1 : at.back() + step;
    count.push_back(count.back() + 0.5 * (next - at.back()) * (1.0 / here + 1.0 / size(next)));
    at.push_back(next);
  }
  const int n = std::max(1, static_cast<int>(std::lround(count.back())));
  std::vector<double> locations;
  std::size_t k = 1;
  for (int i = 1; i < n; ++i) {
    const double target = count.back() * i / n;
    while (count[k] < target) ++k;
    const double share = (target - count[k - 1]) / (count[k] - count[k - 1]);
    locations.push_back(at[k - 1] + share * (at[k] - at[k - 1]));
  }
  return locations;
}

class Closer {
 public:
  Closer(const Domain& domain, const LayerBase& base, const EnvelopeShape& envelope, const CloseBoundaryOptions& options, const RunContext& context)
      : domain_(domain), base_(base), envelope_(envelope), options_(options), context_(context), topology_(domain.outer, context) {}

  ClosedOuter close() {
    result_.mesh.patches = domain_.outer.patches;
    new_of_.resize(domain_.outer.n_vertices());
    top_of_.resize(base_.wall.n_vertices());
    find_multi_normal_edges();
    for (const TriangleId t : domain_.outer.triangles.ids()) {
      if (is_end(domain_.outer.triangle_patch[t]) || is_wall_disc(domain_.outer.triangle_patch[t])) continue;
      TriangleVertices v = domain_.outer.triangles[t];
      for (VertexId& corner : v) corner = vertex(corner);
      result_.mesh.triangles.push_back(v);
      result_.mesh.triangle_patch.push_back(domain_.outer.triangle_patch[t]);
    }
    for (const EndChain& chain : domain_.chains)
      if (!image_of(chain)) cut_chain(chain);
    for (const EndChain& chain : domain_.chains)
      if (const std::optional<ChainImage> image = image_of(chain)) copy_chain(chain, *image);
    for (const AdjacentPatch& end : domain_.adjacent)
      if (!second_side(end.patch)) triangulate(end);
    for (const AdjacentPatch& end : domain_.adjacent)
      if (const PeriodicPair* sides = second_side(end.patch)) copy_side(end, *sides);
    return std::move(result_);
  }

 private:
  /// A chain that is the translated image of another chain. The polygons may have opposite directions.
  struct ChainImage {
    const EndChain* chain;
    Vec3 translation;
  };

  const PeriodicPair* second_side(PatchId patch) const {
    const auto found = std::ranges::find(domain_.periodic, patch, &PeriodicPair::second);
    return found == domain_.periodic.end() ? nullptr : &*found;
  }

  /// Follows periodic pairs from the second to the first side, as long as the chain is on a second side.
  std::optional<ChainImage> image_of(const EndChain& chain) const {
    std::vector<VertexId> at = chain.outer;
    Vec3 way;
    bool is_image = false;
    for (const PeriodicPair& sides : domain_.periodic) {
      std::vector<VertexId> origin;
      for (const VertexId v : at) {
        const auto found = std::ranges::find(sides.vertices, v, [](const auto& pair) { return pair[1]; });
        if (found == sides.vertices.end()) break;
        origin.push_back((*found)[0]);
      }
      if (origin.size() != at.size()) continue;
      at = std::move(origin);
      way += sides.translation;
      is_image = true;
    }
    if (!is_image) return std::nullopt;
    const std::vector<VertexId> backwards(at.rbegin(), at.rend());
    for (const EndChain& other : domain_.chains)
      if (other.outer == at || other.outer == backwards) return ChainImage{&other, way};
    throw Error({.code = ErrorCode::internal,
                 .attempted = "ending the layer on periodic sides",
                 .problem = "a common edge of patches on one side has no partner on the other",
                 .locations = {{domain_.outer.points[chain.outer.front()], "the edge starts here"}}});
  }

  bool is_end(PatchId patch) const {
    return std::ranges::any_of(domain_.adjacent, [&](const AdjacentPatch& end) { return end.patch == patch; });
  }

  double max_edge(PatchId patch) const {
    const auto found = std::ranges::find(domain_.adjacent, patch, &AdjacentPatch::patch);
    return found == domain_.adjacent.end() ? k_automatic : found->max_edge;
  }

  bool is_wall_disc(PatchId patch) const { return std::ranges::find(domain_.wall_discs, patch, &WallDisc::patch) != domain_.wall_discs.end(); }

  VertexId add(const Point& p, VertexId line) {
    result_.line.push_back(line);
    return result_.mesh.points.push_back(p);
  }
  VertexId vertex(VertexId outer) {
    if (const VertexId line = domain_.links.line[outer]; line.is_valid()) return vertex_on(line);
    VertexId& v = new_of_[outer];
    return v.is_valid() ? v : v = add(domain_.outer.points[outer], {});
  }
  /// Returns the top of a growth line as a vertex of the result.
  VertexId vertex_on(VertexId line) {
    VertexId& v = top_of_[line];
    return v.is_valid() ? v : v = add(top(line), line);
  }

  /// Finds multi-normal fans of opened ridges in adjacent patches. There one vertex of the patch border has several growth lines.
  void find_multi_normal_edges() {
    for (const LayerBorderEdge& edge : domain_.border) {
      const VertexId a = base_.topology.from(edge.halfedge), b = base_.topology.to(edge.halfedge);
      if (base_.share_base_vertex(a, b)) multi_normal_edges_.push_back({{b, a}, edge.patch});
      else if (base_.multi_normal_of(a) || base_.multi_normal_of(b))
        lines_of_.emplace(key(base_.ridges->base_vertex[b], base_.ridges->base_vertex[a]), Edge{b, a});
    }
  }
  /// Returns the edge of the result for an edge of the outer boundary. Its ends may be growth lines of the layer or other vertices.
  Edge edge_between(VertexId a, VertexId b) {
    const VertexId from = domain_.links.line[a], to = domain_.links.line[b];
    if (from.is_valid() && to.is_valid())
      if (const auto found = lines_of_.find(key(from, to)); found != lines_of_.end()) return {vertex_on(found->second[0]), vertex_on(found->second[1])};
    return {vertex(a), vertex(b)};
  }
  Point top(VertexId line) const { return envelope_.is_collapsed(line) ? base_.wall.points[line] : envelope_.point(base_.wall, line); }

  static std::uint64_t key(VertexId from, VertexId to) { return (static_cast<std::uint64_t>(from.value()) << 32) | to.value(); }

  /// Replaces the edges of a chain by new edges beyond the tops at its ends.
  void cut_chain(const EndChain& chain) {
    std::vector<Point> points;
    for (const VertexId v : chain.outer) points.push_back(domain_.outer.points[v]);
    const Polyline line(std::move(points));
    const VertexId first = domain_.links.line[chain.outer.front()];
    const VertexId last = chain.ends_on_wall ? domain_.links.line[chain.outer.back()] : VertexId{};
    const double s0 = height(first), s1 = line.length() - (last.is_valid() ? height(last) : 0.0);
    if (!(s1 - s0 > k_least_chain * line.length())) {
      throw Error(
          {.code = ErrorCode::envelope_failed,
           .attempted = "ending the layer on patches without layers",
           .problem = "the layer covers the whole common edge of patches \"" + name(chain.left) + "\" and \"" + name(chain.right) + "\"",
           .locations = {{domain_.outer.points[chain.outer.front()], "the edge starts here"}, {domain_.outer.points[chain.outer.back()], "the edge ends here"}},
           .hint = "make the layer thinner (max_thickness) or the patches larger"});
    }
    const double from_start = std::min(base_.mean_edge[first], line.first_edge());
    const double from_end = last.is_valid() ? std::min(base_.mean_edge[last], line.last_edge()) : line.last_edge();
    const double slope = options_.ends.size_growth - 1.0;
    const auto size = [&](double s) {
      double h = std::min({line.edge(s), from_start + slope * std::abs(s - s0), from_end + slope * std::abs(s1 - s)});
      for (const PatchId side : {chain.left, chain.right})
        if (!is_automatic(max_edge(side))) h = std::min(h, max_edge(side));
      if (options_.size) h = std::min(h, options_.size(line.point(s)));
      return h;
    };
    std::vector<VertexId> polygon = {vertex(chain.outer.front())};
    for (const double s : spaced(s0, s1, size)) polygon.push_back(add(line.point(s), {}));
    polygon.push_back(vertex(chain.outer.back()));
    replace(chain, polygon);
    polygons_.emplace(&chain, std::move(polygon));
  }

  void copy_chain(const EndChain& chain, const ChainImage& image) {
    std::vector<VertexId> origin = polygons_.at(image.chain);
    if (image.chain->outer.size() > 1 && !is_along(chain, image)) std::ranges::reverse(origin);
    std::vector<VertexId> polygon = {vertex(chain.outer.front())};
    for (std::size_t i = 1; i + 1 < origin.size(); ++i) polygon.push_back(add(result_.mesh.points[origin[i]] + image.translation, {}));
    polygon.push_back(vertex(chain.outer.back()));
    replace(chain, polygon);
  }
  bool is_along(const EndChain& chain, const ChainImage& image) const {
    const Point start = domain_.outer.points[chain.outer.front()] - image.translation;
    return distance(start, domain_.outer.points[image.chain->outer.front()]) <= distance(start, domain_.outer.points[image.chain->outer.back()]);
  }

  /// Replaces the edges of a chain by the edges of a polygon.
  void replace(const EndChain& chain, const std::vector<VertexId>& polygon) {
    for (std::size_t i = 1; i < chain.outer.size(); ++i) {
      replaced_.emplace(key(chain.outer[i - 1], chain.outer[i]), std::vector<Edge>{});
      replaced_.emplace(key(chain.outer[i], chain.outer[i - 1]), std::vector<Edge>{});
    }
    std::vector<Edge>&forward = replaced_[key(chain.outer[0], chain.outer[1])], &backward = replaced_[key(chain.outer[1], chain.outer[0])];
    for (std::size_t i = 1; i < polygon.size(); ++i) {
      forward.push_back({polygon[i - 1], polygon[i]});
      backward.push_back({polygon[i], polygon[i - 1]});
    }
  }
  double height(VertexId line) const { return envelope_.is_collapsed(line) ? 0.0 : envelope_.height[line]; }
  const std::string& name(PatchId patch) const { return domain_.outer.patches[patch].name; }

  /// The part of the boundary that an adjacent patch will cover, and the vertices of the result for its points.
  struct Region {
    AdjacentRegion region;
    TriMesh original;
    std::vector<VertexId> vertices;
    bool has_inner = false;  ///< the original patch has vertices inside its border
  };

  std::unique_ptr<Region> region_of(const AdjacentPatch& end) {
    auto made = std::make_unique<Region>();
    std::vector<Edge> edges;
    TriMesh& original = made->original;
    Column<VertexId, VertexId> number(domain_.outer.n_vertices());
    std::vector<std::uint8_t> is_border(domain_.outer.n_vertices(), 0);
    for (const TriangleId t : domain_.outer.triangles.ids()) {
      if (domain_.outer.triangle_patch[t] != end.patch) continue;
      TriangleVertices own = domain_.outer.triangles[t];
      for (VertexId& v : own) {
        if (!number[v].is_valid()) number[v] = original.points.push_back(domain_.outer.points[v]);
        v = number[v];
      }
      original.triangles.push_back(own);
      for (int k = 0; k < 3; ++k) {
        const HalfedgeId h = halfedge(t, k);
        const HalfedgeId twin = topology_.twin(h);
        if (twin.is_valid() && domain_.outer.triangle_patch[triangle_of(twin)] == end.patch) continue;
        const VertexId a = topology_.from(h), b = topology_.to(h);
        is_border[a.index()] = is_border[b.index()] = 1;
        if (const auto found = replaced_.find(key(a, b)); found != replaced_.end()) edges.insert(edges.end(), found->second.begin(), found->second.end());
        else edges.push_back(edge_between(a, b));
      }
    }
    for (const auto& [lines, patch] : multi_normal_edges_)
      if (patch == end.patch) edges.push_back({vertex_on(lines[0]), vertex_on(lines[1])});
    for (const VertexId v : number.ids()) made->has_inner = made->has_inner || (number[v].is_valid() && !is_border[v.index()]);
    AdjacentRegion& region = made->region;
    region.surface = domain_.constraints.surfaces[static_cast<std::size_t>(end.surface)].get();
    region.original = &original;
    region.name = name(end.patch);
    Column<VertexId, std::uint32_t> local(result_.mesh.n_vertices(), k_none);
    const auto local_of = [&](VertexId v) {
      std::uint32_t& i = local[v];
      if (i == k_none) {
        i = static_cast<std::uint32_t>(made->vertices.size());
        made->vertices.push_back(v);
        region.points.push_back(result_.mesh.points[v]);
      }
      return i;
    };
    for (const Edge& edge : edges) {
      const std::uint32_t from = local_of(edge[0]), to = local_of(edge[1]);
      region.edges.push_back({from, to});
    }
    return made;
  }

  void add_triangles(const AdjacentTriangles& made, std::vector<VertexId> vertices, PatchId patch) {
    for (const Point& p : made.new_points) vertices.push_back(add(p, {}));
    for (const auto& t : made.triangles) {
      result_.mesh.triangles.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
      result_.mesh.triangle_patch.push_back(patch);
    }
  }

  void triangulate(const AdjacentPatch& end) {
    std::unique_ptr<Region> made = region_of(end);
    const TriMesh& original = made->original;
    std::optional<TriangleTree> tree;
    if (made->has_inner) tree.emplace(original, context_);
    std::function<double(const Point&)> size = options_.size;
    if (tree)
      size = [&](const Point& p) {
        const auto [a, b, c] = corners(original, tree->nearest(p).triangle);
        return std::min(options_.size ? options_.size(p) : 1e300, std::max({distance(a, b), distance(b, c), distance(c, a)}));
      };
    made->region.size = limited_size(made->region, end.max_edge, options_.ends.size_growth, std::move(size));
    const AdjacentTriangles triangles = triangulate_adjacent(made->region, options_.ends, context_);
    add_triangles(triangles, made->vertices, end.patch);
    if (std::ranges::find(domain_.periodic, end.patch, &PeriodicPair::first) != domain_.periodic.end())
      firsts_.emplace(end.patch, First{std::move(made), triangles});
  }

  void copy_side(const AdjacentPatch& end, const PeriodicPair& sides) {
    const First& first = firsts_.at(sides.first);
    const std::unique_ptr<Region> to = region_of(end);
    add_triangles(copy_translated(first.made->region, first.triangles, to->region, sides.translation, base_.body_length), to->vertices, end.patch);
  }

  const Domain& domain_;
  const LayerBase& base_;
  const EnvelopeShape& envelope_;
  const CloseBoundaryOptions& options_;
  const RunContext& context_;
  Topology topology_;                           ///< topology of domain_.outer
  Column<VertexId, VertexId> new_of_, top_of_;  ///< vertices of the result: by vertex of domain_.outer without a growth line, and by growth line
  /// Growth lines of an edge between ridge base vertices at which there is a multi-normal fan, in the direction of the adjacent patch.
  std::map<std::uint64_t, Edge> lines_of_;
  std::vector<std::pair<Edge, PatchId>>
      multi_normal_edges_;  ///< edges between growth lines with a common ridge base vertex, in the direction of the adjacent patch
  /// Edges that replace a chain, stored at the first edge of the chain; other edges of the chain have empty lists.
  std::map<std::uint64_t, std::vector<Edge>> replaced_;
  std::map<const EndChain*, std::vector<VertexId>> polygons_;  ///< polygon that replaces each chain
  struct First {
    std::unique_ptr<Region> made;
    AdjacentTriangles triangles;
  };
  std::map<PatchId, First> firsts_;  ///< first sides of periodic pairs
  ClosedOuter result_;
};

}  // namespace

ClosedOuter unlinked(TriMesh outer) {
  ClosedOuter closed{std::move(outer), {}};
  closed.line.resize(closed.mesh.n_vertices());
  return closed;
}

ClosedOuter close_boundary(const Domain& domain, const LayerBase& base, const EnvelopeShape& envelope, const CloseBoundaryOptions& options,
                           const RunContext& context) {
  if (domain.border.empty() && domain.wall_discs.empty()) return unlinked(domain.outer);
  return Closer(domain, base, envelope, options, context).close();
}

}  // namespace sterna::volmesh
