// Remesher: locations of vertices, quality of triangles, and the operations that change connectivity.
//
// Based on: M. Botsch, L. Kobbelt, "A remeshing approach to multiresolution modeling" (2004), for the loop of splits, collapses, flips and tangential moves.
// Added here: the order by length, the sizes, the lines, and that each vertex keeps its location on the reference and searches the next one by a walk from
// there.
#include "surfmesh/remesh/remesher.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/math/nearest.h"
#include "geom/mesh/bvh.h"

namespace sterna::surfmesh {
namespace {

/// A triangle turned from the reference's normals by more than the angle with this cosine counts as inverted.
constexpr double k_fold_cosine = 0.3;
/// 4 sqrt(3): with this factor the mean ratio 4 sqrt(3) A / sum l^2 is 1 for an equilateral triangle.
constexpr double k_mean_ratio = 6.928203230275509;
/// A collapse is accepted without comparison to the quality before if its triangles are better than this.
constexpr double k_good_enough = 0.4;
/// Flips that improve the mean ratio by less than this are skipped.
constexpr double k_flip_gain = 1e-6;
/// Two triangles that are better than this are not flipped, because neither would improve.
constexpr double k_flip_below = 0.88;
/// Lower limit for the quality of triangles after a flip that improves the number of neighbours. Smoothing improves such triangles later.
constexpr double k_regular_floor = 0.45;
/// Quality of an inverted triangle, worse than any other.
constexpr double k_folded = -1.0;
/// Relative to the body's length: an open boundary lies in a plane if its coordinates differ by less than this.
constexpr double k_border_flat = 1e-5;
/// Largest number of halving rounds, which gives at most 2^24 parts.
constexpr int k_split_rounds = 24;
/// Range of the length of a half, relative to the edge. Outside of it, the middle of the edge is held at a line or was projected to another location.
constexpr double k_least_half = 0.2, k_most_half = 0.85;
/// Smallest quality after a split, relative to the quality before. Halves of any triangle are better, unless the middle is held at a line.
constexpr double k_least_after_split = 0.1;
/// An edge that a collapse lengthens by less than this factor counts as unchanged.
constexpr double k_no_longer = 1.001;
/// Largest length of an edge after a collapse, relative to the target. Longer edges would only be split again.
constexpr double k_longest_after_collapse = 1.35;

}  // namespace

Remesher::Remesher(Borrowed<const Reference> reference, Borrowed<const RemeshSizes> sizes, const RunContext& context)
    : r_(reference), sizes_(sizes), context_(context), mesh_(work_mesh_of(reference)), locked_(reference->lines.size(), 0) {
  for (std::size_t l = 0; l < locked_.size(); ++l) {
    const HalfedgeId h = r_.lines[l].halfedges.front(), o = r_.topology.twin(h);
    locked_[l] = r_.is_kept[triangle_of(h)] != 0 || (o.is_valid() && r_.is_kept[triangle_of(o)] != 0) ? 1 : 0;
    if (!o.is_valid()) {
      is_border_.resize(locked_.size(), 0);
      is_border_[l] = 1;
    }
  }
  if (!is_border_.empty()) flat_ = k_border_flat * body_length(*r_.mesh);
  for (const VertexId i : mesh_.vertices.ids())
    if (WorkVertex& v = mesh_.vertices[i]; v.kind == VertexKind::face && mesh_.outgoing[i].is_valid()) v.normal = r_.normal(v.location);
  refresh_sizes();
  update_all();
}

void Remesher::update_all() {
  quality_.resize(mesh_.triangles.size());
  parallel_for(context_, quality_.size(), [&](std::size_t t) { update(TriangleId(t)); });
}

void Remesher::renumber() {
  mesh_.renumber();
  update_all();
}

double Remesher::target_length(HalfedgeId h) const {
  const double a = mesh_.vertices[mesh_.from(h)].size, b = mesh_.vertices[mesh_.to(h)].size;
  return 2.0 * a * b / (a + b);
}

double Remesher::length_ratio(HalfedgeId h) const { return distance(mesh_.at(mesh_.from(h)), mesh_.at(mesh_.to(h))) / target_length(h); }

void Remesher::resize(WorkVertex& v, TriangleId t) const { v.size = sizes_(v.point, t); }

void Remesher::refresh_sizes() {
  for (const VertexId i : mesh_.vertices.ids()) {
    if (!mesh_.outgoing[i].is_valid()) continue;
    WorkVertex& v = mesh_.vertices[i];
    if (v.kind == VertexKind::face) resize(v, v.location.triangle);
    else if (v.kind == VertexKind::line) resize(v, triangle_of(r_.lines[static_cast<std::size_t>(v.line)].halfedges[r_.line_location(v.line, v.s).segment]));
    else resize(v, triangle_of(r_.topology.outgoing(v.corner).front()));
  }
}

/// Returns the reference's normal at a vertex of a triangle, in the smooth piece of `hint` and in the direction of the point `towards`. If both sides of a line
/// belong to that piece (a sharp trailing edge whose piece continues around the nose), the direction alone hardly distinguishes them. Then `seen`, a normal
/// elsewhere on the triangle, selects the side; zero: not known.
Vec3 Remesher::normal_at(VertexId number, TriangleId hint, const Point& towards, const Vec3& seen) const {
  const WorkVertex& v = mesh_.vertices[number];
  if (v.kind == VertexKind::face) return v.normal;
  const std::uint32_t region = r_.region[hint];
  const Vec3 way = normalized(towards - v.point);
  if (v.kind == VertexKind::line) {
    const auto [segment, t] = r_.line_location(v.line, v.s);
    const FeatureLine& line = r_.lines[static_cast<std::size_t>(v.line)];
    const auto normal_on = [&](HalfedgeId h) {
      const double share = r_.topology.from(h) == line.vertices[segment] ? t : 1.0 - t;
      return (1.0 - share) * r_.normals[h] + share * r_.normals[next(h)];
    };
    const HalfedgeId h = line.halfedges[segment], o = r_.topology.twin(h);
    if (!o.is_valid() || r_.region[triangle_of(o)] != region) return normal_on(h);
    if (r_.region[triangle_of(h)] != region) return normal_on(o);
    if (norm2(seen) > 0.0) {
      const Vec3 left = normal_on(h), right = normal_on(o);
      return dot(left, seen) >= dot(right, seen) ? left : right;
    }
    const Vec3 along = r_.mesh->points[r_.topology.to(h)] - r_.mesh->points[r_.topology.from(h)];
    const auto inwards = [&](HalfedgeId e, const Vec3& a) { return dot(way, normalized(cross(r_.triangle_normals[triangle_of(e)], a))); };
    return inwards(h, along) >= inwards(o, -along) ? normal_on(h) : normal_on(o);
  }
  HalfedgeId best;
  double largest = -4.0;
  for (const HalfedgeId h : r_.topology.outgoing(v.corner)) {
    if (r_.region[triangle_of(h)] != region) continue;
    const Vec3 along =
        normalized(normalized(r_.mesh->points[r_.topology.to(h)] - v.point) + normalized(r_.mesh->points[r_.topology.from(previous(h))] - v.point));
    // Normals of the opposite side rank below all normals of this side.
    const double cosine = dot(way, along) - (dot(r_.normals[h], seen) < 0.0 ? 2.0 : 0.0);
    if (cosine > largest) {
      largest = cosine;
      best = h;
    }
  }
  return best.is_valid() ? r_.normals[best] : r_.triangle_normals[hint];
}

bool Remesher::is_at_border(VertexId number) const {
  const WorkVertex& v = mesh_.vertices[number];
  if (v.kind == VertexKind::line) return is_border_[static_cast<std::size_t>(v.line)] != 0;
  if (v.kind != VertexKind::corner) return false;
  const auto out = r_.topology.outgoing(v.corner);
  return std::any_of(out.begin(), out.end(), [&](HalfedgeId h) { return !r_.topology.twin(h).is_valid() || !r_.topology.twin(previous(h)).is_valid(); });
}

/// Returns true for triangles in the plane of an open boundary. In a half model such a triangle would be a wall there, coincident with its mirror image.
bool Remesher::lies_in_border(const TriangleVertices& v, const std::array<Point, 3>& p) const {
  if (is_border_.empty()) return false;
  bool is_flat = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
    is_flat = is_flat || high - low <= flat_;
  }
  return is_flat && is_at_border(v[0]) && is_at_border(v[1]) && is_at_border(v[2]);
}

