// Steps: normals of triangles, lines and their corners, smooth pieces, normals at the corners of triangles, bulges.
//
// The curved patch is a quadratic Bezier triangle. The middle of each edge is moved by a vector that both its triangles share (bulges.cpp), so patches join
// without gaps. A flat region beside a curved one stays flat (straight_parts.cpp); point-normal triangles (Vlachos et al. 2001) would make it wavy.
#include "surfmesh/remesh/reference.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/math/nearest.h"
#include "surfmesh/remesh/bulges.h"
#include "surfmesh/remesh/straight_parts.h"

namespace sterna::surfmesh {
namespace {

/// Relative to the body's length: a triangle with less height has no normal of its own, because files in single precision round by 6e-8.
constexpr double k_thin_height = 2e-6;
/// Number of rounds in which triangles without a normal take one from their neighbours. Few rounds suffice, because chains of such triangles are short.
constexpr int k_normal_rounds = 8;
/// An edge that bends by at least the first fraction of the feature angle is a line as well, if its surroundings bend by less than the second fraction of its
/// bend.
constexpr double k_crease_share = 0.3;
constexpr double k_crease_contrast = 0.15;
/// The walk continues from triangles whose squared distance is at most this factor times the smallest one found.
constexpr double k_walk_slack = 1.3;
/// Largest number of triangles tested in one walk.
constexpr std::size_t k_walk_most = 400;

Column<TriangleId, Vec3> normals_of(const TriMesh& mesh, const Topology& topology, const RunContext& context) {
  const double thin = k_thin_height * body_length(mesh);
  Column<TriangleId, Vec3> normals(mesh.n_triangles());
  Column<TriangleId, std::uint8_t> has_one(mesh.n_triangles(), 1);
  parallel_for(context, mesh.n_triangles(), [&](std::size_t i) {
    const TriangleId t(i);
    const auto [a, b, c] = corners(mesh, t);
    const Vec3 n = cross(b - a, c - a);
    const double longest = std::sqrt(std::max({norm2(b - a), norm2(c - b), norm2(a - c)}));
    normals[t] = normalized(n);
    if (!(norm(n) > thin * longest)) has_one[t] = 0;
  });
  for (int round = 0; round < k_normal_rounds; ++round) {
    std::vector<std::pair<TriangleId, Vec3>> found;
    for (const TriangleId t : normals.ids()) {
      if (has_one[t] != 0) continue;
      Vec3 sum;
      for (int k = 0; k < 3; ++k) {
        const HalfedgeId h = halfedge(t, k), o = topology.twin(h);
        if (!o.is_valid() || has_one[triangle_of(o)] == 0) continue;
        sum += distance(mesh.points[topology.from(h)], mesh.points[topology.to(h)]) * normals[triangle_of(o)];
      }
      if (norm2(sum) > 0.0) found.emplace_back(t, normalized(sum));
    }
    if (found.empty()) break;
    for (const auto& [t, n] : found) {
      normals[t] = n;
      has_one[t] = 1;
    }
  }
  return normals;
}

/// Line edges, and the sharp edges among them. Both half-edges of such an edge are marked.
struct Marks {
  Column<HalfedgeId, std::uint8_t> is_line, is_sharp;
};

Marks mark_edges(const Reference& r, double angle, const RunContext& context) {
  const TriMesh& mesh = *r.mesh;
  Marks marks{Column<HalfedgeId, std::uint8_t>(r.topology.n_halfedges(), 0), Column<HalfedgeId, std::uint8_t>(r.topology.n_halfedges(), 0)};
  const double cosine = std::cos(angle);
  parallel_for(context, r.topology.n_halfedges(), [&](std::size_t i) {
    const HalfedgeId h(i), o = r.topology.twin(h);
    const TriangleId t = triangle_of(h);
    if (!o.is_valid()) {
      marks.is_line[h] = marks.is_sharp[h] = 1;
      return;
    }
    const TriangleId u = triangle_of(o);
    if (dot(r.triangle_normals[t], r.triangle_normals[u]) < cosine) marks.is_line[h] = marks.is_sharp[h] = 1;
    if (mesh.triangle_patch[t] != mesh.triangle_patch[u] || r.is_kept[t] != 0 || r.is_kept[u] != 0) marks.is_line[h] = 1;
  });
  return marks;
}

/// Marks creases. A crease bends less than a line, but much more than all edges around it, and lies between regions that are flat at that scale. Runs of
/// creases become lines.
void mark_creases(const Reference& r, double angle, Marks& marks, const RunContext& context) {
  const double least = k_crease_share * angle;
  Column<HalfedgeId, std::uint8_t> is_crease(marks.is_line.size(), 0);
  parallel_for(context, r.topology.n_halfedges(), [&](std::size_t i) {
    const HalfedgeId h(i), o = r.topology.twin(h);
    if (marks.is_line[h] != 0 || !o.is_valid()) return;
    const double bend = angle_between(r.triangle_normals[triangle_of(h)], r.triangle_normals[triangle_of(o)]);
    if (bend < least) return;
    const auto is_flat = [&](HalfedgeId e) { return angle_between(r.normals[previous(e)], r.triangle_normals[triangle_of(e)]) < k_crease_contrast * bend; };
    if (is_flat(h) && is_flat(o)) is_crease[h] = 1;
  });
  const auto degree = [&](VertexId v) {
    int n = 0;
    for (const HalfedgeId h : r.topology.outgoing(v)) n += is_crease[h] != 0 || marks.is_line[h] != 0 ? 1 : 0;
    return n;
  };
  std::vector<HalfedgeId> found;
  for (std::size_t i = 0; i < is_crease.size(); ++i) {
    const HalfedgeId h(i);
    if (is_crease[h] != 0 && degree(r.topology.from(h)) >= 2 && degree(r.topology.to(h)) >= 2) found.push_back(h);
  }
  for (const HalfedgeId h : found) marks.is_line[h] = marks.is_sharp[h] = 1;
}

/// Returns the half-edge of an edge with the smaller id.
HalfedgeId first_of(const Topology& topology, HalfedgeId h) {
  const HalfedgeId o = topology.twin(h);
  return o.is_valid() ? std::min(h, o) : h;
}

struct LineFinder {
  Reference& r;
  const Marks& marks;
  double angle, scale;
  std::vector<std::vector<HalfedgeId>> star;  ///< line edges of each vertex: one half-edge of each edge, sorted by id
  Column<HalfedgeId, std::uint8_t> is_used;

