// Steps: require_closed; numbering of both parts; layer boundary; surfaces of the adjacent patches; snapping; wall vertices near a surface. For the layer
// boundary, a walk around each of its vertices passes through the patches without layers. One patch constrains the vertex to a surface, two patches to their
// common line, and more patches fix it. The surface of an adjacent patch is a plane if its vertices lie in a plane.
#include "volmesh/domain/domain_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/topology.h"
#include "volmesh/domain/flat_patch.h"
#include "volmesh/domain/open_borders.h"
#include "volmesh/domain/wall_reach.h"
#include "volmesh/envelope/constrain_borders.h"

namespace sterna::volmesh {
namespace {

constexpr double k_chain_sine = 1e-3;      ///< sine of the angle between two planes: for smaller angles, the line is taken along their common edge
constexpr double k_forward_cosine = 0.02;  ///< smallest cosine between the wall's normal and a line along which a layer grows

ErrorInfo error(ErrorCode code, std::string problem, std::string hint) {
  return {.code = code, .attempted = "volume_mesh", .problem = std::move(problem), .hint = std::move(hint)};
}

void require_closed(const TriMesh& surface, const Topology& topology) {
  if (topology.n_boundary_halfedges() == 0) return;
  ErrorInfo info =
      error(ErrorCode::open_surface, "the fluid's boundary is open: " + std::to_string(topology.n_boundary_halfedges()) + " edges have one triangle",
            "close the holes; a half model must end in one plane x, y or z = constant");
  info.n_locations = static_cast<std::int64_t>(topology.n_boundary_halfedges());
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (!topology.is_boundary(h)) continue;
    const std::uint32_t next = static_cast<std::uint32_t>(info.geometry.points.size());
    info.geometry.points.insert(info.geometry.points.end(), {surface.points[topology.from(h)], surface.points[topology.to(h)]});
    info.geometry.edges.push_back({next, next + 1});
    if (info.locations.size() < k_max_locations) info.locations.push_back({surface.points[topology.from(h)], "an open edge starts here"});
  }
  throw Error(std::move(info));
}

/// One of the two parts: the selected triangles, with their vertices and patches renumbered in the order of the surface.
struct Part {
  TriMesh mesh;
  Column<VertexId, VertexId> surface2part;  ///< number of each vertex in the part; invalid if the part does not contain it
  Column<PatchId, PatchId> patch2part;
  Column<TriangleId, TriangleId> part2surface;
};

template <class Chosen>
Part part_of(const TriMesh& surface, const Chosen& is_chosen) {
  Part part;
  part.surface2part.resize(surface.n_vertices());
  part.patch2part.resize(surface.patches.size());
  Column<VertexId, std::uint8_t> is_used(surface.n_vertices(), 0);
  Column<PatchId, std::uint8_t> has_triangle(surface.patches.size(), 0);
  for (const TriangleId t : surface.triangles.ids()) {
    if (!is_chosen(t)) continue;
    has_triangle[surface.triangle_patch[t]] = 1;
    for (const VertexId v : surface.triangles[t]) is_used[v] = 1;
  }
  for (const VertexId v : surface.points.ids())
    if (is_used[v]) part.surface2part[v] = part.mesh.points.push_back(surface.points[v]);
  for (const PatchId p : surface.patches.ids())
    if (has_triangle[p]) part.patch2part[p] = part.mesh.patches.push_back(surface.patches[p]);
  for (const TriangleId t : surface.triangles.ids()) {
    if (!is_chosen(t)) continue;
    TriangleVertices v = surface.triangles[t];
    for (VertexId& corner : v) corner = part.surface2part[corner];
    part.mesh.triangles.push_back(v);
    part.mesh.triangle_patch.push_back(part.patch2part[surface.triangle_patch[t]]);
    part.part2surface.push_back(t);
  }
  return part;
}

/// Result of the walk around a layer boundary vertex, from its outgoing border half-edge to the incoming one: the patches beyond the border, and the half-edges
/// from the vertex at which the patch changes.
struct BorderWalk {
  std::vector<PatchId> patches;     ///< patches of the surface, in the order of the walk
  std::vector<HalfedgeId> changes;  ///< half-edges of the surface that start at the vertex; one less than patches
};

class DomainSplitter {
 public:
  DomainSplitter(const TriMesh& surface, const Column<PatchId, std::uint8_t>& has_layer, std::span<const PeriodicPatches> periodic, const RunContext& context)
      : surface_(surface), has_layer_(has_layer), periodic_(periodic), context_(context), topology_(surface, context) {}