/// Returns the mean ratio. Returns k_folded for a triangle that is inverted against the reference, or that lies in the plane of an open boundary.
double Remesher::quality_of(const TriangleVertices& v, TriangleId hint) const {
  const std::array<Point, 3> p = {mesh_.at(v[0]), mesh_.at(v[1]), mesh_.at(v[2])};
  const Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
  const double area = norm(n);
  const Point middle = (p[0] + p[1] + p[2]) / 3.0;
  if (lies_in_border(v, p)) return k_folded;
  Vec3 seen;
  for (const VertexId k : v)
    if (mesh_.vertices[k].kind == VertexKind::face) seen = mesh_.vertices[k].normal;
  for (const VertexId k : v)
    if (!(dot(n, normal_at(k, hint, middle, seen)) > k_fold_cosine * area)) return k_folded;
  return 0.5 * k_mean_ratio * area / (norm2(p[1] - p[0]) + norm2(p[2] - p[1]) + norm2(p[0] - p[2]));
}

double Remesher::quality_now(TriangleId t) const { return quality_of(mesh_.triangles[t], mesh_.hint[t]); }

double Remesher::turned_share(double angle) const {
  const double cosine = std::cos(angle);
  double turned = 0.0, all = 0.0;
  for (const TriangleId t : mesh_.triangles.ids()) {
    if (mesh_.is_removed(t)) continue;
    const auto& v = mesh_.triangles[t];
    const Vec3 n = cross(mesh_.at(v[1]) - mesh_.at(v[0]), mesh_.at(v[2]) - mesh_.at(v[0]));
    const Point middle = (mesh_.at(v[0]) + mesh_.at(v[1]) + mesh_.at(v[2])) / 3.0;
    const double area = norm(n);
    all += area;
    Vec3 seen;
    for (const VertexId k : v)
      if (mesh_.vertices[k].kind == VertexKind::face) seen = mesh_.vertices[k].normal;
    const bool is_turned = std::ranges::any_of(v, [&](VertexId k) { return dot(n, normalized(normal_at(k, mesh_.hint[t], middle, seen))) < cosine * area; });
    if (is_turned) turned += area;
  }
  return all > 0.0 ? turned / all : 0.0;
}

