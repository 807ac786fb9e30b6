#include "volmesh/adjacent/wall_discs.h"

#include <algorithm>
#include <map>
#include <utility>

#include "geom/base/columns.h"
#include "geom/base/error.h"
#include "volmesh/domain/disc_baffles.h"
#include "volmesh/domain/disc_plane.h"
#include "volmesh/domain/wall_reach.h"

namespace sterna::volmesh {
namespace {

/// One side of a disc (baffle), the upstream one, between its outlines and free edges.
struct DiscBaffle {
  std::vector<VertexId> lines;  ///< growth lines of the wall below the first points
  std::size_t n_border = 0;     ///< number of the next points, which are on free edges
  std::vector<Point> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< triangles with normals upstream
  bool is_on_border(std::uint32_t i) const { return i >= lines.size() && i < lines.size() + n_border; }
};

/// Splits edges between two vertices of free edges. Both sides of the disc share these vertices, so no inner edge may join two of them. Such edges get a vertex
/// in their middle.
void split_chords(DiscBaffle& baffle) {
  for (bool has_split = true; has_split;) {
    has_split = false;
    std::map<std::array<std::uint32_t, 2>, std::vector<std::size_t>> chords;
    for (std::size_t t = 0; t < baffle.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = baffle.triangles[t][k], b = baffle.triangles[t][(k + 1) % 3];
        if (baffle.is_on_border(a) && baffle.is_on_border(b)) chords[{std::min(a, b), std::max(a, b)}].push_back(t);
      }
    std::vector<std::uint8_t> is_used(baffle.triangles.size(), 0);
    for (const auto& [chord, beside] : chords) {
      if (beside.size() != 2 || is_used[beside[0]] != 0 || is_used[beside[1]] != 0) continue;
      const auto middle = static_cast<std::uint32_t>(baffle.points.size());
      baffle.points.push_back(0.5 * (baffle.points[chord[0]] + baffle.points[chord[1]]));
      for (const std::size_t t : beside) {
        is_used[t] = 1;
        const std::array<std::uint32_t, 3> v = baffle.triangles[t];
        std::size_t k = 0;
        while (v[k] == chord[0] || v[k] == chord[1]) ++k;
        const std::uint32_t apex = v[k], a = v[(k + 1) % 3], b = v[(k + 2) % 3];
        baffle.triangles[t] = {apex, a, middle};
        baffle.triangles.push_back({apex, middle, b});
      }
      has_split = true;
    }
  }
}

template <class PointOf>
DiscBaffle make_baffle(const TriMesh& wall, const WallDisc& wall_disc, const ActuatorDisc& disc, const PointOf& point_of, const WallDiscOptions& options,
                       const RunContext& context) {
  const DiscPlane plane(disc);
  const ConstraintPlane upstream(disc.center, -plane.normal());
  AdjacentRegion region;
  region.surface = &upstream;
  region.name = disc.name;
  DiscBaffle baffle;
  const auto from = [&](HalfedgeId h) { return wall.triangles[triangle_of(h)][static_cast<std::size_t>(corner_of(h))]; };
  for (const auto& [h, twin] : wall_disc.outline) baffle.lines.push_back(from(h));  // the polygons are closed, so each vertex occurs once
  std::ranges::sort(baffle.lines);
  const auto number = [&](VertexId v) { return static_cast<std::uint32_t>(std::ranges::lower_bound(baffle.lines, v) - baffle.lines.begin()); };
  for (const VertexId v : baffle.lines) region.points.push_back(point_of(v));
  for (const auto& [h, twin] : wall_disc.outline) region.edges.push_back({number(from(twin)), number(from(h))});
  // Counter-clockwise about the axis is clockwise as seen from upstream.
  const auto add_border = [&](double radius, bool is_outer) {
    const auto first = static_cast<std::uint32_t>(region.points.size());
    const std::vector<Point> polygon = border_polygon(disc, radius, wall, options.size_growth, context);
    const auto n = static_cast<std::uint32_t>(polygon.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      region.points.push_back(plane.onto(polygon[i]));
      const std::uint32_t a = first + i, b = first + (i + 1) % n;
      region.edges.push_back(is_outer ? std::array{b, a} : std::array{a, b});
    }
  };
  if (wall_disc.has_outer_border) add_border(disc.radius, true);
  if (wall_disc.has_inner_border) add_border(disc.inner_radius, false);
  const auto own_size = disc_sizes(disc, wall, options.size_growth, context);
  region.size = [&](const Point& p) { return options.size ? std::min(own_size(p), options.size(p)) : own_size(p); };
  AdjacentTriangles made = triangulate_adjacent(region, options.ends, context);
  baffle.n_border = region.points.size() - baffle.lines.size();
  baffle.points = std::move(region.points);
  baffle.points.insert(baffle.points.end(), made.new_points.begin(), made.new_points.end());
  baffle.triangles = std::move(made.triangles);
  split_chords(baffle);
  return baffle;
}

/// Checks that the baffle intersects walls only in its outlines.
void require_baffle_clear(const ActuatorDisc& disc, const DiscBaffle& baffle, const Domain& domain, const RunContext& context) {
  std::vector<Vec3> points(domain.wall.points.begin(), domain.wall.points.end());
  const auto n_wall = static_cast<std::uint32_t>(points.size());
  points.insert(points.end(), domain.outer.points.begin(), domain.outer.points.end());
  const auto n_others = static_cast<std::uint32_t>(points.size());
  points.insert(points.end(), baffle.points.begin(), baffle.points.end());
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& t : baffle.triangles) {
    std::array<std::uint32_t, 3> v{};
    for (std::size_t k = 0; k < 3; ++k) v[k] = t[k] < baffle.lines.size() ? baffle.lines[t[k]].value() : n_others + t[k];
    triangles.push_back(v);
  }
  for (const TriangleVertices& v : domain.wall.triangles) triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
  for (const TriangleVertices& v : domain.outer.triangles) {
    std::array<std::uint32_t, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId line = domain.links.line[v[k]];
      corner[k] = line.is_valid() ? line.value() : n_wall + v[k].value();
    }
    triangles.push_back(corner);
  }
  const auto patch_of = [&](std::size_t i) -> const std::string& {
    const std::size_t n_of_wall = domain.wall.n_triangles();
    return i < n_of_wall ? domain.wall.patches[domain.wall.triangle_patch[TriangleId(i)]].name
                         : domain.outer.patches[domain.outer.triangle_patch[TriangleId(i - n_of_wall)]].name;
  };
  require_clear(disc, points, triangles, baffle.triangles.size(), patch_of, " away from the walls with layers that cross the disc", context);
}