  Domain split() {
    require_closed(surface_, topology_);
    wall_ = part_of(surface_, [&](TriangleId t) { return is_layered(t); });
    outer_ = part_of(surface_, [&](TriangleId t) { return !is_layered(t); });
    find_parts();
    find_border();
    keep_periodic();
    if (!domain_.border.empty()) {
      hold_border();
      link();
    }
    domain_.wall = std::move(wall_.mesh);
    domain_.outer = std::move(outer_.mesh);
    domain_.wall2surface = std::move(wall_.part2surface);
    return std::move(domain_);
  }

 private:
  bool is_layered(TriangleId t) const { return has_layer_[surface_.triangle_patch[t]] != 0; }

  /// Collects all closed parts except the one that encloses the fluid, which is the inward-oriented part with the largest volume. Other inward-oriented parts
  /// are cavities.
  void find_parts() {
    const Components parts = connected_components(surface_, topology_);
    std::vector<CompensatedSum> sums(parts.count);
    std::vector<VertexId> first(parts.count);
    for (const TriangleId t : surface_.triangles.ids()) {
      VertexId& origin = first[parts.component[t]];
      if (!origin.is_valid()) origin = surface_.triangles[t][0];
      const auto [a, b, c] = corners(surface_, t);
      sums[parts.component[t]].add(tet_volume(surface_.points[origin], a, b, c));
    }
    std::size_t container = 0;
    for (std::size_t k = 0; k < sums.size(); ++k)
      if (sums[k].value() < sums[container].value()) container = k;
    if (sums[container].value() >= 0.0)
      throw Error(error(ErrorCode::not_orientable, "no part of the boundary encloses the fluid",
                        "normals must point into the fluid: outwards on bodies, inwards on the surfaces around the bodies"));
    domain_.bodies = part_of(surface_, [&](TriangleId t) { return parts.component[t] != container; }).mesh;
    for (std::size_t k = 0; k < sums.size(); ++k)
      if (k != container && sums[k].value() < 0.0) add_cavity(parts, k, -sums[k].value());
  }

  void add_cavity(const Components& parts, std::size_t k, double volume) {
    Domain::Cavity cavity{.volume = volume, .box = {}, .patches = {}};
    std::vector<std::uint8_t> has_patch(surface_.patches.size(), 0);
    for (const TriangleId t : surface_.triangles.ids()) {
      if (parts.component[t] != k) continue;
      for (const Point& p : corners(surface_, t)) cavity.box.add(p);
      has_patch[surface_.triangle_patch[t].index()] = 1;
    }
    for (const PatchId p : surface_.patches.ids())
      if (has_patch[p.index()] != 0) cavity.patches.push_back(surface_.patches[p].name);
    domain_.cavities.push_back(std::move(cavity));
  }

  void link() {
    domain_.links.line.resize(outer_.mesh.n_vertices());
    for (const VertexId v : surface_.points.ids())
      if (outer_.surface2part[v].is_valid()) domain_.links.line[outer_.surface2part[v]] = wall_.surface2part[v];
    domain_.links.surface.assign(outer_.mesh.n_triangles(), -1);
    for (const TriangleId t : outer_.mesh.triangles.ids())
      for (const AdjacentPatch& end : domain_.adjacent)
        if (outer_.mesh.triangle_patch[t] == end.patch) domain_.links.surface[t] = end.surface;
  }