double Remesher::fan_quality(VertexId v) const {
  double worst = 1.0;
  mesh_.for_out(v, [&](HalfedgeId h) { worst = std::min(worst, quality(triangle_of(h))); });
  return worst;
}

/// Recomputes the quality. If it is below `floor`, any value below `floor` may be returned.
double Remesher::fan_quality_now(VertexId v, double floor) const {
  double worst = 1.0;
  mesh_.for_out(v, [&](HalfedgeId h) {
    if (worst >= floor) worst = std::min(worst, quality_now(triangle_of(h)));
  });
  return worst;
}

int Remesher::valence(VertexId v) const {
  int n = 0;
  mesh_.for_ring(v, [&](VertexId) { ++n; });
  return n;
}

double Remesher::s_on_line(VertexId v, std::int32_t line) const {
  const WorkVertex& w = mesh_.vertices[v];
  if (w.kind == VertexKind::line) return w.s;
  const FeatureLine& l = r_.lines[static_cast<std::size_t>(line)];
  return w.corner == l.vertices.front() ? 0.0 : l.length();
}

void Remesher::put_on_face(WorkVertex& v, const Point& p, TriangleId start) const {
  v.kind = VertexKind::face;
  v.location = r_.nearest(p, start);
  v.point = r_.point(v.location);
  v.normal = r_.normal(v.location);
  resize(v, v.location.triangle);
}

void Remesher::put_on_line(WorkVertex& v, std::int32_t line, double s) const {
  v.kind = VertexKind::line;
  v.line = line;
  v.s = s;
  v.point = r_.line_point(line, s);
  resize(v, triangle_of(r_.lines[static_cast<std::size_t>(line)].halfedges[r_.line_location(line, s).segment]));
}

