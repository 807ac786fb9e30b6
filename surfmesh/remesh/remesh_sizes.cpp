#include "surfmesh/remesh/remesh_sizes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

#include "geom/base/glob.h"
#include "geom/base/parallel.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/mesh/bvh.h"

namespace sterna::surfmesh {
namespace {

/// Longest edge of a connected piece, relative to the square root of its area. This is 15 % of the chord of a slender wing, or 2 % of an aircraft's length.
constexpr double k_max_edge_of_area = 0.05;
/// Lower limit of the longest edge, relative to the length of the piece. It is needed because pieces as thin as a line have no area.
constexpr double k_max_edge_of_length = 1e-3;
constexpr double k_min_edge_of_max = 0.02;
/// Lower limit of sizes where chord_error requires shorter edges, relative to min_edge.
constexpr double k_least_for_chord = 0.25;
/// Two surfaces face each other if their normals are opposite within 30 degrees.
constexpr double k_opposed_cosine = 0.866;
/// Hits nearer than this fraction of the reach are on the same surface and are ignored.
constexpr double k_ray_start = 1e-9;

double or_else(double value, double other) { return is_automatic(value) ? other : value; }

std::vector<double> automatic_edges(const TriMesh& wall, const Components& pieces) {
  std::vector<double> areas(pieces.count, 0.0);
  std::vector<Box> boxes(pieces.count);
  for (const TriangleId t : wall.triangles.ids()) {
    const auto p = corners(wall, t);
    areas[pieces.component[t]] += triangle_area(p[0], p[1], p[2]);
    for (const Point& corner : p) boxes[pieces.component[t]].add(corner);
  }
  std::vector<double> edges(pieces.count);
  for (std::size_t i = 0; i < edges.size(); ++i) edges[i] = std::max(k_max_edge_of_area * std::sqrt(areas[i]), k_max_edge_of_length * boxes[i].longest_side());
  return edges;
}

void require_rules(const TriMesh& wall, std::span<const Rule> rules) {
  constexpr std::string_view k_attempted = "remeshing a surface";
  std::vector<std::string> names;
  for (const Patch& patch : wall.patches) names.push_back(patch.name);
  for (const Rule& rule : rules) {
    if (std::none_of(names.begin(), names.end(), [&](const std::string& name) { return matches_glob(name, rule.names); }))
      throw_bad_argument(k_attempted, "no patch has a name like \"" + rule.names + "\"", {}, names_hint(names, rule.names));
    for (const char* option : {"trailing_edge_cells", "leading_edge_factor", "trailing_edge_factor"})
      if (is_set(rule, option))
        throw_bad_argument(
            k_attempted,
            "the rule for \"" + rule.names + "\" sets trailing_edge_cells or factors at leading or trailing edges, which do not apply to a triangulation", {},
            "give max_edge, min_edge, curvature_angle, chord_error, or rows: trailing_edge_chordwise, leading_edge_chordwise");
  }
}

SurfaceLimits limits_of(const std::string& name, double automatic_edge, const RemeshOptions& options, std::span<const Rule> rules) {
  const RemeshOptions own = resolve(options, rules, name);
  SurfaceLimits l{or_else(own.sizes.max_edge, automatic_edge), own.sizes.min_edge, own.sizes.curvature_angle, own.sizes.chord_error};
  l.min_edge = std::min(or_else(l.min_edge, k_min_edge_of_max * l.max_edge), l.max_edge);
  for (double* length : {&l.max_edge, &l.min_edge, &l.curvature_angle, &l.chord_error}) *length /= options.sizes.refinement;
  return l;
}

double size_of_curvature(double curvature, const SurfaceLimits& l) {
  if (!(curvature > 0.0)) return l.max_edge;
  double size = std::max(2.0 / curvature * std::sin(0.5 * l.curvature_angle), l.min_edge);
  if (!is_automatic(l.chord_error)) size = std::min(size, std::max(std::sqrt(8.0 * l.chord_error / curvature), k_least_for_chord * l.min_edge));
  return std::min(size, l.max_edge);
}

/// Returns the curvature (1/m) of the arc over an edge: the smaller of those that the normals at its ends give; zero if they differ in sign.
double edge_curvature(const Reference& r, HalfedgeId h) {
  const Point &a = r.mesh->points[r.topology.from(h)], &b = r.mesh->points[r.topology.to(h)];
  const double length = distance(a, b);
  if (!(length > 0.0)) return 0.0;
  const Vec3 e = (b - a) / length;
  const double rise_a = -dot(r.normals[h], e), rise_b = dot(r.normals[next(h)], e);
  return rise_a * rise_b > 0.0 ? 2.0 * std::min(std::abs(rise_a), std::abs(rise_b)) / length : 0.0;
}

/// Returns the curvature (1/m) that follows from the bend at an edge, over the widths of the adjacent triangles. Triangles narrower than min_edge give no
/// curvature.
double bend_curvature(const Reference& r, HalfedgeId h, double min_edge) {
  const HalfedgeId o = r.topology.twin(h);
  double height = 0.0;
  for (const HalfedgeId e : {h, o}) {
    const Point &a = r.mesh->points[r.topology.from(e)], &b = r.mesh->points[r.topology.to(e)], &c = r.mesh->points[r.topology.from(previous(e))];
    const double length = distance(a, b);
    if (length > 0.0) height += triangle_area(a, b, c) / length;
  }
  return angle_between(r.triangle_normals[triangle_of(h)], r.triangle_normals[triangle_of(o)]) / std::max(height, min_edge);
}

void check_options(const RemeshOptions& o) {
  for (const double length : {o.sizes.max_edge, o.sizes.curvature_angle, o.sizes.chord_error, o.sizes.refinement, o.sizes.narrow})
    if (!is_automatic(length) && !(length > 0.0)) throw_bad_argument("remeshing a surface", "sizes, angles and factors must be positive");
  if (!(o.sizes.growth > 1.0)) throw_bad_argument("remeshing a surface", "growth must be above 1");
  if (!is_automatic(o.sizes.max_edge) && !is_automatic(o.sizes.min_edge) && o.sizes.min_edge > o.sizes.max_edge)
    throw_bad_argument("remeshing a surface", "min_edge is larger than max_edge");
}

}  // namespace

double least_edge(const TriMesh& wall, const RemeshOptions& options, std::span<const Rule> patches, const RunContext& context) {
  check_options(options);
  require_rules(wall, patches);
  return SurfaceLimitTable(wall, Topology(wall, context), options, patches).least();
}

SurfaceLimitTable::SurfaceLimitTable(Borrowed<const TriMesh> wall, const Topology& topology, const RemeshOptions& options, std::span<const Rule> rules)
    : wall_(wall), pieces_(connected_components(wall, topology)) {
  for (const double edge : automatic_edges(wall, pieces_)) {
    limits_.emplace_back();
    for (const Patch& patch : wall->patches) limits_.back().push_back(limits_of(patch.name, edge, options, rules));
  }
}

double SurfaceLimitTable::least() const {
  double least = k_unbounded;
  for (const auto& piece : limits_)
    for (const SurfaceLimits& l : piece) least = std::min(least, std::max(l.min_edge, 1e-3 * l.max_edge));
  return least;
}

RemeshSizes::RemeshSizes(Borrowed<const Reference> reference, const RemeshOptions& options, std::span<const Rule> patches, const SpaceSizes& requested,
                         const RunContext& context)
    : r_(reference),
      options_(options),
      patches_(patches.begin(), patches.end()),
      requested_(requested),
      refinement_(options.sizes.refinement),
      slope_((options.sizes.growth - 1.0) / options.sizes.refinement),
      cap_(reference->mesh->n_triangles()),
      min_edge_(reference->mesh->n_triangles()),
      own_(reference->mesh->n_triangles()),
      at_(reference->mesh->n_vertices()) {
  cover({}, context);
}

void RemeshSizes::cover(const Column<VertexId, std::uint8_t>& covered, const RunContext& context) {
  const RemeshOptions& options = options_;
  at_.assign(at_.size(), k_unbounded);
  const TriMesh& wall = *r_.mesh;
  const SurfaceLimitTable limits(wall, r_.topology, options, patches_);
  const auto is_covered = [&](VertexId v) { return !covered.empty() && covered[v] != 0; };
  for (const TriangleId t : wall.triangles.ids()) {
    const SurfaceLimits& l = limits.of(t);
    cap_[t] = own_[t] = l.max_edge;
    min_edge_[t] = l.min_edge;
    largest_ = std::max(largest_, l.max_edge);
    for (int k = 0; k < 3; ++k) {
      const HalfedgeId h = halfedge(t, k);
      const VertexId a = r_.topology.from(h), b = r_.topology.to(h);
      double curvature = 0.0;
      if (is_covered(a) && is_covered(b)) {
        curvature = 0.0;
      } else if (r_.line[h] == k_no_line) {
        curvature = std::max(edge_curvature(r_, h), bend_curvature(r_, h, l.min_edge));
      } else if (const double length = distance(wall.points[a], wall.points[b]); length > 0.0) {
        curvature = 8.0 * norm(r_.lines[static_cast<std::size_t>(r_.line[h])].bulges[r_.segment[h]]) / (length * length);
      }
      const double size = size_of_curvature(curvature, l);
      own_[t] = std::min(own_[t], size);
      at_[a] = std::min(at_[a], size);
      at_[b] = std::min(at_[b], size);
    }
  }
  const double across = options.sizes.gap_cells > 0.0 ? 1.0 / (options.sizes.gap_cells * options.sizes.refinement) : 0.0;
  const double through = is_automatic(options.sizes.thickness_factor) ? 0.0 : options.sizes.thickness_factor / options.sizes.refinement;
  if (across > 0.0 || through > 0.0) {
    const TriangleTree tree(wall, context);
    std::vector<double> found(wall.n_triangles(), k_unbounded);
    parallel_for(
        context, wall.n_triangles(),
        [&](std::size_t i) {
          const TriangleId t(i);
          const auto [a, b, c] = corners(wall, t);
          const Vec3& n = r_.triangle_normals[t];
          const Point middle = (a + b + c) / 3.0;
          for (const auto& [share, way] : {std::pair(across, n), std::pair(through, -n)}) {
            if (share == 0.0) continue;
            for (const TriangleTree::RayHit& hit : tree.ray(middle, way)) {
              if (hit.triangle == t || hit.t < k_ray_start * cap_[t]) continue;
              if (hit.t * share >= cap_[t]) break;
              if (dot(r_.triangle_normals[hit.triangle], n) > -k_opposed_cosine) continue;
              found[i] = std::min(found[i], std::max(share * hit.t, min_edge_[t]));
              break;
            }
          }
        },
        256);
    for (const TriangleId t : wall.triangles.ids())
      if (found[t.index()] < cap_[t])
        for (const VertexId v : wall.triangles[t]) at_[v] = std::min(at_[v], found[t.index()]);
  }
  if (!requested_.samples.empty()) {
    const SizePointTree size_points(requested_.samples, (options.sizes.growth - 1.0), context);
    parallel_for(context, at_.size(), [&](std::size_t v) {
      at_[VertexId(v)] = std::min(at_[VertexId(v)], size_points.smallest(wall.points[VertexId(v)], {.cap = largest_ * refinement_}) / refinement_);
    });
  }
  carry();
}

void RemeshSizes::carry() {
  using Entry = std::pair<double, std::uint32_t>;
  const auto for_neighbours = [&](VertexId v, const auto& visit) {
    for (const VertexId w : r_.topology.neighbours(v)) visit(w, at_[v] + slope_ * distance(r_.mesh->points[v], r_.mesh->points[w]));
  };
  std::vector<Entry> first;
  for (const VertexId v : at_.ids()) {
    bool has_gain = false;
    for_neighbours(v, [&](VertexId w, double size) { has_gain = has_gain || size < at_[w]; });
    if (has_gain) first.emplace_back(at_[v], v.value());
  }
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue(std::greater<>{}, std::move(first));
  while (!queue.empty()) {
    const auto [size, v] = queue.top();
    queue.pop();
    if (size != at_[VertexId(v)]) continue;
    for_neighbours(VertexId(v), [&](VertexId w, double there) {
      if (!(there < at_[w])) return;
      at_[w] = there;
      queue.emplace(there, w.value());
    });
  }
}

double RemeshSizes::operator()(const Point& p, TriangleId t) const {
  double size = cap_[t];
  const TriangleVertices& v = r_.mesh->triangles[t];
  for (const VertexId k : v) size = std::min(size, at_[k] + slope_ * distance(p, r_.mesh->points[k]));
  // Sizes may grow between vertices that are far apart, but a curved triangle limits the size all over.
  if (own_[t] < size) {
    const auto [a, b, c] = corners(*r_.mesh, t);
    const Vec3 n = cross(b - a, c - a);
    const double n2 = norm2(n);
    if (n2 > 0.0) {
      const double b1 = std::clamp(dot(cross(p - a, c - a), n) / n2, 0.0, 1.0), b2 = std::clamp(dot(cross(b - a, p - a), n) / n2, 0.0, 1.0 - b1);
      size = std::min(size, std::max(own_[t], (1.0 - b1 - b2) * at_[v[0]] + b1 * at_[v[1]] + b2 * at_[v[2]]));
    }
  }
  if (size_points_) size = size_points_->smallest(p, {.cap = size});
  if (requested_.regions) size = std::min(size, requested_.regions(p, slope_ * refinement_) / refinement_);
  if (requested_.function) size = std::min(size, requested_.function(p) / refinement_);
  return size;
}

void RemeshSizes::lower(TriangleId t, const Point& p, double size) {
  for (const VertexId v : r_.mesh->triangles[t]) at_[v] = std::min(at_[v], size + slope_ * distance(p, r_.mesh->points[v]));
}

void RemeshSizes::request_at(std::span<const SizePoint> size_points, const RunContext& context) {
  size_points_.reset();
  if (!size_points.empty()) size_points_.emplace(size_points, slope_, context);
}

double RemeshSizes::least() const { return *std::min_element(at_.begin(), at_.end()); }

double RemeshSizes::n_expected() const {
  double n = 0.0;
  for (const TriangleId t : r_.mesh->triangles.ids()) {
    const auto [a, b, c] = corners(*r_.mesh, t);
    const double size = (*this)((a + b + c) / 3.0, t);
    n += triangle_area(a, b, c) / (k_equilateral_area * size * size);
  }
  return n;
}

}  // namespace sterna::surfmesh
