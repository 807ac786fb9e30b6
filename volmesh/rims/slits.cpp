#include "volmesh/rims/slits.h"

#include <algorithm>
#include <map>
#include <utility>

#include "geom/base/columns.h"
#include "geom/base/error.h"
#include "volmesh/domain/disc_plane.h"
#include "volmesh/domain/disc_sheets.h"
#include "volmesh/domain/wall_reach.h"

namespace sterna::volmesh {
namespace {

/// One side of a disc (baffle), the upstream one, between its outlines and free edges.
struct Sheet {
  std::vector<VertexId> lines;  ///< growth lines of the wall below the first points
  std::size_t n_rim = 0;        ///< number of the next points, which are on free edges
  std::vector<Point> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< triangles with normals upstream
  bool is_on_rim(std::uint32_t i) const { return i >= lines.size() && i < lines.size() + n_rim; }
};

/// Splits edges between two vertices of free edges. Both sides of the disc share these vertices, so no inner edge may join two of them. Such edges get a vertex
/// in their middle.
void split_chords(Sheet& sheet) {
  for (bool has_split = true; has_split;) {
    has_split = false;
    std::map<std::array<std::uint32_t, 2>, std::vector<std::size_t>> chords;
    for (std::size_t t = 0; t < sheet.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = sheet.triangles[t][k], b = sheet.triangles[t][(k + 1) % 3];
        if (sheet.is_on_rim(a) && sheet.is_on_rim(b)) chords[{std::min(a, b), std::max(a, b)}].push_back(t);
      }
    std::vector<std::uint8_t> is_used(sheet.triangles.size(), 0);
    for (const auto& [chord, beside] : chords) {
      if (beside.size() != 2 || is_used[beside[0]] != 0 || is_used[beside[1]] != 0) continue;
      const auto middle = static_cast<std::uint32_t>(sheet.points.size());
      sheet.points.push_back(0.5 * (sheet.points[chord[0]] + sheet.points[chord[1]]));
      for (const std::size_t t : beside) {
        is_used[t] = 1;
        const std::array<std::uint32_t, 3> v = sheet.triangles[t];
        std::size_t k = 0;
        while (v[k] == chord[0] || v[k] == chord[1]) ++k;
        const std::uint32_t apex = v[k], a = v[(k + 1) % 3], b = v[(k + 2) % 3];
        sheet.triangles[t] = {apex, a, middle};
        sheet.triangles.push_back({apex, middle, b});
      }
      has_split = true;
    }
  }
}

template <class PointOf>
Sheet make_sheet(const TriMesh& wall, const DiscSlit& slit, const ActuatorDisc& disc, const PointOf& point_of, const SlitOptions& options,
                 const RunContext& context) {
  const DiscPlane plane(disc);
  const ConstraintPlane upstream(disc.center, -plane.normal());
  EndRegion region;
  region.surface = &upstream;
  region.name = disc.name;
  Sheet sheet;
  const auto from = [&](HalfedgeId h) { return wall.triangles[triangle_of(h)][static_cast<std::size_t>(corner_of(h))]; };
  for (const auto& [h, twin] : slit.outline) sheet.lines.push_back(from(h));  // the polygons are closed, so each vertex occurs once
  std::ranges::sort(sheet.lines);
  const auto number = [&](VertexId v) { return static_cast<std::uint32_t>(std::ranges::lower_bound(sheet.lines, v) - sheet.lines.begin()); };
  for (const VertexId v : sheet.lines) region.points.push_back(point_of(v));
  for (const auto& [h, twin] : slit.outline) region.edges.push_back({number(from(twin)), number(from(h))});
  // Counter-clockwise about the axis is clockwise as seen from upstream.
  const auto add_rim = [&](double radius, bool is_outer) {
    const auto first = static_cast<std::uint32_t>(region.points.size());
    const std::vector<Point> polygon = rim_polygon(disc, radius, wall, options.size_growth, context);
    const auto n = static_cast<std::uint32_t>(polygon.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      region.points.push_back(plane.onto(polygon[i]));
      const std::uint32_t a = first + i, b = first + (i + 1) % n;
      region.edges.push_back(is_outer ? std::array{b, a} : std::array{a, b});
    }
  };
  if (slit.has_outer_rim) add_rim(disc.radius, true);
  if (slit.has_inner_rim) add_rim(disc.inner_radius, false);
  const auto own_size = disc_sizes(disc, wall, options.size_growth, context);
  region.size = [&](const Point& p) { return options.size ? std::min(own_size(p), options.size(p)) : own_size(p); };
  EndTriangles made = triangulate_end(region, options.ends, context);
  sheet.n_rim = region.points.size() - sheet.lines.size();
  sheet.points = std::move(region.points);
  sheet.points.insert(sheet.points.end(), made.new_points.begin(), made.new_points.end());
  sheet.triangles = std::move(made.triangles);
  split_chords(sheet);
  return sheet;
}

/// Checks that the baffle intersects walls only in its outlines.
void require_sheet_clear(const ActuatorDisc& disc, const Sheet& sheet, const Domain& domain, const RunContext& context) {
  std::vector<Vec3> points(domain.wall.points.begin(), domain.wall.points.end());
  const auto n_wall = static_cast<std::uint32_t>(points.size());
  points.insert(points.end(), domain.outer.points.begin(), domain.outer.points.end());
  const auto n_others = static_cast<std::uint32_t>(points.size());
  points.insert(points.end(), sheet.points.begin(), sheet.points.end());
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& t : sheet.triangles) {
    std::array<std::uint32_t, 3> v{};
    for (std::size_t k = 0; k < 3; ++k) v[k] = t[k] < sheet.lines.size() ? sheet.lines[t[k]].value() : n_others + t[k];
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
  require_clear(disc, points, triangles, sheet.triangles.size(), patch_of, " away from the walls with layers that cross the disc", context);
}

/// Constrains the vertices of the outlines, and marks the vertices beside them that stay on their side of the plane.
class Holder {
 public:
  explicit Holder(Domain& domain) : domain_(domain), reach_(domain.wall) {
    Constraints& constraints = domain.constraints;
    constraints.vertex.resize(domain.wall.n_vertices());
    if (constraints.near.empty()) constraints.near.assign(domain.wall.n_vertices(), 0);
  }

