#include "volmesh/parts/joint_envelope.h"

#include <algorithm>
#include <string>

#include "geom/base/glob.h"
#include "geom/base/parallel.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/keep_inside.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {
namespace {

Point placed(const PlacedPart& part, VertexId v) { return part.placement == Transform{} ? part.own->points[v] : part.placement.point(part.own->points[v]); }

TriangleVertices shifted(TriangleVertices v, std::size_t by) {
  for (VertexId& corner : v) corner = VertexId(static_cast<std::uint64_t>(corner.index() + by));
  return v;
}

/// Returns the reason why the envelope of the part cannot be made separately; empty if it can be.
std::string objection(const Domain& domain, const PlacedPart& part, const Column<TriangleId, TriangleId>& surface2wall, WholePart& whole) {
  const std::size_t n = part.own->n_triangles();
  if (n == 0 || part.first_triangle + n > surface2wall.size()) return "the surface no longer contains all of the part";
  const TriangleId first = surface2wall[TriangleId(part.first_triangle)];
  for (std::size_t t = 0; t < n; ++t)
    if (const TriangleId on_wall = surface2wall[TriangleId(part.first_triangle + t)];
        !first.is_valid() || on_wall != TriangleId(static_cast<std::uint64_t>(first.index() + t)))
      return "some triangles of the part carry no layers";
  whole.first_triangle = first.index();
  whole.first_vertex = domain.wall.triangles[first][0].index() - part.own->triangles[TriangleId(0)][0].index();
  for (std::size_t t = 0; t < n; ++t)
    if (!(domain.wall.triangles[TriangleId(static_cast<std::uint64_t>(whole.first_triangle + t))] ==
          shifted(part.own->triangles[TriangleId(t)], whole.first_vertex)))
      return "the triangles of the part have other vertices";
  for (const VertexId v : part.own->points.ids())
    if (!(domain.wall.points[VertexId(static_cast<std::uint64_t>(whole.first_vertex + v.index()))] == placed(part, v)))
      return "the points of the part are not at the locations they were moved to";
  return {};
}

/// Returns for each vertex of the wall the number of its whole part, counted from 1; 0: no whole part.
Column<VertexId, std::uint32_t> groups_of(const TriMesh& wall, std::span<const PlacedPart> parts, std::span<const WholePart> whole) {
  Column<VertexId, std::uint32_t> group(wall.n_vertices(), 0);
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (std::size_t v = 0; v < parts[whole[i].part].own->n_vertices(); ++v)
      group[VertexId(static_cast<std::uint64_t>(whole[i].first_vertex + v))] = static_cast<std::uint32_t>(i + 1);
  return group;
}

/// Returns the part in its own frame, with the patches that it has on the wall.
PartEnvelopeTask task_of(const LayerDomain& layer_domain, const WholePart& whole) {
  const PlacedPart& part = layer_domain.options.parts[whole.part];
  PartEnvelopeTask task{.wall = {}, .options = layer_domain.given_envelope, .rules = {}, .smooth_angle = part.smooth_angle};
  task.wall.points = part.own->points;
  task.wall.triangles = part.own->triangles;
  const TriMesh& wall = layer_domain.domain.wall;
  Column<PatchId, PatchId> number(wall.patches.size());
  for (std::size_t t = 0; t < part.own->n_triangles(); ++t) {
    const PatchId patch = wall.triangle_patch[TriangleId(static_cast<std::uint64_t>(whole.first_triangle + t))];
    if (!number[patch].is_valid()) number[patch] = task.wall.patches.push_back(wall.patches[patch]);
    task.wall.triangle_patch.push_back(number[patch]);
  }
  for (const Rule& rule : layer_domain.options.patches)
    if (std::ranges::any_of(task.wall.patches, [&](const Patch& patch) { return matches_glob(patch.name, rule.names); })) task.rules.push_back(rule);
  return task;
}

void resize(Envelope& envelope, std::size_t n) {
  for_each_column([n](auto& column) { column.resize(n); }, envelope);
}

void take(const Envelope& from, VertexId v, const Transform& placement, Envelope& to, VertexId w) {
  for_each_column([&](const auto& one, auto& other) { other[w] = one[v]; }, from, to);
  if (!(placement == Transform{})) to.direction[w] = placement.vector(from.direction[v]);
}

/// The wall without its whole parts, and all input for its envelope.
struct Rest {
  TriMesh wall;
  Column<VertexId, VertexId> rest2wall;
  Column<VertexId, VertexId> wall2rest;
  Constraints constraints;
  LayerDemand demand;
  OuterLinks links;
};

Rest rest_of(const LayerDomain& layer_domain, const Column<VertexId, std::uint32_t>& group) {
  const TriMesh& wall = layer_domain.domain.wall;
  Rest rest;
  rest.wall2rest.resize(wall.n_vertices());
  rest.wall.patches = wall.patches;
  for (const VertexId v : wall.points.ids()) {
    if (group[v] != 0) continue;
    rest.wall2rest[v] = rest.wall.points.push_back(wall.points[v]);
    rest.rest2wall.push_back(v);
  }
  for (const TriangleId t : wall.triangles.ids()) {
    TriangleVertices v = wall.triangles[t];
    if (group[v[0]] != 0) continue;
    for (VertexId& corner : v) corner = rest.wall2rest[corner];
    rest.wall.triangles.push_back(v);
    rest.wall.triangle_patch.push_back(wall.triangle_patch[t]);
  }
  const auto slice = [&](const auto& all, auto& some) {
    if (all.empty()) return;
    for (const VertexId v : rest.rest2wall) some.push_back(all[v]);
  };
  slice(layer_domain.base.constraint, rest.constraints.vertex);
  slice(layer_domain.base.near, rest.constraints.near);
  rest.constraints.surfaces = layer_domain.base.surfaces;
  for_each_column(slice, layer_domain.base.demand, rest.demand);
  rest.links = layer_domain.domain.links;
  for (VertexId& v : rest.links.line)
    if (v.is_valid()) v = rest.wall2rest[v];
  return rest;
}

void add_rest(const LayerDomain& layer_domain, const Column<VertexId, std::uint32_t>& group, Envelope& envelope, const RunContext& context) {
  const Rest rest = rest_of(layer_domain, group);
  if (rest.wall.n_triangles() == 0) return;
  LayerBase base(rest.wall, context, rest.constraints);
  base.demand = rest.demand;
  EnvelopeOptions options = layer_domain.options.envelope;
  if (is_automatic(options.max_thickness)) options.max_thickness = k_default_thickness_share * layer_domain.base.body_length;
  Collider collider(base, &layer_domain.domain.outer, context, &rest.links);
  const Envelope own = build_envelope(base, options, collider, context);
  for (const VertexId v : rest.rest2wall.ids()) take(own, v, {}, envelope, rest.rest2wall[v]);
}

/// Lowers heights until all parts are clear of each other and of their surroundings. Returns the changed vertices, ascending.
std::vector<VertexId> clear_of_each_other(LayerDomain& layer_domain, const Column<VertexId, std::uint32_t>& group, Envelope& envelope,
                                          const RunContext& context) {
  const EnvelopeShape before = envelope;
  keep_inside(layer_domain.base, layer_domain.options.envelope, envelope, context);
  unwarp(layer_domain.base, layer_domain.options.envelope, HeightLimit::warp, envelope, context);
  share_gaps(layer_domain.base, layer_domain.options.envelope, layer_domain.collider, envelope, context, &group);
  retract_collisions(layer_domain.base, layer_domain.options.envelope, layer_domain.collider, envelope, context);
  return difference(before, envelope, context).vertices;
}

}  // namespace