WorkVertex Remesher::middle(HalfedgeId h) const {
  const VertexId a = mesh_.from(h), b = mesh_.to(h);
  WorkVertex v;
  if (mesh_.is_line(h)) {
    put_on_line(v, mesh_.line(h), 0.5 * (s_on_line(a, mesh_.line(h)) + s_on_line(b, mesh_.line(h))));
    return v;
  }
  const Point p = 0.5 * (mesh_.at(a) + mesh_.at(b));
  TriangleId start = mesh_.hint[triangle_of(h)];
  double least = norm2(nearest_on_triangle(p, corners(*r_.mesh, start)) - p);
  for (const VertexId k : {a, b}) {
    if (mesh_.vertices[k].kind != VertexKind::face) continue;
    const TriangleId t = mesh_.vertices[k].location.triangle;
    if (const double d = norm2(nearest_on_triangle(p, corners(*r_.mesh, t)) - p); d < least) {
      least = d;
      start = t;
    }
  }
  put_on_face(v, p, start);
  return v;
}

// ---- splits ------------------------------------------------------------------------------------------------------------------------------

/// Applies to an edge between two vertices of one line that is not part of the line. Returns true if its middle is not on the line, so that no triangle lies
/// flat on the line.
bool Remesher::is_split_good(HalfedgeId h, VertexId m) const {
  const WorkVertex &first = mesh_.vertices[mesh_.from(h)], &last = mesh_.vertices[mesh_.to(h)];
  const auto is_end = [&](const WorkVertex& corner, std::int32_t line) {
    const auto& v = r_.lines[static_cast<std::size_t>(line)].vertices;
    return corner.kind == VertexKind::corner && (corner.corner == v.front() || corner.corner == v.back());
  };
  const bool is_one_line = (first.kind == VertexKind::line && last.kind == VertexKind::line && first.line == last.line) ||
                           (first.kind == VertexKind::line && is_end(last, first.line)) || (last.kind == VertexKind::line && is_end(first, last.line));
  if (mesh_.is_line(h) || !is_one_line) return true;
  for (const HalfedgeId e : {h, mesh_.twins[h]}) {
    if (!e.is_valid() || quality(triangle_of(e)) <= 0.0) continue;
    const VertexId a = mesh_.from(e), b = mesh_.to(e), c = mesh_.apex(e);
    for (const TriangleVertices& v : {TriangleVertices{a, m, c}, TriangleVertices{m, b, c}})
      if (!(quality_of(v, mesh_.hint[triangle_of(e)]) > k_least_after_split * quality(triangle_of(e)))) return false;
  }
  return true;
}

std::int64_t Remesher::n_triangles() const {
  return std::ranges::count_if(mesh_.triangles, [](const TriangleVertices& v) { return v[0].is_valid(); });
}

std::int64_t Remesher::split_long(double most, std::int64_t max_triangles) {
  std::int64_t n = 0, n_triangles_now = n_triangles();
  for (int round = 0; round < k_split_rounds; ++round) {
    std::vector<std::pair<double, HalfedgeId>> found;
    for (const HalfedgeId h : mesh_.twins.ids()) {
      if (!mesh_.is_first(h) || is_locked(h)) continue;
      if (const double ratio = length_ratio(h); ratio > most) found.emplace_back(-ratio, h);
    }
    if (found.empty()) break;
    std::sort(found.begin(), found.end());
    std::int64_t done = 0;
    for (const auto& [ratio, h] : found) {
      if (n_triangles_now >= max_triangles) return n + done;
      if (!(length_ratio(h) > most)) continue;
      const WorkVertex v = middle(h);
      // On a face, the middle may be held at a line near the edge's end.
      const double length = distance(mesh_.at(mesh_.from(h)), mesh_.at(mesh_.to(h)));
      const auto [near, far] = std::minmax({distance(v.point, mesh_.at(mesh_.from(h))), distance(v.point, mesh_.at(mesh_.to(h)))});
      if (near < k_least_half * length || far > k_most_half * length) continue;
      const VertexId m = mesh_.vertices.push_back(v);
      if (!is_split_good(h, m)) {
        mesh_.vertices.raw().pop_back();
        continue;
      }
      n_triangles_now += mesh_.twins[h].is_valid() ? 2 : 1;
      mesh_.split(h);
      quality_.resize(mesh_.triangles.size());
      update_fan(m);
      ++done;
    }
    context_.check_stop();
    if (done == 0) break;
    n += done;
    flip_edges();
  }
  return n;
}

