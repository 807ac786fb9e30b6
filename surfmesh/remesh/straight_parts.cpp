// The bend between two chords of an arc is shared by both, in proportion to their lengths. Where a straight part continues an arc tangentially, the last chord
// of the arc carries the whole bend at that end, as much as at its other end. The share of a part at its end is therefore computed as the bend there minus the
// rise of its neighbour at the neighbour's far end. This gives zero for a straight part, and the part's own rise for a chord of the same arc, for any lengths.
#include "surfmesh/remesh/straight_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"

namespace sterna::surfmesh {
namespace {

/// A part whose share is below this fraction of the bend at its end is straight there. Chords of equal length on one arc have a share of half the bend.
constexpr double k_straight_share = 0.3;
/// A part this many times as long as its neighbour is straight there. An arc cut by angle or by chord error has no such steps, and an arc with a single chord
/// has no rise.
constexpr double k_much_longer = 4.0;
/// If a part is less than this many times as long as its neighbour, the neighbour's rise adds no information to the mean normal.
constexpr double k_longer = 2.0;
/// Rad: smaller bends count as zero.
constexpr double k_no_bend = 1e-4;
/// A continuation of an edge is moved to the end of the surface if it is within the first value (rad) of it. It is moved to another edge if it is within the
/// second value, relative to the angle between two edges.
constexpr double k_near_end = 0.1, k_near_edge = 0.15;
/// Relative to the body's length: distances from a plane that rounding in files of single precision causes.
constexpr double k_plane_noise = 2e-7;
/// Rad: triangles with a larger bend are not coplanar, however small they are.
constexpr double k_most_plane_bend = 0.05;
/// An edge is a diagonal of a strip, not its side, if its bend is less than the first fraction of the bend over the adjacent edges. Only adjacent edges with at
/// least the second fraction of its length are used.
constexpr double k_diagonal_share = 0.3, k_side_length = 0.5;
/// Largest number of points of a facet that are used to measure its width.
constexpr std::size_t k_width_points = 64;
/// Cosine above which two directions of straight edges count as equal, and sine below which a direction counts as lying in a plane.
constexpr double k_same_direction = 0.95, k_in_plane = 0.1;

/// Classification of one end of a part.
enum class End : std::uint8_t { no_bend, straight, curved };

End end_of(double bend, double share, double length, double beside) {
  if (std::abs(bend) <= k_no_bend) return End::no_bend;
  if (length > k_much_longer * beside || share <= k_straight_share * std::abs(bend)) return End::straight;
  return End::curved;
}

bool is_straight(End a, End b) { return a != End::curved && b != End::curved && (a == End::straight || b == End::straight); }

struct FanWalk {
  const Reference& r;
  const Column<HalfedgeId, std::uint8_t>& is_sharp;