std::vector<WholePart> whole_parts(const Domain& domain, std::span<const PlacedPart> parts, const RunContext& context) {
  if (parts.empty()) return {};
  Column<TriangleId, TriangleId> surface2wall;
  for (const TriangleId t : domain.wall2surface.ids()) {
    const TriangleId on_surface = domain.wall2surface[t];
    if (surface2wall.size() <= on_surface.index()) surface2wall.resize(on_surface.index() + 1);
    surface2wall[on_surface] = t;
  }
  std::vector<WholePart> whole;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!parts[i].own) continue;
    WholePart part{.part = i};
    const std::string reason = objection(domain, parts[i], surface2wall, part);
    if (reason.empty()) whole.push_back(part);
    else context.info("part " + std::to_string(i + 1) + " of the surface: its layer is not made separately and then moved, because " + reason);
  }
  return whole;
}

Envelope joint_envelope(LayerDomain& layer_domain, std::span<const WholePart> parts, const PartEnvelopeMaker& make, const RunContext& context) {
  const Column<VertexId, std::uint32_t> group = groups_of(layer_domain.domain.wall, layer_domain.options.parts, parts);
  Envelope envelope;
  resize(envelope, layer_domain.domain.wall.n_vertices());
  for (const WholePart& whole : parts) {
    const PlacedPart& part = layer_domain.options.parts[whole.part];
    const PartEnvelopeTask task = task_of(layer_domain, whole);
    const PartEnvelope own = make ? make(task, context) : part_envelope(task, context);
    for (const VertexId v : part.own->points.ids())
      take(own.envelope, v, part.placement, envelope, VertexId(static_cast<std::uint64_t>(whole.first_vertex + v.index())));
  }
  add_rest(layer_domain, group, envelope, context);
  const std::vector<VertexId> lowered = clear_of_each_other(layer_domain, group, envelope, context);
  if (!lowered.empty()) {
    context.info("layers of parts are lower than separately made layers at " + std::to_string(lowered.size()) +
                 " vertices, where other parts or the outer boundary are near");
    regrow_clear(layer_domain.base, layer_domain.collider, envelope, context, &lowered);
  }
  seat_on_surfaces(layer_domain.base, layer_domain.options.envelope, &layer_domain.collider, envelope, context);
  return envelope;
}

}  // namespace sterna::volmesh