/// Constrains the vertices of the outlines, and marks the vertices beside them that stay on their side of the plane.
class Holder {
 public:
  explicit Holder(Domain& domain) : domain_(domain), reach_(domain.wall) {
    Constraints& constraints = domain.constraints;
    constraints.vertex.resize(domain.wall.n_vertices());
    if (constraints.near.empty()) constraints.near.assign(domain.wall.n_vertices(), 0);
  }

  void hold(const DiscPlane& plane, const std::vector<VertexId>& vertices, WallDisc& wall_disc) {
    Constraints& constraints = domain_.constraints;
    wall_disc.surface = static_cast<std::int32_t>(constraints.surfaces.size());
    constraints.surfaces.push_back(std::make_shared<ConstraintBaffle>(plane.center(), -plane.normal()));
    constraints.surfaces.push_back(std::make_shared<ConstraintBaffle>(plane.center(), plane.normal()));
    for (const VertexId v : vertices) constraints.vertex[v] = {Freedom::plane, plane.normal(), {wall_disc.surface, wall_disc.surface + 1}};
    mark_near(plane, vertices, wall_disc.surface, -1.0);
    mark_near(plane, vertices, wall_disc.surface + 1, 1.0);
  }

 private:
  /// Marks vertices on one side of the plane from which a layer can reach the outline along the wall.
  void mark_near(const DiscPlane& plane, const std::vector<VertexId>& from, std::int32_t surface, double side) {
    const auto is_on_side = [&](VertexId v) { return side * plane.height(domain_.wall.points[v]) > 0.0; };
    reach_.mark(from, surface, is_on_side, domain_.constraints.near);
  }

  Domain& domain_;
  WallReach reach_;
};

/// Returns the half-edges of the wall that lie on the edges of the outline.
std::vector<std::array<HalfedgeId, 2>> outline_on_wall(const TriMesh& boundary, const CutDisc& cut, const Domain& domain) {
  std::vector<std::array<VertexId, 2>> edges = cut.outline;
  std::ranges::sort(edges);
  std::vector<std::array<HalfedgeId, 2>> outline(edges.size());
  for (const TriangleId t : domain.wall.triangles.ids()) {
    const TriangleVertices& v = boundary.triangles[domain.wall2surface[t]];  // corners of both triangles correspond one to one
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId from = v[k], to = v[(k + 1) % 3];
      for (const std::size_t side : {0u, 1u}) {
        const std::array<VertexId, 2> edge = side == 0 ? std::array{from, to} : std::array{to, from};
        const auto found = std::ranges::lower_bound(edges, edge);
        if (found != edges.end() && *found == edge) outline[static_cast<std::size_t>(found - edges.begin())][side] = halfedge(t, static_cast<int>(k));
      }
    }
  }
  return outline;
}