  /// Collects corners (half-edges that leave the vertex) counter-clockwise from `first` up to a sharp edge, or once around. \return true if it went once around
  bool turn_left(HalfedgeId first, std::vector<HalfedgeId>& fan) const {
    for (HalfedgeId h = first;;) {
      fan.push_back(h);
      const HalfedgeId in = previous(h);
      if (is_sharp[in] != 0) return false;
      h = r.topology.twin(in);
      if (h == first) return true;
    }
  }
  /// Collects the corners to the right of `first`, in their order.
  void turn_right(HalfedgeId first, std::vector<HalfedgeId>& fan) const {
    for (HalfedgeId h = first; is_sharp[h] == 0;) {
      h = next(r.topology.twin(h));
      if (h == first) return;
      fan.push_back(h);
    }
  }
  double angle(HalfedgeId h) const {
    const TriMesh& mesh = *r.mesh;
    return corner_angle(mesh.points[r.topology.from(h)], mesh.points[r.topology.to(h)], mesh.points[r.topology.from(previous(h))]);
  }
};

/// Continuation of an edge across the surface behind its end.
struct Continuation {
  bool exists = false;
  Point point;
  Vec3 normal;
};

/// Returns the point on the side of the triangle opposite the vertex of corner `h`, seen at `angle` from the first edge of the corner.
Continuation opposite_point(const FanWalk& walk, HalfedgeId h, double angle) {
  const Reference& r = walk.r;
  const Point &v = r.mesh->points[r.topology.from(h)], &x = r.mesh->points[r.topology.to(h)], &y = r.mesh->points[r.topology.from(previous(h))];
  const double all = walk.angle(h);
  double share = all > 0.0 ? angle / all : 0.0;
  share = share < k_near_edge ? 0.0 : share > 1.0 - k_near_edge ? 1.0 : share;
  const double from_x = distance(v, x) * std::sin(share * all), from_y = distance(v, y) * std::sin((1.0 - share) * all);
  const double t = from_x + from_y > 0.0 ? from_x / (from_x + from_y) : share;
  return {true, x + t * (y - x), normalized((1.0 - t) * r.normals[next(h)] + t * r.normals[previous(h)])};
}

/// Returns the continuation of the edge of `h` behind the half-edge's first vertex. The continuation is as straight as the surface allows.
Continuation continuation(const FanWalk& walk, HalfedgeId h) {
  std::vector<HalfedgeId> fan;
  const auto go = [&](double target, bool is_left) {
    double gone = 0.0;
    for (std::size_t i = 0; i < fan.size(); ++i) {
      const double angle = walk.angle(fan[i]);
      if (gone + angle < target && i + 1 < fan.size()) {
        gone += angle;
        continue;
      }
      const double here = std::clamp(target - gone, 0.0, angle);
      return opposite_point(walk, fan[i], is_left ? here : angle - here);
    }
    return Continuation{};
  };
  const auto all = [&] { return std::accumulate(fan.begin(), fan.end(), 0.0, [&](double sum, HalfedgeId e) { return sum + walk.angle(e); }); };
  if (walk.turn_left(h, fan)) return go(0.5 * all(), true);
  if (all() >= std::numbers::pi - k_near_end) return go(std::numbers::pi, true);
  fan.clear();
  walk.turn_right(h, fan);
  if (all() >= std::numbers::pi - k_near_end) return go(std::numbers::pi, false);
  return {};
}

struct EdgeEnd {
  End end = End::no_bend;
  double most_rise = std::numeric_limits<double>::infinity();
};

/// Classifies the end of an edge that is not on a line, at the first vertex of `h`.
EdgeEnd edge_end(const FanWalk& walk, HalfedgeId h) {
  const Reference& r = walk.r;
  const Point &a = r.mesh->points[r.topology.from(h)], &b = r.mesh->points[r.topology.to(h)];
  const Continuation on = continuation(walk, h);
  if (!on.exists) return {};
  const double length = distance(a, b), beside = distance(a, on.point);
  if (!(length > 0.0) || !(beside > 0.0)) return {};
  const Vec3 in = (a - b) / length, out = (on.point - a) / beside, &n = r.normals[h];
  const double bend = std::asin(std::clamp(dot(in, n), -1.0, 1.0)) - std::asin(std::clamp(dot(out, n), -1.0, 1.0));
  const double far = std::asin(std::clamp(dot(out, on.normal), -1.0, 1.0));
  const double share = std::copysign(1.0, bend) * (bend - far);
  EdgeEnd result{.end = end_of(bend, share, length, beside)};
  if (length > k_longer * beside) result.most_rise = std::max(0.0, share);
  return result;
}

/// Returns true for diagonals of strips. They end where the sides of the strips end, but the surface is curved along them.
bool is_diagonal(const FanWalk& walk, HalfedgeId h) {
  const Reference& r = walk.r;
  const auto bend = [&](HalfedgeId e) { return angle_between(r.triangle_normals[triangle_of(e)], r.triangle_normals[triangle_of(r.topology.twin(e))]); };
  const auto length = [&](HalfedgeId e) { return distance(r.mesh->points[r.topology.from(e)], r.mesh->points[r.topology.to(e)]); };
  const double own = bend(h), least = k_side_length * length(h);
  const HalfedgeId o = r.topology.twin(h);
  for (const HalfedgeId e : {next(h), previous(h), next(o), previous(o)})
    if (walk.is_sharp[e] == 0 && length(e) >= least && own < k_diagonal_share * bend(e)) return true;
  return false;
}

/// Triangles in one plane that are connected across edges that are not sharp.
struct PlaneFacet {
  std::vector<TriangleId> triangles;
  Vec3 normal;
  Point centre;
  double area = 0.0;
};

class FlatFaces {
 public:
  FlatFaces(const FanWalk& walk, StraightParts& parts) : r_(walk.r), is_sharp_(walk.is_sharp), parts_(parts), facet_(walk.r.mesh->n_triangles(), k_none) {}