  LineFinder(Reference& reference, const Marks& m, const ReferenceOptions& options)
      : r(reference), marks(m), angle(options.feature_angle), scale(options.line_scale), star(reference.mesh->n_vertices()), is_used(m.is_line.size(), 0) {
    for (std::size_t i = 0; i < m.is_line.size(); ++i) {
      const HalfedgeId h(i);
      if (m.is_line[h] == 0 || first_of(r.topology, h) != h) continue;
      star[r.topology.from(h).index()].push_back(h);
      star[r.topology.to(h).index()].push_back(h);
    }
  }

  VertexId other_end(HalfedgeId h, VertexId v) const { return r.topology.from(h) == v ? r.topology.to(h) : r.topology.from(h); }
  const Point& at(VertexId v) const { return r.mesh->points[v]; }

  /// Follows the line from v along h through vertices that have exactly two line edges. Returns the location at a distance of `scale` along this path.
  Point look_along(VertexId v, HalfedgeId h) const {
    const VertexId start = v;
    double left = scale;
    while (true) {
      const VertexId w = other_end(h, v);
      const double length = distance(at(v), at(w));
      if (length >= left) return at(v) + (left / length) * (at(w) - at(v));
      left -= length;
      if (star[w.index()].size() != 2 || w == start) return at(w);
      h = star[w.index()][0] == h ? star[w.index()][1] : star[w.index()][0];
      v = w;
    }
  }
  double turn(VertexId v) const {
    const Vec3 back = look_along(v, star[v.index()][0]) - at(v), ahead = look_along(v, star[v.index()][1]) - at(v);
    return angle_between(-back, ahead);
  }