  /// Finds the numbers of periodic sides and of partner vertices in both parts. \throws if a wall with layers ends on only one of two partner sides
  void keep_periodic() {
    ErrorInfo info = error(ErrorCode::bad_argument, "",
                           "the same walls must end at the same locations of both periodic sides: give the patches there the same kind and layers");
    for (const PeriodicPatches& sides : periodic_) {
      PeriodicPair ends{outer_.patch2part[sides.first], outer_.patch2part[sides.second], sides.translation, {}};
      for (const auto& [a, b] : sides.vertices) {
        ends.vertices.push_back({outer_.surface2part[a], outer_.surface2part[b]});
        const VertexId on_first = wall_.surface2part[a], on_second = wall_.surface2part[b];
        if (on_first.is_valid() && on_second.is_valid()) domain_.partners.push_back({on_first, on_second});
        if (on_first.is_valid() == on_second.is_valid()) continue;
        ++info.n_locations;
        if (info.locations.size() < k_max_locations)
          info.locations.push_back({surface_.points[on_first.is_valid() ? a : b], "a wall with layers is here, but not at the periodic image"});
      }
      domain_.periodic.push_back(std::move(ends));
    }
    if (info.n_locations == 0) return;
    info.problem = "at " + std::to_string(info.n_locations) + " vertices a wall with layers ends on one periodic side but not on the other";
    throw Error(std::move(info));
  }

  /// Restricts both partners to the freedoms that they have in common.
  void share_freedoms() {
    for (bool is_changed = true; is_changed;) {
      is_changed = false;
      for (const auto& [a, b] : domain_.partners) {
        VertexConstraint &first = domain_.constraints.vertex[a], &second = domain_.constraints.vertex[b];
        if (first.freedom == second.freedom) continue;
        first.freedom = second.freedom = Freedom::fixed;
        is_changed = true;
      }
    }
  }

  void find_border() {
    std::vector<std::uint8_t> n_walks(surface_.n_vertices(), 0);
    std::vector<VertexId> pinched;
    for (const TriangleId t : wall_.mesh.triangles.ids()) {
      for (int k = 0; k < 3; ++k) {
        const HalfedgeId h = halfedge(wall_.part2surface[t], k);
        const TriangleId beyond = triangle_of(topology_.twin(h));
        if (is_layered(beyond)) continue;
        domain_.border.push_back({halfedge(t, k), outer_.patch2part[surface_.triangle_patch[beyond]]});
        if (n_walks[topology_.from(h).index()]++ > 0) pinched.push_back(topology_.from(h));
      }
    }
    if (pinched.empty()) return;
    ErrorInfo info =
        error(ErrorCode::non_manifold_surface,
              "at " + std::to_string(pinched.size()) + " points walls with layers meet only in that point, with patches without layers between them",
              "give layers to one of the patches around this location, or remove the layers of the walls there (patches = { name = { layers = 0 } })");
    for (std::size_t i = 0; i < std::min(pinched.size(), k_max_locations); ++i)
      info.locations.push_back({surface_.points[pinched[i]], "vertex " + std::to_string(pinched[i].value())});
    throw Error(std::move(info));
  }

  BorderWalk walk_beyond(HalfedgeId border) const {
    BorderWalk walk;
    // The twin ends at the vertex. Its successor starts at the vertex, one triangle farther.
    for (HalfedgeId h = topology_.twin(border);; h = topology_.twin(next(h))) {
      const TriangleId t = triangle_of(h);
      if (is_layered(t)) return walk;
      const PatchId patch = surface_.triangle_patch[t];
      if (!walk.patches.empty() && patch != walk.patches.back()) walk.changes.push_back(topology_.twin(h));
      if (walk.patches.empty() || patch != walk.patches.back()) walk.patches.push_back(patch);
    }
  }