  void find() {
    grow();
    std::vector<std::uint32_t> order(facets_.size());
    std::iota(order.begin(), order.end(), 0U);
    // Largest facet first, because a facet between two flat faces carries the bends at both.
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) { return facets_[i].area > facets_[j].area; });
    for (const std::uint32_t f : order)
      if (is_flat(f))
        for (const TriangleId t : facets_[f].triangles) parts_.plane[t] = facets_[f].normal;
  }

 private:
  void grow() {
    const double noise = k_plane_noise * body_length(*r_.mesh);
    std::vector<TriangleId> stack;
    for (const TriangleId first : r_.mesh->triangles.ids()) {
      if (facet_[first] != k_none) continue;
      const auto number = static_cast<std::uint32_t>(facets_.size());
      PlaneFacet facet;
      const Vec3 n = r_.triangle_normals[first];
      const Point origin = corners(*r_.mesh, first)[0];
      facet_[first] = number;
      stack.push_back(first);
      Vec3 sum, middle;
      while (!stack.empty()) {
        const TriangleId t = stack.back();
        stack.pop_back();
        facet.triangles.push_back(t);
        const auto [a, b, c] = corners(*r_.mesh, t);
        const Vec3 area = 0.5 * cross(b - a, c - a);
        sum += area;
        facet.area += norm(area);
        middle += norm(area) * ((a + b + c) / 3.0 - origin);
        for (int k = 0; k < 3; ++k) {
          const HalfedgeId h = halfedge(t, k), o = r_.topology.twin(h);
          if (is_sharp_[h] != 0 || !o.is_valid() || facet_[triangle_of(o)] != k_none) continue;
          const TriangleId u = triangle_of(o);
          const Point& tip = r_.mesh->points[r_.topology.from(previous(o))];
          const double height = height_over(o, tip);
          const double off = std::abs(dot(n, tip - origin));
          if (off > noise || angle_between(n, r_.triangle_normals[u]) > std::min(k_most_plane_bend, k_no_bend + 2.0 * noise / std::max(height, noise)))
            continue;
          facet_[u] = number;
          stack.push_back(u);
        }
      }
      facet.normal = norm2(sum) > 0.0 ? normalized(sum) : n;
      facet.centre = facet.area > 0.0 ? origin + middle / facet.area : origin;
      std::sort(facet.triangles.begin(), facet.triangles.end());
      facets_.push_back(std::move(facet));
    }
  }

  double height_over(HalfedgeId h, const Point& p) const {
    const Point &a = r_.mesh->points[r_.topology.from(h)], &b = r_.mesh->points[r_.topology.to(h)];
    const double length = distance(a, b);
    return length > 0.0 ? norm(cross(b - a, p - a)) / length : 0.0;
  }

  /// Returns the largest distance of the facet's points from the edge.
  double width(const PlaneFacet& facet, HalfedgeId h) const {
    const std::size_t step = std::max<std::size_t>(1, facet.triangles.size() / k_width_points);
    double most = height_over(h, r_.mesh->points[r_.topology.from(previous(h))]);
    for (std::size_t i = 0; i < facet.triangles.size(); i += step)
      for (const Point& p : corners(*r_.mesh, facet.triangles[i])) most = std::max(most, height_over(h, p));
    return most;
  }