  void find_corners() {
    std::vector<double> turns(star.size(), 0.0);
    for (std::size_t v = 0; v < star.size(); ++v) {
      if (star[v].empty()) continue;
      if (star[v].size() != 2) r.is_corner[VertexId(v)] = 1;
      else turns[v] = turn(VertexId(v));
    }
    // In a bend, only the vertex with the largest turn within the scale is a corner.
    for (std::size_t v = 0; v < star.size(); ++v) {
      if (turns[v] <= angle) continue;
      bool is_most = true;
      for (const HalfedgeId first : star[v]) {
        HalfedgeId h = first;
        VertexId u(v);
        double gone = 0.0;
        while (true) {
          const VertexId w = other_end(h, u);
          gone += distance(at(u), at(w));
          if (gone > 0.5 * scale || star[w.index()].size() != 2 || w.index() == v) break;
          if (turns[w.index()] > turns[v] || (turns[w.index()] == turns[v] && w.index() < v)) is_most = false;
          h = star[w.index()][0] == h ? star[w.index()][1] : star[w.index()][0];
          u = w;
        }
      }
      if (is_most) r.is_corner[VertexId(v)] = 1;
    }
  }

  /// Returns the vertices from v along h up to the next corner, or once around a closed run.
  std::vector<VertexId> trace(VertexId v, HalfedgeId h) {
    std::vector<VertexId> way{v};
    while (true) {
      is_used[h] = 1;
      v = other_end(h, v);
      way.push_back(v);
      if (r.is_corner[v] != 0 || v == way.front()) return way;
      h = star[v.index()][0] == h ? star[v.index()][1] : star[v.index()][0];
    }
  }

  void add_line(std::vector<VertexId> vertices) {
    FeatureLine line;
    const auto number = static_cast<std::int32_t>(r.lines.size());
    line.lengths.push_back(0.0);
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
      const VertexId a = vertices[i], b = vertices[i + 1];
      HalfedgeId edge;
      for (const HalfedgeId h : star[a.index()])
        if (other_end(h, a) == b) edge = h;
      const HalfedgeId twin = r.topology.twin(edge);
      const HalfedgeId forward = r.topology.from(edge) == a || !twin.is_valid() ? edge : twin;
      line.halfedges.push_back(forward);
      line.lengths.push_back(line.lengths.back() + distance(at(a), at(b)));
      for (const HalfedgeId h : {edge, twin}) {
        if (!h.is_valid()) continue;
        r.line[h] = number;
        r.segment[h] = static_cast<std::uint32_t>(i);
      }
    }
    line.vertices = std::move(vertices);
    r.is_corner[line.vertices.front()] = r.is_corner[line.vertices.back()] = 1;
    r.lines.push_back(std::move(line));
  }

  /// Adds a line. Closed runs are cut into three parts by length, so that a line has two different ends.
  void add(const std::vector<VertexId>& way) {
    if (way.front() != way.back()) return add_line(way);
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < way.size(); ++i) length += distance(at(way[i]), at(way[i + 1]));
    std::size_t begin = 0;
    double gone = 0.0;
    for (std::size_t piece = 1; piece <= 3; ++piece) {
      std::size_t end = begin + 1;
      gone += distance(at(way[begin]), at(way[end]));
      const double target = length * static_cast<double>(piece) / 3.0;
      const std::size_t last = way.size() - 1 - (3 - piece);
      while (end < last && (piece == 3 || gone + 0.5 * distance(at(way[end]), at(way[end + 1])) < target)) {
        gone += distance(at(way[end]), at(way[end + 1]));
        ++end;
      }
      add_line({way.begin() + static_cast<std::ptrdiff_t>(begin), way.begin() + static_cast<std::ptrdiff_t>(end) + 1});
      begin = end;
    }
  }

  void run() {
    find_corners();
    for (std::size_t v = 0; v < star.size(); ++v) {
      if (r.is_corner[VertexId(v)] == 0) continue;
      for (const HalfedgeId h : star[v])
        if (is_used[h] == 0) add(trace(VertexId(v), h));
    }
    for (std::size_t v = 0; v < star.size(); ++v)
      for (const HalfedgeId h : star[v])
        if (is_used[h] == 0) add(trace(VertexId(v), h));
  }
};