/// Finds the wall triangles at these vertices that lie downstream.
void find_behind(const DiscPlane& plane, const std::vector<VertexId>& vertices, const TriMesh& wall, std::vector<TriangleId>& behind) {
  for (const TriangleId t : wall.triangles.ids()) {
    double farthest = 0.0;
    bool is_at_outline = false;
    for (const VertexId v : wall.triangles[t]) {
      if (std::ranges::binary_search(vertices, v)) {
        is_at_outline = true;
        continue;
      }
      const double h = plane.height(wall.points[v]);
      if (std::abs(h) > std::abs(farthest)) farthest = h;
    }
    if (is_at_outline && farthest > 0.0) behind.push_back(t);
  }
}

/// Returns the position of a vertex of an outline among the vertices of all outlines.
std::size_t second_of(const Domain& domain, VertexId v) {
  return static_cast<std::size_t>(std::ranges::lower_bound(domain.wall_disc_vertices, v) - domain.wall_disc_vertices.begin());
}

}  // namespace

void add_wall_discs(const TriMesh& boundary, const DiscCuts& cuts, const std::vector<ActuatorDisc>& discs, double size_growth, const RunContext& context,
                    Domain& domain) {
  if (cuts.discs.empty()) return;
  Holder holder(domain);
  domain.links.line.resize(domain.outer.n_vertices());
  domain.links.surface.resize(domain.outer.n_triangles(), -1);
  for (const CutDisc& cut : cuts.discs) {
    const ActuatorDisc& disc = discs[cut.disc];
    const DiscPlane plane(disc);
    WallDisc wall_disc{.disc = cut.disc,
                       .outline = outline_on_wall(boundary, cut, domain),
                       .has_outer_border = cut.has_outer_border,
                       .has_inner_border = cut.has_inner_border};
    std::vector<VertexId> vertices;
    for (const auto& [h, twin] : wall_disc.outline) vertices.push_back(domain.wall.triangles[triangle_of(h)][static_cast<std::size_t>(corner_of(h))]);
    std::ranges::sort(vertices);
    holder.hold(plane, vertices, wall_disc);
    find_behind(plane, vertices, domain.wall, wall_disc.behind);
    domain.wall_disc_vertices.insert(domain.wall_disc_vertices.end(), vertices.begin(), vertices.end());

    const DiscBaffle baffle = make_baffle(
        domain.wall, wall_disc, disc, [&](VertexId v) { return domain.wall.points[v]; }, {.size_growth = size_growth, .ends = {}}, context);
    require_baffle_clear(disc, baffle, domain, context);
    wall_disc.patch = domain.outer.patches.push_back({disc.name, PatchKind::interface});
    wall_disc.back = domain.outer.patches.push_back({back_name(disc), PatchKind::interface});
    const std::size_t first = domain.outer.n_vertices();
    for (std::size_t i = 0; i < baffle.points.size(); ++i) {
      domain.outer.points.push_back(Point(baffle.points[i]));
      domain.links.line.push_back(i < baffle.lines.size() ? baffle.lines[i] : VertexId{});
    }
    for (const auto& t : baffle.triangles) {
      domain.outer.triangles.push_back({VertexId(first + t[0]), VertexId(first + t[1]), VertexId(first + t[2])});
      domain.outer.triangle_patch.push_back(wall_disc.patch);
      domain.links.surface.push_back(wall_disc.surface);
    }
    domain.wall_discs.push_back(std::move(wall_disc));
  }
  std::ranges::sort(domain.wall_disc_vertices);
  domain.vertex2wall_disc.resize(domain.wall_disc_vertices.size());
  for (std::size_t i = 0; i < domain.wall_discs.size(); ++i)
    for (const auto& [h, twin] : domain.wall_discs[i].outline)
      domain.vertex2wall_disc[second_of(domain, domain.wall.triangles[triangle_of(h)][static_cast<std::size_t>(corner_of(h))])] = i;
}