  void hold(const DiscPlane& plane, const std::vector<VertexId>& vertices, DiscSlit& slit) {
    Constraints& constraints = domain_.constraints;
    slit.surface = static_cast<std::int32_t>(constraints.surfaces.size());
    constraints.surfaces.push_back(std::make_shared<ConstraintSheet>(plane.center(), -plane.normal()));
    constraints.surfaces.push_back(std::make_shared<ConstraintSheet>(plane.center(), plane.normal()));
    for (const VertexId v : vertices) constraints.vertex[v] = {Freedom::plane, plane.normal(), {slit.surface, slit.surface + 1}};
    mark_near(plane, vertices, slit.surface, -1.0);
    mark_near(plane, vertices, slit.surface + 1, 1.0);
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
  return static_cast<std::size_t>(std::ranges::lower_bound(domain.slit_vertices, v) - domain.slit_vertices.begin());
}

}  // namespace

void add_slits(const TriMesh& boundary, const DiscCuts& cuts, const std::vector<ActuatorDisc>& discs, double size_growth, const RunContext& context,
               Domain& domain) {
  if (cuts.discs.empty()) return;
  Holder holder(domain);
  domain.links.line.resize(domain.outer.n_vertices());
  domain.links.surface.resize(domain.outer.n_triangles(), -1);
  for (const CutDisc& cut : cuts.discs) {
    const ActuatorDisc& disc = discs[cut.disc];
    const DiscPlane plane(disc);
    DiscSlit slit{.disc = cut.disc, .outline = outline_on_wall(boundary, cut, domain), .has_outer_rim = cut.has_outer_rim, .has_inner_rim = cut.has_inner_rim};
    std::vector<VertexId> vertices;
    for (const auto& [h, twin] : slit.outline) vertices.push_back(domain.wall.triangles[triangle_of(h)][static_cast<std::size_t>(corner_of(h))]);
    std::ranges::sort(vertices);
    holder.hold(plane, vertices, slit);
    find_behind(plane, vertices, domain.wall, slit.behind);
    domain.slit_vertices.insert(domain.slit_vertices.end(), vertices.begin(), vertices.end());

    const Sheet sheet = make_sheet(
        domain.wall, slit, disc, [&](VertexId v) { return domain.wall.points[v]; }, {.size_growth = size_growth, .ends = {}}, context);
    require_sheet_clear(disc, sheet, domain, context);
    slit.patch = domain.outer.patches.push_back({disc.name, PatchKind::interface});
    slit.back = domain.outer.patches.push_back({back_name(disc), PatchKind::interface});
    const std::size_t first = domain.outer.n_vertices();
    for (std::size_t i = 0; i < sheet.points.size(); ++i) {
      domain.outer.points.push_back(Point(sheet.points[i]));
      domain.links.line.push_back(i < sheet.lines.size() ? sheet.lines[i] : VertexId{});
    }
    for (const auto& t : sheet.triangles) {
      domain.outer.triangles.push_back({VertexId(first + t[0]), VertexId(first + t[1]), VertexId(first + t[2])});
      domain.outer.triangle_patch.push_back(slit.patch);
      domain.links.surface.push_back(slit.surface);
    }
    domain.slits.push_back(std::move(slit));
  }
  std::ranges::sort(domain.slit_vertices);
  domain.vertex2slit.resize(domain.slit_vertices.size());
  for (std::size_t i = 0; i < domain.slits.size(); ++i)
    for (const auto& [h, twin] : domain.slits[i].outline)
      domain.vertex2slit[second_of(domain, domain.wall.triangles[triangle_of(h)][static_cast<std::size_t>(corner_of(h))])] = i;
}

void close_slits(const Domain& domain, const LayerBase& base, const EnvelopeShape& envelope, const std::vector<ActuatorDisc>& discs, const SlitOptions& options,
                 const RunContext& context, ClosedOuter& outer) {
  const auto top = [&](VertexId v) { return envelope.is_collapsed(v) ? base.wall.points[v] : envelope.point(base.wall, v); };
  for (const DiscSlit& slit : domain.slits) {
    const ActuatorDisc& disc = discs[slit.disc];
    const Sheet sheet = make_sheet(base.wall, slit, disc, top, options, context);
    const auto add = [&](std::size_t i, VertexId line) {
      outer.line.push_back(line);
      return outer.mesh.points.push_back(Point(sheet.points[i]));
    };
    std::vector<std::array<VertexId, 2>> sides;  // for each point its vertices on the upstream and the downstream side
    for (std::size_t i = 0; i < sheet.points.size(); ++i) {
      if (i < sheet.lines.size()) {
        const VertexId v = sheet.lines[i];
        const VertexId upstream = add(i, v);
        sides.push_back({upstream, add(i, VertexId(base.wall.n_vertices() + second_of(domain, v)))});
      } else {
        const VertexId upstream = add(i, {});
        sides.push_back({upstream, sheet.is_on_rim(static_cast<std::uint32_t>(i)) ? upstream : add(i, {})});
      }
    }
    for (const auto& t : sheet.triangles) {
      outer.mesh.triangles.push_back({sides[t[0]][0], sides[t[1]][0], sides[t[2]][0]});
      outer.mesh.triangle_patch.push_back(slit.patch);
    }
    for (const auto& t : sheet.triangles) {
      outer.mesh.triangles.push_back({sides[t[0]][1], sides[t[2]][1], sides[t[1]][1]});
      outer.mesh.triangle_patch.push_back(slit.back);
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
  for (const RimEdge& edge : domain.rim) add(edge.halfedge, edge.patch);
  for (const DiscSlit& slit : domain.slits) {
    for (const auto& [upstream, downstream] : slit.outline) add(upstream, slit.patch);
    for (const auto& [upstream, downstream] : slit.outline) add(downstream, slit.back);
  }
  return sides;
}

std::uint32_t line_under(const Domain& domain, TriangleId t, std::size_t corner) {
  const VertexId v = domain.wall.triangles[t][corner];
  const std::size_t second = second_of(domain, v);
  if (second == domain.slit_vertices.size() || domain.slit_vertices[second] != v) return v.value();
  if (!std::ranges::binary_search(domain.slits[domain.vertex2slit[second]].behind, t)) return v.value();
  return static_cast<std::uint32_t>(domain.wall.n_vertices() + second);
}

void open_slits(const Domain& domain, LayerBlock& layers, std::vector<Point>& points) {
  for (const VertexId v : domain.slit_vertices) {
    const std::uint32_t line = v.value();
    const auto first = layers.first_node[line];
    const auto n_nodes = static_cast<std::size_t>(layers.n_steps(line)) + 1;
    layers.first_node.push_back(NodeId(points.size()).value());
    layers.is_collapsed.push_back(layers.is_collapsed[line]);
    if (!layers.is_uniform()) layers.line_layers.push_back(layers.line_layers[line]);
    for (std::size_t i = 0; i < n_nodes; ++i) points.push_back(Point(points[first + i]));
  }
  for (const DiscSlit& slit : domain.slits)
    for (const TriangleId t : slit.behind)
      for (std::size_t k = 0; k < 3; ++k) layers.base[t.index()][k] = line_under(domain, t, k);
}

void open_slits(const Domain& domain, LayerRequest& request) {
  const auto open = [&](auto& of_lines) {
    if (of_lines.empty()) return;
    for (const VertexId v : domain.slit_vertices) of_lines.push_back(of_lines[v.index()]);
  };
  for_each_column(open, request);
}

}  // namespace sterna::volmesh