  struct BorderEnd {
    End end;
    bool is_much_wider;
  };
  /// Classifies the border of facet `f` at its half-edge h.
  BorderEnd border_end(const PlaneFacet& facet, HalfedgeId h, HalfedgeId o) const {
    const TriangleId u = triangle_of(o);
    const Vec3& n = r_.triangle_normals[u];
    const double bend = angle_between(facet.normal, n);
    if (bend <= k_no_bend) return {End::no_bend, false};
    if (norm2(parts_.plane[u]) > 0.0) return {End::curved, false};
    const PlaneFacet& other = facets_[facet_[u]];
    const double wide = width(facet, h), beside = width(other, o);
    const double to_centre = height_over(o, other.centre), height = height_over(o, r_.mesh->points[r_.topology.from(previous(o))]);
    const Vec3& tip = r_.normals[previous(o)];
    // The normal turns at the same rate on both sides of the facet's centre. Bends in opposite directions add up.
    const double turn = height > to_centre ? angle_between(n, tip) * to_centre / (height - to_centre) : 0.0;
    const double sense = dot(cross(facet.normal, n), cross(n, tip)) < 0.0 ? -1.0 : 1.0;
    return {end_of(bend, bend - sense * turn, wide, beside), wide > k_much_longer * beside};
  }

  bool is_flat(std::uint32_t f) const {
    const PlaneFacet& facet = facets_[f];
    bool has_bend = false, is_much_wider = true;
    for (const TriangleId t : facet.triangles)
      for (int k = 0; k < 3; ++k) {
        const HalfedgeId h = halfedge(t, k), o = r_.topology.twin(h);
        if (is_sharp_[h] != 0 || !o.is_valid() || facet_[triangle_of(o)] == f) continue;
        const BorderEnd border = border_end(facet, h, o);
        if (border.end == End::curved) return false;
        if (border.end == End::no_bend) continue;
        has_bend = true;
        is_much_wider = is_much_wider && border.is_much_wider;
        if (facet.triangles.size() == 1 && !is_much_wider) return false;
      }
    return has_bend || facet.triangles.size() > 1;
  }

  const Reference& r_;
  const Column<HalfedgeId, std::uint8_t>& is_sharp_;
  StraightParts& parts_;
  Column<TriangleId, std::uint32_t> facet_;
  std::vector<PlaneFacet> facets_;
};

/// Returns the normal of a fan of triangles around a vertex, taking its straight parts into account.
Vec3 straight_normal(const FanWalk& walk, const StraightParts& parts, HalfedgeId h, std::vector<HalfedgeId>& fan) {
  const Reference& r = walk.r;
  fan.clear();
  const bool is_around = walk.turn_left(h, fan);
  const HalfedgeId last = previous(fan.back());
  if (!is_around) walk.turn_right(h, fan);
  Vec3 flat;
  for (const HalfedgeId e : fan) {
    const Vec3& n = parts.plane[triangle_of(e)];
    if (norm2(n) == 0.0) continue;
    // The triangles of one flat face are consecutive in the fan, and each face is used once.
    if (norm2(flat) == 0.0) flat = n;
    else if (norm2(flat - n) > 0.0) flat = flat + n;
  }
  const Vec3& before = r.normals[h];
  if (norm2(flat) > 0.0) return norm2(flat) > 1.5 ? normalized(flat) : flat;
  std::vector<Vec3> ways;
  const Point& v = r.mesh->points[r.topology.from(h)];
  for (const HalfedgeId e : fan)
    if (parts.is_straight[e] != 0) ways.push_back(normalized(r.mesh->points[r.topology.to(e)] - v));
  if (!is_around && parts.is_straight[last] != 0) ways.push_back(normalized(r.mesh->points[r.topology.from(last)] - v));
  if (ways.empty()) return before;
  Vec3 mean, other = ways.front();
  for (const Vec3& way : ways) {
    mean += std::copysign(1.0, dot(way, ways.front())) * way;
    if (std::abs(dot(way, ways.front())) < std::abs(dot(other, ways.front()))) other = way;
  }
  mean = normalized(mean);
  Vec3 n = before;
  if (std::ranges::all_of(ways, [&](const Vec3& way) { return std::abs(dot(way, mean)) > k_same_direction; })) {
    n = before - dot(before, mean) * mean;
  } else if (const Vec3 axis = normalized(cross(ways.front(), other));
             std::ranges::all_of(ways, [&](const Vec3& way) { return std::abs(dot(way, axis)) < k_in_plane; })) {
    n = dot(before, axis) * axis;
  }
  return norm2(n) > 0.25 ? normalized(n) : before;
}

}  // namespace