std::pair<Point, double> Remesher::shortest_to_halve(double most) const {
  std::pair<Point, double> found{mesh_.at(VertexId(0)), 0.0};
  for (const HalfedgeId h : mesh_.twins.ids()) {
    if (!mesh_.is_first(h) || is_locked(h) || !(length_ratio(h) > most)) continue;
    const Point &a = mesh_.at(mesh_.from(h)), &b = mesh_.at(mesh_.to(h));
    if (const double length = distance(a, b); found.second == 0.0 || length < found.second) found = {0.5 * (a + b), length};
  }
  return found;
}

// ---- collapses ---------------------------------------------------------------------------------------------------------------------------

/// Returns true if the start vertex of h may be merged into its end vertex. Tests the kinds of the vertices, the lines, and the link condition.
bool Remesher::is_collapse_legal(HalfedgeId h) const {
  const VertexId v = mesh_.from(h), u = mesh_.to(h);
  const HalfedgeId o = mesh_.twins[h];
  const WorkVertex& gone = mesh_.vertices[v];
  if (gone.kind == VertexKind::corner || gone.is_fixed) return false;
  if (gone.kind == VertexKind::line && mesh_.line(h) != gone.line) return false;
  // On an open boundary one triangle is removed. Each removed triangle must have neighbours at its two other edges, and at each apex at least two triangles
  // remain.
  for (const HalfedgeId e : {h, o}) {
    if (!e.is_valid()) continue;
    const HalfedgeId p = next(e), q = previous(e);
    // The border of rows may lose a triangle. Its edge passes to the triangle behind.
    const bool is_behind_front = (!mesh_.twins[p].is_valid() && is_front(p)) != (!mesh_.twins[q].is_valid() && is_front(q));
    if (!is_behind_front && (!mesh_.twins[p].is_valid() || !mesh_.twins[q].is_valid())) return false;
    if (mesh_.is_line(p) && mesh_.is_line(q)) return false;
    int n = 0;
    bool has_border = false;
    mesh_.for_out(mesh_.apex(e), [&](HalfedgeId x) {
      ++n;
      has_border = has_border || !mesh_.twins[x].is_valid();
    });
    if (n <= (has_border ? 2 : 3)) return false;
  }
  std::array<VertexId, 64> ring;
  std::size_t n_ring = 0;
  bool is_too_many = false;
  mesh_.for_ring(v, [&](VertexId w) {
    if (n_ring < ring.size()) ring[n_ring++] = w;
    else is_too_many = true;
  });
  if (is_too_many) return false;
  int common = 0;
  mesh_.for_ring(u, [&](VertexId w) {
    common += std::find(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(n_ring), w) != ring.begin() + static_cast<std::ptrdiff_t>(n_ring) ? 1 : 0;
  });
  return common == (o.is_valid() ? 2 : 1);
}

/// Returns the quality of the worst triangle that the collapse changes; k_folded also if an edge would become longer than `most`.
double Remesher::collapse_quality(HalfedgeId h, double most) const {
  const VertexId v = mesh_.from(h), u = mesh_.to(h);
  const HalfedgeId o = mesh_.twins[h];
  const WorkVertex& stays = mesh_.vertices[u];
  double worst = 1.0;
  mesh_.for_out(v, [&](HalfedgeId e) {
    if (worst == k_folded || e == h || (o.is_valid() && triangle_of(e) == triangle_of(o))) return;
    const VertexId w = mesh_.to(e);
    const WorkVertex& other = mesh_.vertices[w];
    // An edge that is too long already will be halved in any case.
    const double length = distance(stays.point, other.point);
    if (length > most * 0.5 * (stays.size + other.size) && length > k_no_longer * distance(mesh_.at(v), other.point)) {
      worst = k_folded;
      return;
    }
    TriangleVertices corner = mesh_.triangles[triangle_of(e)];
    corner[corner_of(e)] = u;
    worst = std::min(worst, quality_of(corner, mesh_.hint[triangle_of(e)]));
  });
  return worst;
}

/// Collapses the edge in the direction that leaves better triangles, if these are better than `floor`.
bool Remesher::try_collapse(HalfedgeId h, double floor, double most) {
  HalfedgeId best;
  double largest = floor;
  for (const HalfedgeId e : {h, mesh_.twins[h]}) {
    if (!e.is_valid() || !is_collapse_legal(e)) continue;
    if (const double q = collapse_quality(e, most); q > largest) {
      largest = q;
      best = e;
    }
  }
  // An open boundary has only one half-edge. A collapse in the other direction would need its twin, so it is not possible.
  if (!best.is_valid()) return false;
  const VertexId u = mesh_.to(best);
  mesh_.collapse(best);
  update_fan(u);
  return true;
}