  void hold_border() {
    domain_.constraints.vertex.resize(wall_.mesh.n_vertices());
    for (const LayerBorderEdge& edge : domain_.border)
      if (std::ranges::none_of(domain_.adjacent, [&](const AdjacentPatch& end) { return end.patch == edge.patch; }))
        domain_.adjacent.push_back({.patch = edge.patch});
    std::sort(domain_.adjacent.begin(), domain_.adjacent.end(), [](const AdjacentPatch& a, const AdjacentPatch& b) { return a.patch < b.patch; });
    make_surfaces();

    std::vector<BorderWalk> walks;
    std::vector<VertexId> vertices;  // vertices of the surface
    for (const LayerBorderEdge& edge : domain_.border) {
      const HalfedgeId h = surface_halfedge(edge.halfedge);
      walks.push_back(walk_beyond(h));
      vertices.push_back(topology_.from(h));
    }
    Column<VertexId, Vec3> normal(wall_.mesh.n_vertices());
    for (const TriangleId t : wall_.mesh.triangles.ids()) {
      const auto [a, b, c] = corners(wall_.mesh, t);
      for (const VertexId v : wall_.mesh.triangles[t]) normal[v] += area_vector(a, b, c);
    }
    const Column<VertexId, std::uint8_t> is_convex = convex_border();
    for (std::size_t i = 0; i < walks.size(); ++i) {
      const VertexId v = wall_.surface2part[vertices[i]];
      VertexConstraint& constraint = domain_.constraints.vertex[v];
      constraint = constraint_of(walks[i], v, normal[v]);
      if (is_convex[v]) constraint.freedom = Freedom::fixed;
    }
    share_freedoms();
    std::size_t n_fixed_border = 0;
    Point fixed_border;
    for (const VertexId on_surface : vertices) {
      const VertexId v = wall_.surface2part[on_surface];
      if (domain_.constraints.vertex[v].freedom != Freedom::fixed) continue;
      ++n_fixed_border;
      fixed_border = wall_.mesh.points[v];
    }
    if (n_fixed_border > 0)
      context_.warn("no layer at " + std::to_string(n_fixed_border) +
                    " vertices of the layer boundary: more than two patches without layers meet the wall there, or the layer would leave the adjacent patch "
                    "(the wall ends at an outer edge, as at a slip wall, or at a patch with a rule layers = 0); one vertex is at " +
                    format_point(fixed_border));
    for (std::size_t i = 0; i < walks.size(); ++i) add_chain(walks[i], vertices[i]);
    mark_near();
  }

  /// Finds the layer boundary vertices at which the wall turns away from the patch beyond, so that there is fluid on both sides of the side face of the layer.
  Column<VertexId, std::uint8_t> convex_border() const {
    Column<VertexId, std::uint8_t> is_convex(wall_.mesh.n_vertices(), 0);
    for (const LayerBorderEdge& edge : domain_.border) {
      const HalfedgeId h = surface_halfedge(edge.halfedge);
      if (!is_open_border(surface_, topology_, h)) continue;
      is_convex[wall_.surface2part[topology_.from(h)]] = is_convex[wall_.surface2part[topology_.to(h)]] = 1;
    }
    return is_convex;
  }

  HalfedgeId surface_halfedge(HalfedgeId of_wall) const { return halfedge(wall_.part2surface[triangle_of(of_wall)], corner_of(of_wall)); }

  const AdjacentPatch& end_of(PatchId surface_patch) const {
    const PatchId patch = outer_.patch2part[surface_patch];
    return *std::ranges::find_if(domain_.adjacent, [&](const AdjacentPatch& end) { return end.patch == patch; });
  }
  bool is_end(PatchId surface_patch) const {
    const PatchId patch = outer_.patch2part[surface_patch];
    return std::ranges::any_of(domain_.adjacent, [&](const AdjacentPatch& end) { return end.patch == patch; });
  }