std::vector<std::uint8_t> straight_segments(const TriMesh& mesh, const FeatureLine& line) {
  const std::size_t n = line.vertices.size();
  const auto step = [&](std::size_t i) { return mesh.points[line.vertices[i + 1]] - mesh.points[line.vertices[i]]; };
  const auto turn = [&](std::size_t i) { return cross(normalized(step(i - 1)), normalized(step(i))); };
  std::vector<std::uint8_t> result(n - 1, 0);
  // Classifies the end of segment i where segment j continues it at vertex v. `far` is the other end of j.
  const auto end_at = [&](std::size_t i, std::size_t v, std::size_t j, std::size_t far) {
    const double bend = angle_between(step(v - 1), step(v));
    if (result[j] != 0) return bend <= k_no_bend ? End::no_bend : End::curved;
    const double length = norm(step(i)), beside = norm(step(j));
    // If the neighbour is the last segment of the line, nothing is known about the line behind it: it may be the last chord of an arc.
    double rise = length > beside ? bend : 0.0;
    if (far > 0 && far + 1 < n) {
      const double all = norm(step(far - 1)) + norm(step(far));
      rise = angle_between(step(far - 1), step(far)) * beside / all;
      if (dot(turn(v), turn(far)) < 0.0) rise = -rise;
    }
    return end_of(bend, bend - rise, length, beside);
  };
  // Longest segment first: once a segment is found to be straight, the bends at its ends count as curvature of its shorter neighbours.
  std::vector<std::size_t> order(n - 1);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return norm2(step(i)) > norm2(step(j)); });
  for (const std::size_t i : order) {
    const End a = i == 0 ? End::no_bend : end_at(i, i, i - 1, i - 1);
    const End b = i + 2 == n ? End::no_bend : end_at(i, i + 1, i + 1, i + 2);
    result[i] = is_straight(a, b) ? 1 : 0;
  }
  return result;
}

StraightParts find_straight_parts(const Reference& r, const Column<HalfedgeId, std::uint8_t>& is_sharp, const RunContext& context) {
  const std::size_t n = r.topology.n_halfedges();
  StraightParts parts{.is_straight = Column<HalfedgeId, std::uint8_t>(n, 0),
                      .most_rise = Column<HalfedgeId, double>(n, std::numeric_limits<double>::infinity()),
                      .plane = Column<TriangleId, Vec3>(r.mesh->n_triangles())};
  const FanWalk walk{r, is_sharp};
  FlatFaces(walk, parts).find();
  parallel_for(context, n, [&](std::size_t i) {
    const HalfedgeId h(i), o = r.topology.twin(h);
    if (!o.is_valid() || o < h || r.line[h] != k_no_line) return;
    if (norm2(parts.plane[triangle_of(h)]) > 0.0 || norm2(parts.plane[triangle_of(o)]) > 0.0) {
      parts.is_straight[h] = parts.is_straight[o] = 1;
    } else if (!is_diagonal(walk, h)) {
      const EdgeEnd a = edge_end(walk, h), b = edge_end(walk, o);
      parts.most_rise[h] = a.most_rise;
      parts.most_rise[o] = b.most_rise;
      parts.is_straight[h] = parts.is_straight[o] = is_straight(a.end, b.end) ? 1 : 0;
    }
  });
  for (const FeatureLine& line : r.lines) {
    const std::vector<std::uint8_t> straight = straight_segments(*r.mesh, line);
    for (std::size_t i = 0; i < straight.size(); ++i) {
      const HalfedgeId h = line.halfedges[i], o = r.topology.twin(h);
      parts.is_straight[h] = straight[i];
      if (o.is_valid()) parts.is_straight[o] = straight[i];
    }
  }
  return parts;
}

void straighten_normals(Reference& r, const Column<HalfedgeId, std::uint8_t>& is_sharp, const StraightParts& parts, const RunContext& context) {
  const FanWalk walk{r, is_sharp};
  Column<HalfedgeId, Vec3> normals(r.normals.size());
  parallel_for(context, normals.size(), [&](std::size_t i) {
    std::vector<HalfedgeId> fan;
    normals[HalfedgeId(i)] = straight_normal(walk, parts, HalfedgeId(i), fan);
  });
  r.normals = std::move(normals);
}

}  // namespace sterna::surfmesh