std::int64_t Remesher::collapse_short(double least, bool is_first) {
  std::int64_t n = 0;
  std::vector<std::pair<double, HalfedgeId>> found;
  for (const HalfedgeId h : mesh_.twins.ids()) {
    if (!mesh_.is_first(h) || is_locked(h)) continue;
    if (const double ratio = length_ratio(h); ratio < least) found.emplace_back(ratio, h);
  }
  std::sort(found.begin(), found.end());
  for (const auto& [ratio, h] : found) {
    if (mesh_.is_removed(triangle_of(h)) || !(length_ratio(h) < least)) continue;
    const double before = std::min(fan_quality(mesh_.from(h)), fan_quality(mesh_.to(h)));
    if (try_collapse(h, std::max(std::min(before, k_good_enough) - 1e-12, is_first ? -2.0 : 0.0), k_longest_after_collapse)) ++n;
  }
  context_.check_stop();
  return n;
}

// ---- flips -------------------------------------------------------------------------------------------------------------------------------

/// Returns true if the edge can be flipped and both triangles are then better than `floor`.
bool Remesher::is_flip_good(HalfedgeId h, double floor) const {
  const HalfedgeId o = mesh_.twins[h];
  if (!o.is_valid() || mesh_.is_line(h)) return false;
  const VertexId a = mesh_.from(h), b = mesh_.to(h), c = mesh_.apex(h), d = mesh_.apex(o);
  return c != d && quality_of({c, d, b}, mesh_.hint[triangle_of(h)]) > floor && quality_of({d, c, a}, mesh_.hint[triangle_of(o)]) > floor &&
         !mesh_.is_edge(c, d);
}

void Remesher::flip(HalfedgeId h) {
  const HalfedgeId o = mesh_.twins[h];
  const VertexId a = mesh_.from(h), b = mesh_.to(h), c = mesh_.apex(h), d = mesh_.apex(o);
  mesh_.flip(h, {c, d, b}, {d, c, a});
  update(triangle_of(h));
  update(triangle_of(o));
}

bool Remesher::try_flip(HalfedgeId h, double gain) {
  const HalfedgeId o = mesh_.twins[h];
  if (!o.is_valid() || !is_flip_good(h, std::min(quality(triangle_of(h)), quality(triangle_of(o))) + gain)) return false;
  flip(h);
  return true;
}

std::int64_t Remesher::flip_edges() {
  std::int64_t n = 0;
  std::vector<HalfedgeId> stack;
  for (std::size_t i = mesh_.twins.size(); i-- > 0;) {
    const HalfedgeId h(i), o = mesh_.twins[h];
    if (!mesh_.is_first(h) || !o.is_valid() || mesh_.is_line(h)) continue;
    if (std::min(quality(triangle_of(h)), quality(triangle_of(o))) < k_flip_below) stack.push_back(h);
  }
  while (!stack.empty()) {
    const HalfedgeId h = stack.back();
    stack.pop_back();
    const HalfedgeId o = mesh_.twins[h];
    if (!try_flip(h, k_flip_gain)) continue;
    ++n;
    for (const TriangleId t : {triangle_of(h), triangle_of(o)})
      for (const int k : {1, 2}) stack.push_back(halfedge(t, k));
  }
  context_.check_stop();
  return n;
}

std::int64_t Remesher::regularise() {
  std::int64_t n = 0;
  Column<VertexId, int> excess(mesh_.vertices.size(), 0);
  for (const VertexId v : mesh_.vertices.ids()) {
    if (!mesh_.outgoing[v].is_valid()) continue;
    excess[v] = valence(v) - 6;
  }
  for (const HalfedgeId h : mesh_.twins.ids()) {
    const HalfedgeId o = mesh_.twins[h];
    if (!mesh_.is_first(h) || !o.is_valid() || mesh_.is_line(h)) continue;
    const std::array<VertexId, 4> v{mesh_.from(h), mesh_.to(h), mesh_.apex(h), mesh_.apex(o)};
    // The ideal number of neighbours of corners is unknown.
    int gain = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (mesh_.vertices[v[k]].kind != VertexKind::corner && !mesh_.vertices[v[k]].is_fixed) gain += k < 2 ? 2 * excess[v[k]] - 1 : -2 * excess[v[k]] - 1;
    if (gain <= 0 || !is_flip_good(h, k_regular_floor)) continue;
    flip(h);
    ++n;
    for (std::size_t k = 0; k < 4; ++k) excess[v[k]] += k < 2 ? -1 : 1;
  }
  context_.check_stop();
  return n;
}

