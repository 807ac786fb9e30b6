// Splits patches that no single plane can represent (a round tunnel, a sphere), or that have sharp edges, if footprints of layers lie in them.
//   1. match        finds points of the region that are vertices of the original, and edges of the region that are on the original's border; all other edges
//   are footprints
//   2. find_pieces  joins triangles across edges that turn by no more than k_crease; each footprint edge belongs to the piece of the triangle nearest to it
//   3. choose_cut   cuts from each piece with a footprint: the whole piece if its normals allow it; otherwise the largest neighbourhood that has a projection
//   4. drop_covered removes the remaining triangles beyond the footprint, under the layer
//   5. make_part    determines the border of each connected cut, its projection, and the sizes that the curvature allows
#include "volmesh/adjacent/curved_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "geom/math/measures.h"
#include "geom/mesh/bvh.h"
#include "volmesh/adjacent/adjacent_errors.h"

namespace sterna::volmesh {
namespace {

/// Cosine of 70 degrees: lengths on the surface are then up to three times those in the projection.
constexpr double k_steepest = 0.342;
/// Cosine of 40 degrees: edges of the original with a larger turn are edges of the geometry. (The facets of a tunnel with 16 sides turn by 22 degrees.)
constexpr double k_crease = 0.766;
/// Extent of re-meshing around a footprint. It is a multiple of the length of each footprint edge around that edge, and a number of rings of the original's
/// triangles around all triangles within. A larger extent gives smoother sizes. The first extent that has a projection is used.
struct Reach {
  double lengths;
  int rings;
};
constexpr std::array<Reach, 6> k_reaches = {{{3.0, 4}, {3.0, 2}, {1.5, 2}, {1.0, 1}, {0.5, 1}, {0.1, 0}}};
/// Rad, 12 degrees as on model surfaces: an edge of the new mesh spans at most this angle of the surface, or the angle that the original's edges span.
constexpr double k_curvature_angle = 12.0 * std::numbers::pi / 180.0;
/// Rad: edges of the original with a smaller turn count as flat.
constexpr double k_flat_angle = 1e-6;
constexpr std::uint32_t k_no_part = ~0u;

struct PartHalf {
  std::uint32_t from, to, id;
  friend bool operator<(const PartHalf& a, const PartHalf& b) { return a.from != b.from ? a.from < b.from : a.to != b.to ? a.to < b.to : a.id < b.id; }
};

class CurvedEndSplitter {
 public:
  CurvedEndSplitter(const AdjacentRegion& region, AdjacentTriangles& result, const RunContext& context)
      : region_(region), mesh_(*region.original), result_(result), context_(context), tree_(mesh_, context), n_(mesh_.n_triangles()) {}

  std::vector<AdjacentPart> split() {
    match();
    find_pieces();
    check_normals();
    state_.assign(n_, State::kept);
    for (std::uint32_t piece = 0; piece < n_pieces_; ++piece)
      if (is_touched_[piece] != 0) choose_cut(piece);
    keep();
    std::vector<AdjacentPart> parts;
    for (const std::vector<TriangleId>& cut : cuts_) parts.push_back(make_part(cut));
    assign_footprints(parts);
    // Triangles at a replaced border that are surrounded only by covered triangles give parts without edges. These are removed.
    std::erase_if(parts, [](const AdjacentPart& part) { return part.edges.empty(); });
    return parts;
  }

 private:
  enum class State : std::uint8_t { kept, cut, covered };

  std::uint32_t from(std::uint32_t h) const { return mesh_.triangles[TriangleId(h / 3)][h % 3].value(); }
  std::uint32_t to(std::uint32_t h) const { return mesh_.triangles[TriangleId(h / 3)][(h % 3 + 1) % 3].value(); }
  Vec3 normal(std::uint32_t t) const {
    const auto [a, b, c] = corners(mesh_, TriangleId(t));
    return normalized(area_vector(a, b, c));
  }
  Point centre(std::uint32_t t) const {
    const auto [a, b, c] = corners(mesh_, TriangleId(t));
    return (a + b + c) / 3.0;
  }
  Point middle(const AdjacentEdge& edge) const { return 0.5 * (region_.points[edge[0]] + region_.points[edge[1]]); }