  void make_surfaces() {
    Box walls;
    for (const Point& p : wall_.mesh.points) walls.add(p);
    const Point middle = walls.center();
    const double length = walls.longest_side();
    const auto tolerance_at = [&](const Point& p) { return k_border_tolerance * (length + distance(p, middle)); };
    for (AdjacentPatch& end : domain_.adjacent) {
      const PatchVertices vertices(outer_.mesh, end.patch);
      const FlatFit flat = vertices.fit(tolerance_at);
      end.surface = static_cast<std::int32_t>(domain_.constraints.surfaces.size());
      const Patch& patch = outer_.mesh.patches[end.patch];
      if (flat.is_flat) {
        const auto plane = std::make_shared<ConstraintPlane>(flat.point, flat.normal);
        domain_.constraints.surfaces.push_back(plane);
        snap(vertices.vertices(), *plane);
      } else if (patch.kind == PatchKind::symmetry) {
        char text[120];
        std::snprintf(text, sizeof text, "%.3g m from its mean plane, limit %.3g m", flat.distance, tolerance_at(outer_.mesh.points[flat.farthest]));
        ErrorInfo info = error(ErrorCode::bad_argument, "the symmetry patch \"" + patch.name + "\" is not flat: a vertex is " + text,
                               "a symmetry patch must lie in one plane; make it a slip wall (patches = { [\"" + patch.name +
                                   "\"] = { kind = \"slip\" } }) if it is curved on purpose");
        info.locations.push_back({outer_.mesh.points[flat.farthest], "farthest vertex of " + patch.name});
        throw Error(std::move(info));
      } else {
        TriMesh curved = part_of(outer_.mesh, [&](TriangleId t) { return outer_.mesh.triangle_patch[t] == end.patch; }).mesh;
        domain_.constraints.surfaces.push_back(std::make_shared<ConstraintTriangles>(std::move(curved), context_));
      }
    }
  }

  /// Moves vertices on several planes until they lie on all of them. For axis-parallel planes one step is sufficient.
  void snap(const std::vector<VertexId>& vertices, const ConstraintPlane& plane) {
    for (const VertexId v : vertices) outer_.mesh.points[v] = plane.closest(outer_.mesh.points[v]);
    for (const VertexId v : surface_.points.ids()) {
      const VertexId on_wall = wall_.surface2part[v], on_outer = outer_.surface2part[v];
      if (on_wall.is_valid() && on_outer.is_valid()) wall_.mesh.points[on_wall] = outer_.mesh.points[on_outer];
    }
  }

  VertexConstraint constraint_of(const BorderWalk& walk, VertexId v, const Vec3& normal) const {
    VertexConstraint constraint;
    const AdjacentPatch& first = end_of(walk.patches.front());
    const ConstraintSurface& surface = *domain_.constraints.surfaces[static_cast<std::size_t>(first.surface)];
    const bool is_plane = dynamic_cast<const ConstraintPlane*>(&surface) != nullptr;
    const Point& p = wall_.mesh.points[v];
    constraint.on[0] = first.surface;
    constraint.axis = surface.normal(p);
    constraint.freedom = is_plane ? Freedom::plane : Freedom::surface;
    if (walk.patches.size() == 1) return constraint;
    constraint.freedom = Freedom::fixed;
    if (walk.patches.size() > 2) return constraint;
    const AdjacentPatch& second = end_of(walk.patches.back());
    constraint.on[1] = second.surface;
    if (constraint.on[0] > constraint.on[1]) std::swap(constraint.on[0], constraint.on[1]);
    const ConstraintSurface& other = *domain_.constraints.surfaces[static_cast<std::size_t>(second.surface)];
    const HalfedgeId h = walk.changes.front();
    Vec3 line = normalized(outer_.mesh.points[outer_.surface2part[topology_.to(h)]] - p);
    const Vec3 meet = cross(surface.normal(p), other.normal(p));
    if (is_plane && dynamic_cast<const ConstraintPlane*>(&other) && norm(meet) > k_chain_sine)
      line = dot(meet, line) > 0.0 ? normalized(meet) : -normalized(meet);
    constraint.axis = line;
    if (dot(line, normalized(normal)) > k_forward_cosine) constraint.freedom = Freedom::line;
    return constraint;
  }

