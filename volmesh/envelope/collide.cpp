#include "volmesh/envelope/collide.h"

#include <algorithm>

#include "geom/math/intersect.h"

namespace sterna::volmesh {
namespace {

constexpr int k_share_bisections = 10;  ///< number of halvings; the result is within 0.1 % of the height

FittedBoxes fixed_boxes(const TriMesh& mesh, const BoxHierarchy& tree, const RunContext& context) {
  FittedBoxes boxes;
  boxes.location.resize(tree.item_at.size());
  parallel_for(context, boxes.location.size(), [&](std::size_t i) {
    for (const Point& p : corners(mesh, TriangleId(tree.item_at[i]))) boxes.location[i].add(p);
  });
  boxes.fit(tree, context);
  return boxes;
}

RoundedBox rounded(const Box& box) {
  RoundedBox result;
  result.add(box.min);
  result.add(box.max);
  return result;
}

/// Result of one task of a search.
struct Found {
  std::vector<BoundaryCrossing> pairs;
  std::int64_t n_tested = 0;

  void append(Found more) {
    pairs.insert(pairs.end(), more.pairs.begin(), more.pairs.end());
    n_tested += more.n_tested;
  }
};

std::array<std::uint32_t, 3> values(const TriangleVertices& v, std::size_t shift = 0) {
  const std::uint32_t s = static_cast<std::uint32_t>(shift);
  return {v[0].value() + s, v[1].value() + s, v[2].value() + s};
}

bool has_distinct_corners(const std::array<std::uint32_t, 3>& v) { return v[0] != v[1] && v[1] != v[2] && v[2] != v[0]; }

}  // namespace

std::string_view to_string(BoundaryPart part) {
  switch (part) {
    case BoundaryPart::top: return "envelope";
    case BoundaryPart::side: return "side of the layer";
    case BoundaryPart::wall: return "wall";
    case BoundaryPart::outer: return "outer boundary";
  }
  return "";
}

Collider::Collider(Borrowed<const LayerBase> base, const TriMesh* outer, const RunContext& context, const OuterLinks* links)
    : base_(base),
      outer_(outer),
      links_(links && !links->empty() ? links : nullptr),
      is_collapsed_(base->wall.n_vertices(), 0),
      tree_(base->wall, context),
      wall_(fixed_boxes(base->wall, tree_, context)) {
  const std::size_t n = base->wall.n_vertices();
  points_.resize(2 * n + (outer ? outer->n_vertices() : 0));
  parallel_for(context, n, [&](std::size_t i) { points_[i] = points_[n + i] = base->wall.points[VertexId(i)]; });
  for (std::size_t h = 0; base->topology.n_boundary_halfedges() > 0 && h < base->topology.n_halfedges(); ++h)
    if (base->topology.is_boundary(HalfedgeId(h))) border_.push_back(HalfedgeId(h));
  top_.location.resize(tree_.item_at.size());
  Components components = connected_components(base->wall, base->topology);
  component_ = std::move(components.component);
  n_components_ = components.count;
  if (!outer) return;
  std::copy(outer->points.begin(), outer->points.end(), points_.begin() + static_cast<std::ptrdiff_t>(2 * n));
  outer_tree_ = BoxHierarchy(*outer, context);
  outer_boxes_ = fixed_boxes(*outer, outer_tree_, context);
}

std::uint32_t Collider::top_point(VertexId v) const { return v.value() + (is_down(v) ? 0u : static_cast<std::uint32_t>(base_.wall.n_vertices())); }

Collider::Corners Collider::points_of(const BoundaryTriangle& triangle) const {
  if (triangle.part == BoundaryPart::wall) return values(base_.wall.triangles[TriangleId(triangle.index)]);
  if (triangle.part == BoundaryPart::outer) {
    const TriangleVertices& v = outer_->triangles[TriangleId(triangle.index)];
    Corners points = values(v, 2 * base_.wall.n_vertices());
    for (std::size_t k = 0; links_ && k < 3; ++k)
      if (links_->line[v[k]].is_valid()) points[k] = links_->line[v[k]].value();
    return points;
  }
  if (triangle.part == BoundaryPart::top) {
    const TriangleVertices& v = base_.wall.triangles[TriangleId(triangle.index)];
    return {top_point(v[0]), top_point(v[1]), top_point(v[2])};
  }
  const HalfedgeId h = border_[triangle.index / 2];
  const VertexId a = base_.topology.from(h), b = base_.topology.to(h);
  if (triangle.index % 2 == 0) return {a.value(), b.value(), top_point(b)};
  return {a.value(), top_point(b), top_point(a)};
}

bool Collider::holds(std::uint32_t outer_triangle, VertexId v) const {
  if (!links_) return false;
  const std::int32_t surface = links_->surface[TriangleId(outer_triangle)];
  return surface >= 0 && base_.constraint[v].is_on(static_cast<std::size_t>(surface));
}

bool Collider::is_held(const BoundaryTriangle& moving, std::uint32_t outer_triangle) const {
  return links_ && std::ranges::any_of(moving_vertices(moving), [&](VertexId v) { return holds(outer_triangle, v); });
}

/// Calls f for the existing triangles of top and sides over a wall triangle.
template <class F>
void Collider::for_each_moving(TriangleId t, const F& f) const {
  const TriangleVertices& v = base_.wall.triangles[t];
  if (is_down(v[0]) && is_down(v[1]) && is_down(v[2])) return;
  f(BoundaryTriangle{BoundaryPart::top, t.value()});
  if (border_.empty()) return;
  for (auto h = std::lower_bound(border_.begin(), border_.end(), halfedge(t, 0)); h != border_.end() && triangle_of(*h) == t; ++h) {
    for (std::uint32_t k = 0; k < 2; ++k) {
      const BoundaryTriangle side{BoundaryPart::side, static_cast<std::uint32_t>(2 * (h - border_.begin())) + k};
      if (has_distinct_corners(points_of(side))) f(side);
    }
  }
}

/// Sets the roles of the positions in the top's hierarchy from the roles of the vertices.
template <class RoleOf>
void Collider::assign_roles(const RoleOf& role_of, bool refit, const RunContext& context) {
  top_.location_role.resize(tree_.item_at.size());
  parallel_for(context, tree_.item_at.size(), [&](std::size_t i) {
    const TriangleId t(tree_.item_at[i]);
    const TriangleVertices& v = base_.wall.triangles[t];
    const Role role = role_of(v[0]) | role_of(v[1]) | role_of(v[2]);
    top_.location_role[i] = role;
    if (!refit || role == k_no_role) return;
    RoundedBox box;
    for_each_moving(t, [&](const BoundaryTriangle& triangle) {
      for (const std::uint32_t p : points_of(triangle)) box.add(points_[p]);
    });
    top_.location[i] = box;
  });
  top_.spread_roles(tree_, refit, context);
}

void Collider::move_top(const EnvelopeShape& shape, const RunContext& context, double stretch, const Column<VertexId, std::uint8_t>* stretched) {
  const std::size_t n = base_.wall.n_vertices();
  Column<VertexId, std::uint8_t> has_moved(n, 0);
  parallel_for(context, n, [&](std::size_t i) {
    const VertexId v(i);
    const double height = (stretched && (*stretched)[v] ? stretch : 1.0) * shape.height[v];
    const Point top = base_.wall.points[v] + height * shape.direction[v];
    const std::uint8_t is_collapsed = shape.is_collapsed(v) ? 1 : 0;
    if (has_top_ && top == points_[n + i] && is_collapsed == is_collapsed_[v]) return;
    has_moved[v] = 1;
    points_[n + i] = top;
    is_collapsed_[v] = is_collapsed;
  });
  has_top_ = true;
  assign_roles([&](VertexId v) { return has_moved[v] ? k_both_roles : k_no_role; }, true, context);
}

std::vector<BoundaryCrossing> Collider::crossings(const RunContext& context, const std::vector<VertexId>* around,
                                                  const Column<VertexId, std::uint8_t>* against) {
  // Roles belong to wall triangles. Sides are tested together with their top triangle, at little cost.
  if (around) {
    Column<VertexId, Role> role(base_.wall.n_vertices(), against ? k_no_role : k_partner);
    for (const VertexId v : *around) role[v] |= k_seeker;
    for (const VertexId v : role.ids())
      if (against && (*against)[v]) role[v] |= k_partner;
    assign_roles([&](VertexId v) { return role[v]; }, false, context);
  } else {
    assign_roles([](VertexId) { return k_both_roles; }, false, context);
  }
  wall_.common_role = outer_boxes_.common_role = against ? k_no_role : k_partner;
  const auto test = [&](const BoundaryTriangle& first, const BoundaryTriangle& second, Found& results) {
    ++results.n_tested;
    if (triangles_cross(points_, points_of(first), points_of(second))) results.pairs.push_back({std::min(first, second), std::max(first, second)});
  };
  const SearchSide top{&tree_, &top_};
  Found found = search_pairs<Found>(
      top, top,
      [&](std::uint32_t a, std::uint32_t b, Found& results) {
        for_each_moving(TriangleId(a), [&](const BoundaryTriangle& first) {
          for_each_moving(TriangleId(b), [&](const BoundaryTriangle& second) {
            if (a != b || first < second) test(first, second, results);
          });
        });
      },
      context);
  const auto search_fixed = [&](const BoxHierarchy& tree, const FittedBoxes& boxes, BoundaryPart part) {
    found.append(search_pairs<Found>(
        top, {&tree, &boxes},
        [&](std::uint32_t a, std::uint32_t b, Found& results) {
          for_each_moving(TriangleId(a), [&](const BoundaryTriangle& first) {
            if (part != BoundaryPart::outer || !is_held(first, b)) test(first, {part, b}, results);
          });
        },
        context));
  };
  search_fixed(tree_, wall_, BoundaryPart::wall);
  if (outer_) search_fixed(outer_tree_, outer_boxes_, BoundaryPart::outer);
  n_pairs_ = found.n_tested;
  std::sort(found.pairs.begin(), found.pairs.end());
  return std::move(found.pairs);
}

bool Collider::has_multi_normal_on(TriangleId wall_triangle, std::uint32_t outer_triangle) const {
  return base_.ridges && links_ &&
         std::ranges::any_of(base_.wall.triangles[wall_triangle], [&](VertexId v) { return base_.multi_normal_of(v) != nullptr && holds(outer_triangle, v); });
}

std::vector<BoundaryCrossing> Collider::fixed_crossings(const RunContext& context) {
  const SearchSide wall{&tree_, &wall_}, outer{&outer_tree_, &outer_boxes_};
  const auto search = [&](const SearchSide& side_a, BoundaryPart part_a, const SearchSide& side_b, BoundaryPart part_b) {
    return search_pairs<Found>(
        side_a, side_b,
        [&](std::uint32_t a, std::uint32_t b, Found& results) {
          if (part_a == part_b && a == b) return;
          const BoundaryTriangle first{part_a, a}, second{part_b, b};
          ++results.n_tested;
          if (part_a == BoundaryPart::wall && part_b == BoundaryPart::outer && has_multi_normal_on(TriangleId(a), b)) return;
          if (triangles_cross(points_, points_of(first), points_of(second))) results.pairs.push_back({std::min(first, second), std::max(first, second)});
        },
        context);
  };
  wall_.common_role = outer_boxes_.common_role = k_both_roles;
  Found found = search(wall, BoundaryPart::wall, wall, BoundaryPart::wall);
  if (outer_) {
    found.append(search(wall, BoundaryPart::wall, outer, BoundaryPart::outer));
    found.append(search(outer, BoundaryPart::outer, outer, BoundaryPart::outer));
  }
  n_pairs_ = found.n_tested;
  std::sort(found.pairs.begin(), found.pairs.end());
  return std::move(found.pairs);
}

double Collider::clear_share(const BoundaryCrossing& pair, const EnvelopeShape& shape) const {
  const std::uint32_t n = static_cast<std::uint32_t>(base_.wall.n_vertices());
  // The points of the pair get local numbers. A shared point has one number.
  std::array<std::uint32_t, 6> known{};
  std::array<Vec3, 6> points{};
  std::array<Corners, 2> triangle{};
  std::size_t n_known = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Corners own = points_of(pair[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t found =
          static_cast<std::size_t>(std::find(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(n_known), own[k]) - known.begin());
      triangle[i][k] = static_cast<std::uint32_t>(found);
      if (found < n_known) continue;
      points[n_known] = points_[own[k]];
      known[n_known++] = own[k];
    }
  }
  // The height of a vertex that both triangles share is cut relative to the lower of the two.
  const std::array<double, 2> highest = {tallest(pair[0], shape), tallest(pair[1], shape)};
  std::array<double, 6> reference{};
  for (std::size_t i = 0; i < 2; ++i)
    for (const std::uint32_t k : triangle[i]) reference[k] = reference[k] == 0.0 ? highest[i] : std::min(reference[k], highest[i]);
  const auto crosses_at = [&](double share) {
    for (std::size_t i = 0; i < n_known; ++i) {
      if (known[i] < n || known[i] >= 2 * n) continue;
      const VertexId v(known[i] - n);
      points[i] = base_.wall.points[v] + std::min(shape.height[v], share * reference[i]) * shape.direction[v];
    }
    return triangles_cross(points, triangle[0], triangle[1]);
  };
  double clear = 0.0, crossing = 1.0;
  for (int step = 0; step < k_share_bisections; ++step) {
    const double middle = 0.5 * (clear + crossing);
    (crosses_at(middle) ? crossing : clear) = middle;
  }
  return clear;
}

std::vector<VertexId> Collider::moving_vertices(const BoundaryTriangle& triangle) const {
  if (triangle.part == BoundaryPart::top) {
    const TriangleVertices& v = base_.wall.triangles[TriangleId(triangle.index)];
    return {v[0], v[1], v[2]};
  }
  if (triangle.part != BoundaryPart::side) return {};
  const HalfedgeId h = border_[triangle.index / 2];
  return {base_.topology.from(h), base_.topology.to(h)};
}

double Collider::tallest(const BoundaryTriangle& triangle, const EnvelopeShape& shape) const {
  double result = 0.0;
  for (const VertexId v : moving_vertices(triangle)) result = std::max(result, shape.height[v]);
  return result;
}

std::array<Point, 3> Collider::corners_of(const BoundaryTriangle& triangle) const {
  const Corners p = points_of(triangle);
  return {points_[p[0]], points_[p[1]], points_[p[2]]};
}

std::int64_t Collider::n_triangles() const {
  std::int64_t n = static_cast<std::int64_t>(base_.wall.n_triangles() + (outer_ ? outer_->n_triangles() : 0));
  for (const TriangleId t : base_.wall.triangles.ids()) for_each_moving(t, [&](const BoundaryTriangle&) { ++n; });
  return n;
}

void Collider::find_walls(const Box& box, std::vector<std::uint32_t>& found) const { find_overlaps(tree_, wall_, wall_, rounded(box), found); }
void Collider::find_cells(const Box& box, std::vector<std::uint32_t>& found) const { find_overlaps(tree_, wall_, top_, rounded(box), found); }
void Collider::find_outer(const Box& box, std::vector<std::uint32_t>& found) const {
  find_overlaps(outer_tree_, outer_boxes_, outer_boxes_, rounded(box), found);
}

}  // namespace sterna::volmesh