  void match();
  void find_pieces();
  void check_normals() const;
  void choose_cut(std::uint32_t piece);
  bool try_reach(std::uint32_t piece, const std::vector<std::uint32_t>& triangles, Reach reach);
  void drop_covered(const std::vector<std::uint32_t>& triangles);
  struct Side {
    double distance2 = std::numeric_limits<double>::infinity();  ///< m^2, squared distance from the nearest footprint edge
    bool is_covered = false;                                     ///< the triangle lies beyond the footprint edge, under the layer
  };
  Side side_of(std::uint32_t t) const;
  std::vector<std::vector<TriangleId>> connected(const std::vector<std::uint32_t>& triangles, State state) const;
  bool has_projection(std::span<const TriangleId> triangles) const;
  Vec3 mean_normal(std::span<const TriangleId> triangles) const;
  std::uint32_t number_of(std::uint32_t vertex);
  void keep();
  AdjacentPart make_part(const std::vector<TriangleId>& cut);
  void add_curvature_sizes(TriangleId t, AdjacentPart& part) const;
  void assign_footprints(std::vector<AdjacentPart>& parts);

  const AdjacentRegion& region_;
  const TriMesh& mesh_;
  AdjacentTriangles& result_;
  const RunContext& context_;
  TriangleTree tree_;
  std::size_t n_;
  std::vector<std::uint32_t> twin_;  ///< twin of each half-edge 3 t + c
  /// For each vertex the point of the region at its location, or later its number among the new points; k_no_part: not needed yet.
  std::vector<std::uint32_t> point_;
  std::vector<std::uint8_t> is_replaced_;  ///< border half-edges of the original that are no edges of the region
  std::vector<AdjacentEdge> footprints_;   ///< edges of the region that are not edges of the original
  std::vector<std::uint32_t> footprint_piece_;
  std::vector<std::uint32_t> footprint_triangle_;  ///< triangle nearest to the middle of each footprint edge
  std::vector<std::uint32_t> piece_;               ///< piece of each triangle
  std::uint32_t n_pieces_ = 0;
  std::vector<std::uint8_t> is_touched_;       ///< flag of each piece
  std::vector<State> state_;                   ///< state of each triangle
  std::vector<std::vector<TriangleId>> cuts_;  ///< cuts; each becomes one part
};

void CurvedEndSplitter::match() {
  const auto less = [](const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; };
  std::vector<std::uint32_t> order;
  for (const AdjacentEdge& edge : region_.edges) order.push_back(edge[0]);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Point &a = region_.points[i], &b = region_.points[j];
    return less(a, b) || (!less(b, a) && i < j);
  });
  point_.assign(mesh_.n_vertices(), k_no_part);
  for (const VertexId v : mesh_.points.ids()) {
    const auto at = std::lower_bound(order.begin(), order.end(), mesh_.points[v], [&](std::uint32_t i, const Point& p) { return less(region_.points[i], p); });
    if (at != order.end() && region_.points[*at] == mesh_.points[v]) point_[v.index()] = *at;
  }
  std::vector<PartHalf> halves;
  halves.reserve(3 * n_);
  for (std::uint32_t h = 0; h < 3 * n_; ++h) halves.push_back({from(h), to(h), h});
  std::sort(halves.begin(), halves.end());
  twin_.assign(3 * n_, k_no_part);
  for (const PartHalf& half : halves) {
    const auto at = std::lower_bound(halves.begin(), halves.end(), PartHalf{half.to, half.from, 0});
    if (at != halves.end() && at->from == half.to && at->to == half.from) twin_[half.id] = at->id;
  }
  std::vector<AdjacentEdge> edges(region_.edges), border;
  std::sort(edges.begin(), edges.end());
  is_replaced_.assign(3 * n_, 0);
  for (std::uint32_t h = 0; h < 3 * n_; ++h) {
    if (twin_[h] != k_no_part) continue;
    const AdjacentEdge edge{point_[from(h)], point_[to(h)]};
    if (std::binary_search(edges.begin(), edges.end(), edge)) border.push_back(edge);
    else is_replaced_[h] = 1;
  }
  std::sort(border.begin(), border.end());
  std::set_difference(edges.begin(), edges.end(), border.begin(), border.end(), std::back_inserter(footprints_));
}