void find_regions(Reference& r) {
  std::uint32_t n = 0;
  std::vector<TriangleId> stack;
  r.region.assign(r.mesh->n_triangles(), TriangleId::k_invalid);
  for (const TriangleId first : r.region.ids()) {
    if (r.region[first] != TriangleId::k_invalid) continue;
    r.region[first] = n;
    stack.push_back(first);
    while (!stack.empty()) {
      const TriangleId t = stack.back();
      stack.pop_back();
      for (int k = 0; k < 3; ++k) {
        const HalfedgeId h = halfedge(t, k), o = r.topology.twin(h);
        if (!o.is_valid() || r.line[h] != k_no_line || r.region[triangle_of(o)] != TriangleId::k_invalid) continue;
        r.region[triangle_of(o)] = n;
        stack.push_back(triangle_of(o));
      }
    }
    ++n;
  }
}

/// Computes normals at vertices, weighted by angle, over the triangles around the vertex that no sharp edge separates.
void find_normals(Reference& r, const Marks& marks, const RunContext& context) {
  const TriMesh& mesh = *r.mesh;
  const auto weighted = [&](HalfedgeId h) {
    return corner_angle(mesh.points[r.topology.from(h)], mesh.points[r.topology.to(h)], mesh.points[r.topology.from(previous(h))]) *
           r.triangle_normals[triangle_of(h)];
  };
  parallel_for(context, r.topology.n_halfedges(), [&](std::size_t i) {
    const HalfedgeId first(i);
    Vec3 sum = weighted(first);
    bool is_around = false;
    // Counter-clockwise means across the edge that ends at the vertex.
    for (HalfedgeId h = first;;) {
      const HalfedgeId in = previous(h);
      if (marks.is_sharp[in] != 0) break;
      h = r.topology.twin(in);
      if (h == first) {
        is_around = true;
        break;
      }
      sum += weighted(h);
    }
    for (HalfedgeId h = first; !is_around && marks.is_sharp[h] == 0;) {
      h = next(r.topology.twin(h));
      sum += weighted(h);
    }
    const Vec3 n = normalized(sum);
    r.normals[first] = norm2(n) > 0.0 ? n : r.triangle_normals[triangle_of(first)];
  });
}

}  // namespace

Reference::Reference(const TriMesh& wall, const ReferenceOptions& options, const Column<TriangleId, std::uint8_t>& kept,
                     const Column<TriangleId, std::uint8_t>& flat, const RunContext& context)
    : mesh(&wall),
      topology(wall, context),
      line(topology.n_halfedges(), k_no_line),
      segment(topology.n_halfedges(), 0),
      normals(topology.n_halfedges()),
      bulges(topology.n_halfedges()),
      is_kept(wall.n_triangles(), 0),
      is_corner(wall.n_vertices(), 0) {
  if (!kept.empty()) is_kept = kept;
  triangle_normals = normals_of(wall, topology, context);
  Marks marks = mark_edges(*this, options.feature_angle, context);
  find_normals(*this, marks, context);
  mark_creases(*this, options.feature_angle, marks, context);
  for (const TriangleId t : is_kept.ids())
    if (is_kept[t] != 0)
      for (const VertexId v : wall.triangles[t]) is_corner[v] = 1;
  std::vector<HalfedgeId> soft;
  for (const auto& [a, b] : options.noses)
    for (const HalfedgeId h : topology.outgoing(a)) {
      if (topology.to(h) != b || marks.is_line[h] != 0) continue;
      soft.push_back(h);
      if (const HalfedgeId o = topology.twin(h); o.is_valid()) soft.push_back(o);
    }
  for (const HalfedgeId h : soft) marks.is_line[h] = 1;
  LineFinder(*this, marks, options).run();
  std::sort(soft.begin(), soft.end());
  for (FeatureLine& l : lines)
    l.is_nose = std::all_of(l.halfedges.begin(), l.halfedges.end(), [&](HalfedgeId h) { return std::binary_search(soft.begin(), soft.end(), h); });
  find_regions(*this);
  find_normals(*this, marks, context);
  if (options.is_smooth) {
    const StraightParts parts = find_straight_parts(*this, marks.is_sharp, context);
    straighten_normals(*this, marks.is_sharp, parts, context);
    find_bulges(*this, flat, parts, context);
  } else {
    for (FeatureLine& l : lines) l.bulges.assign(l.vertices.size() - 1, Vec3{});
  }
}