void close_wall_discs(const Domain& domain, const LayerBase& base, const EnvelopeShape& envelope, const std::vector<ActuatorDisc>& discs,
                      const WallDiscOptions& options, const RunContext& context, ClosedOuter& outer) {
  const auto top = [&](VertexId v) { return envelope.is_collapsed(v) ? base.wall.points[v] : envelope.point(base.wall, v); };
  for (const WallDisc& wall_disc : domain.wall_discs) {
    const ActuatorDisc& disc = discs[wall_disc.disc];
    const DiscBaffle baffle = make_baffle(base.wall, wall_disc, disc, top, options, context);
    const auto add = [&](std::size_t i, VertexId line) {
      outer.line.push_back(line);
      return outer.mesh.points.push_back(Point(baffle.points[i]));
    };
    std::vector<std::array<VertexId, 2>> sides;  // for each point its vertices on the upstream and the downstream side
    for (std::size_t i = 0; i < baffle.points.size(); ++i) {
      if (i < baffle.lines.size()) {
        const VertexId v = baffle.lines[i];
        const VertexId upstream = add(i, v);
        sides.push_back({upstream, add(i, VertexId(base.wall.n_vertices() + second_of(domain, v)))});
      } else {
        const VertexId upstream = add(i, {});
        sides.push_back({upstream, baffle.is_on_border(static_cast<std::uint32_t>(i)) ? upstream : add(i, {})});
      }
    }
    for (const auto& t : baffle.triangles) {
      outer.mesh.triangles.push_back({sides[t[0]][0], sides[t[1]][0], sides[t[2]][0]});
      outer.mesh.triangle_patch.push_back(wall_disc.patch);
    }
    for (const auto& t : baffle.triangles) {
      outer.mesh.triangles.push_back({sides[t[0]][1], sides[t[2]][1], sides[t[1]][1]});
      outer.mesh.triangle_patch.push_back(wall_disc.back);
    }
  }
}

std::vector<LayerSide> layer_sides(const Domain& domain) {
  std::vector<LayerSide> sides;
  const auto add = [&](HalfedgeId h, PatchId patch) {
    const TriangleId t = triangle_of(h);
    sides.push_back(
        {line_under(domain, t, static_cast<std::size_t>(corner_of(h))), line_under(domain, t, static_cast<std::size_t>(corner_of(next(h)))), patch});
  };
  for (const LayerBorderEdge& edge : domain.border) add(edge.halfedge, edge.patch);
  for (const WallDisc& wall_disc : domain.wall_discs) {
    for (const auto& [upstream, downstream] : wall_disc.outline) add(upstream, wall_disc.patch);
    for (const auto& [upstream, downstream] : wall_disc.outline) add(downstream, wall_disc.back);
  }
  return sides;
}

std::uint32_t line_under(const Domain& domain, TriangleId t, std::size_t corner) {
  const VertexId v = domain.wall.triangles[t][corner];
  const std::size_t second = second_of(domain, v);
  if (second == domain.wall_disc_vertices.size() || domain.wall_disc_vertices[second] != v) return v.value();
  if (!std::ranges::binary_search(domain.wall_discs[domain.vertex2wall_disc[second]].behind, t)) return v.value();
  return static_cast<std::uint32_t>(domain.wall.n_vertices() + second);
}

void open_wall_discs(const Domain& domain, LayerBlock& layers, std::vector<Point>& points) {
  for (const VertexId v : domain.wall_disc_vertices) {
    const std::uint32_t line = v.value();
    const auto first = layers.first_node[line];
    const auto n_nodes = static_cast<std::size_t>(layers.n_steps(line)) + 1;
    layers.first_node.push_back(NodeId(points.size()).value());
    layers.is_collapsed.push_back(layers.is_collapsed[line]);
    if (!layers.is_uniform()) layers.line_layers.push_back(layers.line_layers[line]);
    for (std::size_t i = 0; i < n_nodes; ++i) points.push_back(Point(points[first + i]));
  }
  for (const WallDisc& wall_disc : domain.wall_discs)
    for (const TriangleId t : wall_disc.behind)
      for (std::size_t k = 0; k < 3; ++k) layers.base[t.index()][k] = line_under(domain, t, k);
}

void open_wall_discs(const Domain& domain, LayerRequest& request) {
  const auto open = [&](auto& of_lines) {
    if (of_lines.empty()) return;
    for (const VertexId v : domain.wall_disc_vertices) of_lines.push_back(of_lines[v.index()]);
  };
  for_each_column(open, request);
}

}  // namespace sterna::volmesh