void CurvedEndSplitter::find_pieces() {
  piece_.assign(n_, k_no_part);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t seed = 0; seed < n_; ++seed) {
    if (piece_[seed] != k_no_part) continue;
    piece_[seed] = n_pieces_;
    stack.push_back(seed);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        if (twin_[h] == k_no_part || piece_[twin_[h] / 3] != k_no_part) continue;
        if (dot(normal(t), normal(twin_[h] / 3)) < k_crease) continue;
        piece_[twin_[h] / 3] = n_pieces_;
        stack.push_back(twin_[h] / 3);
      }
    }
    ++n_pieces_;
  }
  is_touched_.assign(n_pieces_, 0);
  for (std::uint32_t h = 0; h < 3 * n_; ++h)
    if (is_replaced_[h] != 0) is_touched_[piece_[h / 3]] = 1;
  for (const AdjacentEdge& edge : footprints_) {
    footprint_triangle_.push_back(tree_.nearest(middle(edge)).triangle.value());
    footprint_piece_.push_back(piece_[footprint_triangle_.back()]);
    is_touched_[footprint_piece_.back()] = 1;
  }
}

void CurvedEndSplitter::check_normals() const {
  ErrorInfo info = adjacent_error(region_, ErrorCode::bad_argument, "triangles of the patch are oriented against the normals of the surface");
  for (std::uint32_t t = 0; t < n_; ++t)
    if (is_touched_[piece_[t]] != 0 && dot(normal(t), region_.surface->normal(centre(t))) < 0.0) info.add_location(centre(t), "centre of a triangle");
  if (info.n_locations > 0) throw Error(std::move(info));
}

Vec3 CurvedEndSplitter::mean_normal(std::span<const TriangleId> triangles) const {
  Vec3 sum{};
  for (const TriangleId t : triangles) {
    const auto [a, b, c] = corners(mesh_, t);
    sum += area_vector(a, b, c);
  }
  return normalized(sum);
}

bool CurvedEndSplitter::has_projection(std::span<const TriangleId> triangles) const {
  const Vec3 mean = mean_normal(triangles);
  return std::all_of(triangles.begin(), triangles.end(), [&](TriangleId t) { return dot(normal(t.value()), mean) >= k_steepest; });
}

std::vector<std::vector<TriangleId>> CurvedEndSplitter::connected(const std::vector<std::uint32_t>& triangles, State state) const {
  std::vector<std::vector<TriangleId>> groups;
  std::vector<std::uint8_t> is_seen(n_, 0);
  std::vector<std::uint32_t> stack;
  for (const std::uint32_t seed : triangles) {
    if (is_seen[seed] != 0 || state_[seed] != state) continue;
    groups.emplace_back();
    is_seen[seed] = 1;
    stack.push_back(seed);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      groups.back().push_back(TriangleId(t));
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        if (twin_[h] == k_no_part) continue;
        const std::uint32_t other = twin_[h] / 3;
        if (is_seen[other] != 0 || state_[other] != state || piece_[other] != piece_[seed]) continue;
        is_seen[other] = 1;
        stack.push_back(other);
      }
    }
    std::sort(groups.back().begin(), groups.back().end());
  }
  return groups;
}

void CurvedEndSplitter::choose_cut(std::uint32_t piece) {
  context_.check_stop();
  std::vector<std::uint32_t> triangles;
  std::vector<TriangleId> ids;
  for (std::uint32_t t = 0; t < n_; ++t)
    if (piece_[t] == piece) {
      triangles.push_back(t);
      ids.push_back(TriangleId(t));
    }
  if (has_projection(ids)) {
    for (const std::uint32_t t : triangles) state_[t] = State::cut;
    cuts_.push_back(std::move(ids));
    return;
  }
  for (const Reach reach : k_reaches)
    if (try_reach(piece, triangles, reach)) {
      for (std::vector<TriangleId>& cut : connected(triangles, State::cut)) cuts_.push_back(std::move(cut));
      return;
    }
  ErrorInfo info = adjacent_error(region_, ErrorCode::geometry_failed,
                                  "around the footprint of the layers the surface normal is more than 70 degrees from its mean: a projection would have folds");
  for (std::size_t e = 0; e < footprints_.size(); ++e)
    if (footprint_piece_[e] == piece) {
      info.add_location(middle(footprints_[e]), "edge of the footprint");
      break;
    }
  info.hint =
      "split this patch into several named patches (each with less curvature), make its triangles smaller around the body, or lower max_thickness of the "
      "layers";
  throw Error(std::move(info));
}