std::vector<Remesher::Strip> Remesher::strips() const {
  std::vector<Strip> found;
  for (const HalfedgeId h : mesh_.twins.ids()) {
    if (!mesh_.is_first(h) || !mesh_.twins[h].is_valid() || mesh_.is_line(h)) continue;
    const WorkVertex &a = mesh_.vertices[mesh_.from(h)], &b = mesh_.vertices[mesh_.to(h)];
    if (a.kind == VertexKind::face || b.kind == VertexKind::face) continue;
    if (a.kind == VertexKind::line && b.kind == VertexKind::line && a.line == b.line) continue;
    found.push_back({mesh_.hint[triangle_of(h)], 0.5 * (a.point + b.point), distance(a.point, b.point)});
  }
  return found;
}

std::vector<ErrorLocation> Remesher::slivers(double angle) const {
  constexpr double k_to_degrees = 180.0 / std::numbers::pi;
  std::vector<std::pair<double, TriangleId>> found;
  for (const TriangleId t : mesh_.triangles.ids()) {
    if (mesh_.is_removed(t)) continue;
    const auto& v = mesh_.triangles[t];
    double least = std::numbers::pi;
    for (std::size_t k = 0; k < 3; ++k) least = std::min(least, corner_angle(mesh_.at(v[k]), mesh_.at(v[(k + 1) % 3]), mesh_.at(v[(k + 2) % 3])));
    if (least < angle) found.emplace_back(least, t);
  }
  std::sort(found.begin(), found.end());
  std::vector<ErrorLocation> locations;
  for (const auto& [least, t] : found) {
    const auto& v = mesh_.triangles[t];
    int n_corners = 0, n_lines = 0, n_edges = 0;
    for (int k = 0; k < 3; ++k) {
      n_corners += mesh_.vertices[v[k]].kind == VertexKind::corner ? 1 : 0;
      n_lines += mesh_.vertices[v[k]].kind == VertexKind::line ? 1 : 0;
      n_edges += mesh_.is_line(halfedge(t, k)) ? 1 : 0;
    }
    std::ostringstream text;
    text.precision(3);
    text << least * k_to_degrees << " degrees on patch " << r_.mesh->patches[r_.mesh->triangle_patch[mesh_.hint[t]]].name << ": " << n_corners << " corners, "
         << n_lines << " vertices on lines, " << n_edges << " edges of lines";
    if (is_kept(t)) text << ", kept from the input";
    locations.push_back({(mesh_.at(v[0]) + mesh_.at(v[1]) + mesh_.at(v[2])) / 3.0, text.str()});
  }
  return locations;
}

TriMesh Remesher::result() const {
  TriMesh out;
  out.patches = r_.mesh->patches;
  Column<VertexId, VertexId> ids(mesh_.vertices.size());
  Column<VertexId, std::uint8_t> is_copy(mesh_.vertices.size(), 0);
  for (const auto& [copy, was] : copies_) is_copy[copy] = 1;
  for (const VertexId v : mesh_.vertices.ids())
    if (mesh_.outgoing[v].is_valid() && is_copy[v] == 0) ids[v] = out.points.push_back(mesh_.vertices[v].point);
  // Vertices on lines with rows were copied. The copies are merged again, except on borders that have moved.
  for (const auto& [copy, was] : copies_)
    if (!ids[was].is_valid()) ids[was] = out.points.push_back(mesh_.vertices[was].point);
  for (const auto& [copy, was] : copies_) ids[copy] = ids[was];
  std::vector<std::vector<VertexId>> rows;
  for (const LineColumn& column : columns_) {
    rows.push_back({ids[column.vertex]});
    for (std::size_t k = 1; k < column.rows.size(); ++k) rows.back().push_back(out.points.push_back(column.rows[k].point));
    ids[column.vertex] = rows.back().back();
  }
  for (const TriangleId t : mesh_.triangles.ids()) {
    if (mesh_.is_removed(t)) continue;
    const auto& v = mesh_.triangles[t];
    out.triangles.push_back({ids[v[0]], ids[v[1]], ids[v[2]]});
    out.triangle_patch.push_back(r_.mesh->triangle_patch[mesh_.hint[t]]);
  }
  const auto id_at = [&](VertexId vertex, std::size_t column, std::size_t row) { return column == k_no_column ? ids[vertex] : rows[column][row]; };
  for (const RowCell& cell : row_cells()) {
    const RowEdge& edge = row_edges_[cell.edge];
    TriangleVertices v;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [side, row] = cell.corners[k];
      v[k] = side == 0 ? id_at(edge.a, edge.a_column, row) : id_at(edge.b, edge.b_column, row);
    }
    out.triangles.push_back(v);
    out.triangle_patch.push_back(r_.mesh->triangle_patch[edge.hint]);
  }
  return out;
}