  /// Returns the half-edges at v between two different patches without layers, of which at least one is `patch`.
  std::vector<HalfedgeId> changes_at(VertexId v) const {
    std::vector<HalfedgeId> found;
    for (const HalfedgeId h : topology_.outgoing(v)) {
      const TriangleId left = triangle_of(h), right = triangle_of(topology_.twin(h));
      if (surface_.triangle_patch[left] != surface_.triangle_patch[right]) found.push_back(h);
    }
    return found;
  }

  void add_chain(const BorderWalk& walk, VertexId start) {
    const VertexId on_wall = wall_.surface2part[start];
    if (domain_.constraints.vertex[on_wall].freedom != Freedom::line) return;
    HalfedgeId h = walk.changes.front();
    const PatchId left = surface_.triangle_patch[triangle_of(h)], right = surface_.triangle_patch[triangle_of(topology_.twin(h))];
    EndChain chain{{outer_.surface2part[start]}, false, outer_.patch2part[left], outer_.patch2part[right]};
    for (;;) {
      const VertexId v = topology_.to(h);
      chain.outer.push_back(outer_.surface2part[v]);
      if (wall_.surface2part[v].is_valid()) {
        chain.ends_on_wall = domain_.constraints.vertex[wall_.surface2part[v]].freedom == Freedom::line;
        break;
      }
      const std::vector<HalfedgeId> changes = changes_at(v);
      if (changes.size() != 2) break;
      const HalfedgeId on = topology_.to(changes[0]) == topology_.from(h) ? changes[1] : changes[0];
      if (surface_.triangle_patch[triangle_of(on)] != left || surface_.triangle_patch[triangle_of(topology_.twin(on))] != right) break;
      h = on;
      if (topology_.from(h) == start) break;
    }
    // A chain between two growth lines is the same from both ends. Only the chain from the lower vertex is stored.
    if (chain.ends_on_wall && domain_.constraints.vertex[wall_.surface2part[topology_.to(h)]].freedom == Freedom::line && topology_.to(h) < start) return;
    domain_.chains.push_back(std::move(chain));
  }

  /// Marks vertices from which a layer can reach an adjacent patch along the wall. A plane of symmetry affects all vertices.
  void mark_near() {
    domain_.constraints.near.assign(wall_.mesh.n_vertices(), 0);
    const WallReach reach(wall_.mesh);
    for (const AdjacentPatch& end : domain_.adjacent) {
      if (outer_.mesh.patches[end.patch].kind == PatchKind::symmetry) {
        for (std::uint64_t& mask : domain_.constraints.near) mask |= end.surface < k_max_masked ? std::uint64_t{1} << end.surface : 0;
        continue;
      }
      std::vector<VertexId> from;
      for (const VertexId v : domain_.constraints.vertex.ids())
        if (domain_.constraints.vertex[v].is_on(static_cast<std::size_t>(end.surface))) from.push_back(v);
      reach.mark(from, end.surface, {}, domain_.constraints.near);
    }
  }

  const TriMesh& surface_;
  const Column<PatchId, std::uint8_t>& has_layer_;
  std::span<const PeriodicPatches> periodic_;
  const RunContext& context_;
  Topology topology_;
  Part wall_, outer_;
  Domain domain_;
};

}  // namespace

Domain split_domain(const TriMesh& surface, const Column<PatchId, std::uint8_t>& has_layer, const RunContext& context,
                    std::span<const PeriodicPatches> periodic) {
  return DomainSplitter(surface, has_layer, periodic, context).split();
}

}  // namespace sterna::volmesh