/// Cuts out the triangles that a footprint touches or is near to, the triangles with a replaced border, and some rings around these. Returns true if their
/// connected groups have projections.
bool CurvedEndSplitter::try_reach(std::uint32_t piece, const std::vector<std::uint32_t>& triangles, Reach reach) {
  for (const std::uint32_t t : triangles) {
    state_[t] = State::kept;
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h)
      if (is_replaced_[h] != 0) state_[t] = State::cut;
  }
  for (std::size_t e = 0; e < footprints_.size(); ++e) {
    if (footprint_piece_[e] != piece) continue;
    const Point &a = region_.points[footprints_[e][0]], &b = region_.points[footprints_[e][1]];
    const double around = reach.lengths * distance(a, b);
    Box box;
    box.add(a);
    box.add(b);
    box.min -= Vec3{around, around, around};
    box.max += Vec3{around, around, around};
    state_[footprint_triangle_[e]] = State::cut;
    tree_.boxes().for_each_overlap(box, [&](std::uint32_t t) {
      if (piece_[t] == piece) state_[t] = State::cut;
      return true;
    });
  }
  std::vector<std::uint8_t> is_near(mesh_.n_vertices(), 0);
  for (int ring = 0; ring < reach.rings; ++ring) {
    for (const std::uint32_t t : triangles)
      if (state_[t] == State::cut)
        for (const VertexId v : mesh_.triangles[TriangleId(t)]) is_near[v.index()] = 1;
    for (const std::uint32_t t : triangles)
      for (const VertexId v : mesh_.triangles[TriangleId(t)])
        if (is_near[v.index()] != 0) state_[t] = State::cut;
  }
  const std::vector<std::vector<TriangleId>> groups = connected(triangles, State::cut);
  if (!std::all_of(groups.begin(), groups.end(), [&](const auto& group) { return has_projection(group); })) return false;
  drop_covered(triangles);
  return true;
}

/// Returns the position of a triangle relative to the nearest footprint edge of its piece. If the nearest point is a common end of two edges, the mean of both
/// edges is used.
CurvedEndSplitter::Side CurvedEndSplitter::side_of(std::uint32_t t) const {
  const Point p = centre(t);
  Side result;
  Vec3 inwards{};
  Point nearest{};
  for (std::size_t e = 0; e < footprints_.size(); ++e) {
    if (footprint_piece_[e] != piece_[t]) continue;
    const Point &a = region_.points[footprints_[e][0]], &b = region_.points[footprints_[e][1]];
    const Vec3 along = b - a;
    const double share = std::clamp(dot(p - a, along) / norm2(along), 0.0, 1.0);
    const Point q = share < 1.0 ? a + share * along : b;
    const double d = norm2(p - q);
    if (d > result.distance2) continue;
    // The surface's direction at the footprint is used. The direction at the triangle would be meaningless if the triangle is far around the surface.
    const Vec3 side = normalized(cross(normal(footprint_triangle_[e]), along));
    inwards = d < result.distance2 ? side : inwards + side;
    result.distance2 = d;
    nearest = q;
  }
  result.is_covered = dot(p - nearest, inwards) < 0.0;
  return result;
}