std::vector<TriangleId> Remesher::reference_triangles_of(const std::vector<std::array<std::uint32_t, 2>>& pairs, int rings) const {
  std::vector<TriangleId> left;
  for (const TriangleId t : mesh_.triangles.ids())
    if (!mesh_.is_removed(t)) left.push_back(t);
  std::vector<std::uint8_t> is_found(r_.mesh->n_triangles(), 0);
  const auto mark_around = [&](VertexId v) {
    for (const HalfedgeId h : r_.topology.outgoing(v)) is_found[triangle_of(h).index()] = 1;
  };
  std::vector<std::array<TriangleId, 3>> hints;
  for (const RowCell& cell : row_cells()) {
    const RowEdge& edge = row_edges_[cell.edge];
    std::array<TriangleId, 3> location;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& [side, row] = cell.corners[k];
      location[k] = row == 0 ? edge.hint : columns_[side == 0 ? edge.a_column : edge.b_column].rows[row].location.triangle;
    }
    hints.push_back(location);
  }
  for (const auto& pair : pairs)
    for (const std::uint32_t i : pair) {
      if (i >= left.size()) {
        for (const TriangleId t : hints[i - left.size()]) is_found[t.index()] = 1;
        continue;
      }
      const TriangleId t = left[i];
      const auto& v = mesh_.triangles[t];
      Box box;
      for (const VertexId k : v) box.add(mesh_.at(k));
      // These are all reference triangles of the smooth piece that the triangle covers. They are found by walks from its corners and middle.
      std::vector<TriangleId> stack{mesh_.hint[t]};
      for (const VertexId k : v) {
        const WorkVertex& w = mesh_.vertices[k];
        if (w.kind == VertexKind::face) stack.push_back(w.location.triangle);
        else if (w.kind == VertexKind::corner) mark_around(w.corner);
        else stack.push_back(triangle_of(r_.lines[static_cast<std::size_t>(w.line)].halfedges[r_.line_location(w.line, w.s).segment]));
      }
      stack.push_back(r_.nearest((mesh_.at(v[0]) + mesh_.at(v[1]) + mesh_.at(v[2])) / 3.0, stack.back()).triangle);
      std::vector<TriangleId> seen;
      while (!stack.empty()) {
        const TriangleId u = stack.back();
        stack.pop_back();
        if (std::find(seen.begin(), seen.end(), u) != seen.end()) continue;
        seen.push_back(u);
        is_found[u.index()] = 1;
        for (int k = 0; k < 3; ++k) {
          const HalfedgeId o = r_.topology.twin(halfedge(u, k));
          if (!o.is_valid()) continue;
          Box other;
          for (const Point& p : corners(*r_.mesh, triangle_of(o))) other.add(p);
          if (overlap(box, other)) stack.push_back(triangle_of(o));
        }
      }
    }
  std::vector<TriangleId> found;
  for (int ring = 1;; ++ring) {
    found.clear();
    for (std::size_t t = 0; t < is_found.size(); ++t)
      if (is_found[t] != 0) found.emplace_back(t);
    if (ring >= rings) return found;
    for (const TriangleId t : found)
      for (const VertexId v : r_.mesh->triangles[t]) mark_around(v);
  }
}

}  // namespace sterna::surfmesh