ReferenceLocation Reference::nearest(const Point& p, TriangleId start) const {
  struct Step {
    TriangleId triangle;
    double distance2;
  };
  std::vector<Step> seen;
  seen.reserve(32);
  const auto look = [&](TriangleId t) {
    const Point q = nearest_on_triangle(p, corners(*mesh, t));
    seen.push_back({t, norm2(q - p)});
  };
  look(start);
  std::size_t best = 0;
  std::size_t done = 0;
  // The walk expands each visited triangle across its edges once, if the triangle is near enough.
  for (; done < seen.size() && seen.size() < k_walk_most; ++done) {
    if (seen[done].distance2 > k_walk_slack * seen[best].distance2) continue;
    for (int k = 0; k < 3; ++k) {
      const HalfedgeId h = halfedge(seen[done].triangle, k), o = topology.twin(h);
      if (line[h] != k_no_line || !o.is_valid()) continue;
      const TriangleId u = triangle_of(o);
      const std::size_t from = seen.size() > 64 ? seen.size() - 64 : 0;
      if (std::any_of(seen.begin() + static_cast<std::ptrdiff_t>(from), seen.end(), [&](const Step& s) { return s.triangle == u; })) continue;
      look(u);
      if (seen.back().distance2 < seen[best].distance2) best = seen.size() - 1;
    }
  }
  const TriangleId t = seen[best].triangle;
  const auto c = corners(*mesh, t);
  const Point q = nearest_on_triangle(p, c);
  const Vec3 u = c[1] - c[0], v = c[2] - c[0], w = q - c[0], n = cross(u, v);
  const double n2 = norm2(n);
  ReferenceLocation location{t, 0.0, 0.0};
  if (n2 > 0.0) {
    location.b1 = std::clamp(dot(cross(w, v), n) / n2, 0.0, 1.0);
    location.b2 = std::clamp(dot(cross(u, w), n) / n2, 0.0, 1.0 - location.b1);
  }
  return location;
}

Point Reference::flat_point(const ReferenceLocation& location) const {
  const auto c = corners(*mesh, location.triangle);
  return c[0] + location.b1 * (c[1] - c[0]) + location.b2 * (c[2] - c[0]);
}

Point Reference::point(const ReferenceLocation& location) const {
  const double b0 = 1.0 - location.b1 - location.b2;
  const HalfedgeId h = halfedge(location.triangle, 0);
  return flat_point(location) + (4.0 * b0 * location.b1) * bulges[h] + (4.0 * location.b1 * location.b2) * bulges[next(h)] +
         (4.0 * location.b2 * b0) * bulges[previous(h)];
}

Vec3 Reference::normal(const ReferenceLocation& location) const {
  const HalfedgeId h = halfedge(location.triangle, 0);
  return normalized((1.0 - location.b1 - location.b2) * normals[h] + location.b1 * normals[next(h)] + location.b2 * normals[previous(h)]);
}

Reference::LineLocation Reference::line_location(std::int32_t number, double s) const {
  const FeatureLine& l = lines[static_cast<std::size_t>(number)];
  const auto after = std::upper_bound(l.lengths.begin() + 1, l.lengths.end() - 1, s);
  const std::size_t i = static_cast<std::size_t>(after - l.lengths.begin()) - 1;
  const double length = l.lengths[i + 1] - l.lengths[i];
  return {static_cast<std::uint32_t>(i), length > 0.0 ? std::clamp((s - l.lengths[i]) / length, 0.0, 1.0) : 0.0};
}

Point Reference::line_point(std::int32_t number, double s) const {
  const FeatureLine& l = lines[static_cast<std::size_t>(number)];
  const auto [i, t] = line_location(number, s);
  const Point &a = mesh->points[l.vertices[i]], &b = mesh->points[l.vertices[i + 1]];
  return a + t * (b - a) + (4.0 * t * (1.0 - t)) * l.bulges[i];
}

}  // namespace sterna::surfmesh
