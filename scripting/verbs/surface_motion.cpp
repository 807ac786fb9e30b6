#include "scripting/verbs/surface_motion.h"

#include <algorithm>
#include <array>

#include "geom/base/error.h"
#include "geom/mesh/find_crossings.h"
#include "geom/mesh/topology.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/values/summary.h"
#include "scripting/verbs/model_methods.h"
#include "surfmesh/model/join_parts.h"

namespace sterna::scripting {
namespace {

constexpr std::string_view k_surface_move_usage = "wall:move{ 0, 0, 1.5 }";
constexpr std::string_view k_surface_rotate_usage =
    "wall:rotate{ about = {1.2, 0, 0}, pitch = 4*deg, yaw = 2*deg }  or  wall:rotate{ axis = {0, 0, 1}, angle = 30*deg }";
constexpr std::size_t k_named_pairs = 5;    ///< number of locations named by an error
constexpr std::size_t k_most_pairs = 1000;  ///< maximum number of crossings searched

/// Returns the surface as placed parts. If it has no parts, the surface itself is one part.
std::vector<volmesh::PlacedPart> parts_of(const SurfaceValue& surface) {
  if (!surface.parts.empty()) return surface.parts;
  return {{std::make_shared<const TriMesh>(surface.mesh), {}, 0, 0, surface.smooth_angle.value_or(k_automatic)}};
}

void require_apart(const TriMesh& mesh, const RunContext& context) {
  const CrossingPairs found = find_crossings(mesh, context, k_most_pairs);
  if (found.total == 0) return;
  ErrorInfo info{.code = ErrorCode::self_intersection,
                 .attempted = "joining surfaces",
                 .problem = std::to_string(found.total) + " pairs of triangles cross",
                 .hint = "union{ ... } unites surfaces that intersect"};
  info.n_locations = found.total;
  for (std::size_t i = 0; i < std::min(k_named_pairs, found.pairs.size()); ++i) {
    const TriangleId a(found.pairs[i][0]), b(found.pairs[i][1]);
    const auto p = corners(mesh, a);
    info.locations.push_back(
        {(p[0] + p[1] + p[2]) / 3.0, "\"" + mesh.patches[mesh.triangle_patch[a]].name + "\" and \"" + mesh.patches[mesh.triangle_patch[b]].name + "\""});
  }
  throw Error(std::move(info));
}

ScriptValue move_surface(const ScriptCall& call) {
  return std::make_shared<const SurfaceValue>(moved_surface(*self<SurfaceHandle>(call), read_shift(call, k_surface_move_usage)));
}
ScriptValue rotate_surface(const ScriptCall& call) {
  return std::make_shared<const SurfaceValue>(moved_surface(*self<SurfaceHandle>(call), read_turn(call, k_surface_rotate_usage)));
}

constexpr std::array<ScriptVerb, 2> k_motions = {{
    {"surface:move", k_surface_move_usage, "Returns a copy of the surface, moved by a vector in metres.", move_surface, nullptr, true, "surface"},
    {"surface:rotate", k_surface_rotate_usage, "Returns the surface rotated: x points aft, y to starboard, z up.", rotate_surface, rotate_help, true,
     "surface"},
}};

}  // namespace

SurfaceValue moved_surface(const SurfaceValue& surface, const Transform& motion) {
  SurfaceValue moved = surface;
  moved.parts = parts_of(surface);
  if (surface.true_surface.wall) moved.true_surface.wall = std::make_shared<const surfmesh::ModelWall>(*surface.true_surface.wall, motion);
  if (moved.mesh_report) move_locations(motion, *moved.mesh_report);
  // The motion starts from the part's own frame each time, so that two motions have the same rounding as one.
  for (volmesh::PlacedPart& part : moved.parts) {
    part.placement = motion * part.placement;
    Column<VertexId, Point> points = part.own->points;
    surfmesh::move_points(part.placement, points);
    for (const VertexId v : points.ids()) moved.mesh.points[VertexId(static_cast<std::uint64_t>(part.first_vertex + v.index()))] = points[v];
  }
  return moved;
}

SurfaceValue side_by_side(std::span<const SurfaceHandle> surfaces, const RunContext& context) {
  if (surfaces.size() == 1) return *surfaces.front();
  SurfaceValue all;
  all.smooth_angle = 0.0;
  for (const SurfaceHandle& surface : surfaces) {
    const auto first_triangle = static_cast<std::uint32_t>(all.mesh.n_triangles()), first_vertex = static_cast<std::uint32_t>(all.mesh.n_vertices());
    for (volmesh::PlacedPart part : parts_of(*surface)) {
      part.first_triangle += first_triangle;
      part.first_vertex += first_vertex;
      all.parts.push_back(std::move(part));
    }
    append(all.mesh, surface->mesh);
    all.report.n_triangles_read += surface->report.n_triangles_read;
    all.report.n_vertices_read += surface->report.n_vertices_read;
    all.inputs.insert(all.inputs.end(), surface->inputs.begin(), surface->inputs.end());
    all.layers.insert(all.layers.end(), surface->layers.begin(), surface->layers.end());
    inherit(all.history, surface->history);
    if (!surface->smooth_angle) all.smooth_angle.reset();
    else if (all.smooth_angle) all.smooth_angle = std::max(*all.smooth_angle, *surface->smooth_angle);
  }
  require_apart(all.mesh, context);
  const Topology topology(all.mesh, context);
  all.report.n_components = static_cast<std::int64_t>(connected_components(all.mesh, topology).count);
  all.report.is_closed = topology.n_boundary_halfedges() == 0;
  context.info("joined surfaces: " + describe(all));
  return all;
}

std::span<const ScriptVerb> surface_motions() { return k_motions; }

}  // namespace sterna::scripting