void CurvedEndSplitter::drop_covered(const std::vector<std::uint32_t>& triangles) {
  for (const std::vector<TriangleId>& group : connected(triangles, State::kept)) {
    // The triangle beside the cut that is nearest to a footprint determines the side for the whole group.
    Side side;
    for (const TriangleId t : group) {
      bool is_beside = false;
      for (std::uint32_t h = 3 * t.value(); h < 3 * t.value() + 3; ++h) is_beside = is_beside || (twin_[h] != k_no_part && state_[twin_[h] / 3] == State::cut);
      if (!is_beside) continue;
      if (const Side here = side_of(t.value()); here.distance2 < side.distance2) side = here;
    }
    if (!side.is_covered) continue;
    for (const TriangleId t : group) state_[t.index()] = State::covered;
  }
}

std::uint32_t CurvedEndSplitter::number_of(std::uint32_t vertex) {
  if (point_[vertex] == k_no_part) {
    point_[vertex] = static_cast<std::uint32_t>(region_.points.size() + result_.new_points.size());
    result_.new_points.push_back(mesh_.points[VertexId(vertex)]);
  }
  return point_[vertex];
}

void CurvedEndSplitter::keep() {
  for (std::uint32_t t = 0; t < n_; ++t) {
    if (state_[t] != State::kept) continue;
    const TriangleVertices& v = mesh_.triangles[TriangleId(t)];
    result_.triangles.push_back({number_of(v[0].value()), number_of(v[1].value()), number_of(v[2].value())});
  }
  result_.n_kept = static_cast<std::int64_t>(result_.triangles.size());
}

AdjacentPart CurvedEndSplitter::make_part(const std::vector<TriangleId>& cut) {
  AdjacentPart part;
  part.triangles = cut;
  Box box;
  for (const TriangleId t : cut) {
    for (const Point& p : corners(mesh_, t)) box.add(p);
    for (std::uint32_t h = 3 * t.value(); h < 3 * t.value() + 3; ++h) {
      if (is_replaced_[h] != 0) continue;
      const bool is_inner = twin_[h] != k_no_part && state_[twin_[h] / 3] == State::cut && piece_[twin_[h] / 3] == piece_[t.index()];
      const bool is_covered = twin_[h] != k_no_part && state_[twin_[h] / 3] == State::covered;
      if (!is_inner && !is_covered) part.edges.push_back({number_of(from(h)), number_of(to(h))});
    }
    add_curvature_sizes(t, part);
  }
  part.frame = adjacent_frame_along(mean_normal(cut), box.center());
  return part;
}

/// Adds a size at an edge: the distance of the centres of both triangles, scaled from the angle between the triangles to the allowed angle.
void CurvedEndSplitter::add_curvature_sizes(TriangleId t, AdjacentPart& part) const {
  double size = std::numeric_limits<double>::infinity();
  for (std::uint32_t h = 3 * t.value(); h < 3 * t.value() + 3; ++h) {
    if (twin_[h] == k_no_part || piece_[twin_[h] / 3] != piece_[t.index()]) continue;
    const double angle = angle_between(normal(t.value()), normal(twin_[h] / 3));
    if (angle < k_flat_angle) continue;
    const Point &a = mesh_.points[VertexId(from(h))], &b = mesh_.points[VertexId(to(h))];
    const Vec3 along = normalized(b - a);
    const auto height = [&](std::uint32_t triangle) {
      const Vec3 off = centre(triangle) - a;
      return norm(off - dot(off, along) * along);
    };
    size = std::min(size, std::max(1.0, k_curvature_angle / angle) * (height(t.value()) + height(twin_[h] / 3)));
  }
  if (std::isfinite(size)) part.curvature_sizes.push_back({centre(t.value()), size});
}

void CurvedEndSplitter::assign_footprints(std::vector<AdjacentPart>& parts) {
  std::vector<std::uint32_t> part_of(n_, k_no_part);
  for (std::uint32_t i = 0; i < parts.size(); ++i)
    for (const TriangleId t : parts[i].triangles) part_of[t.index()] = i;
  for (std::size_t e = 0; e < footprints_.size(); ++e) parts[part_of[footprint_triangle_[e]]].edges.push_back(footprints_[e]);
}

}  // namespace

std::vector<AdjacentPart> split_curved(const AdjacentRegion& region, AdjacentTriangles& result, const RunContext& context) {
  return CurvedEndSplitter(region, result, context).split();
}

}  // namespace sterna::volmesh
