#include "volmesh/domain/sheeted_boundary.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "geom/base/error.h"

namespace sterna::volmesh {
namespace {

constexpr double k_given_plane = 1e-6;  ///< fraction of the body length: a given symmetry patch within this distance of a plane lies in the plane

/// A given symmetry patch that is left out and re-meshed.
struct LeftOut {
  PatchId patch;
  std::size_t axis;
  double at;  ///< m
};

std::optional<LeftOut> in_plane(const TriMesh& mesh, PatchId patch) {
  Box box;
  for (const TriangleId t : mesh.triangles.ids())
    if (mesh.triangle_patch[t] == patch)
      for (const Point& p : corners(mesh, t)) box.add(p);
  if (box.empty()) return std::nullopt;
  const double tolerance = k_given_plane * body_length(mesh);
  for (std::size_t k = 0; k < 3; ++k)
    if (box.max[k] - box.min[k] <= tolerance) return LeftOut{patch, k, std::abs(box.min[k]) <= tolerance ? 0.0 : box.min[k]};
  return std::nullopt;
}

/// The user's triangles without those in symmetry planes. Vertices are in the order of the boundary.
struct UserPart {
  TriMesh mesh;
  std::vector<TriangleId> triangles;  ///< numbers of the triangles in the boundary
  std::vector<LeftOut> left_out;
  Column<VertexId, VertexId> partner;  ///< partner of each vertex on another periodic side, if it has one
};

UserPart user_part(const TriMesh& complete, std::size_t n_given, const SliverSplits& slivers, std::span<const PeriodicPatches> periodic) {
  UserPart part;
  part.mesh.patches = complete.patches;
  Column<VertexId, VertexId> number(complete.n_vertices());
  Column<VertexId, std::uint8_t> is_used(complete.n_vertices(), 0);
  Column<PatchId, std::uint8_t> has_given(complete.patches.size(), 0);
  const auto is_given = [&](TriangleId t) { return (slivers.sources.empty() ? t : slivers.sources[t]).index() < n_given; };
  for (const TriangleId t : complete.triangles.ids())
    if (is_given(t)) has_given[complete.triangle_patch[t]] = 1;
  for (const PatchId p : complete.patches.ids())
    if (complete.patches[p].kind == PatchKind::symmetry && has_given[p])
      if (const std::optional<LeftOut> plane = in_plane(complete, p)) part.left_out.push_back(*plane);
  for (const PeriodicPatches& sides : periodic)
    for (const PatchId side : {sides.first, sides.second}) {
      if (!has_given[side]) continue;
      const std::optional<LeftOut> plane = in_plane(complete, side);
      if (!plane)
        throw_bad_argument("making wake sheets", "the periodic side \"" + complete.patches[side].name + "\" is in no plane x, y or z = constant", {},
                           "leave the wakes out, or rotate the model");
      part.left_out.push_back(*plane);
    }
  Column<VertexId, Point> points = complete.points;
  for (const LeftOut& plane : part.left_out)
    for (const TriangleId t : complete.triangles.ids())
      if (complete.triangle_patch[t] == plane.patch)
        for (const VertexId v : complete.triangles[t]) points[v][plane.axis] = plane.at;
  const auto stays = [&](TriangleId t) {
    return is_given(t) && std::ranges::none_of(part.left_out, [&](const LeftOut& plane) { return plane.patch == complete.triangle_patch[t]; });
  };
  for (const TriangleId t : complete.triangles.ids())
    if (stays(t))
      for (const VertexId v : complete.triangles[t]) is_used[v] = 1;
  for (const VertexId v : complete.points.ids())
    if (is_used[v]) number[v] = part.mesh.points.push_back(points[v]);
  for (const TriangleId t : complete.triangles.ids()) {
    if (!stays(t)) continue;
    const TriangleVertices& v = complete.triangles[t];
    part.mesh.triangles.push_back({number[v[0]], number[v[1]], number[v[2]]});
    part.mesh.triangle_patch.push_back(complete.triangle_patch[t]);
    part.triangles.push_back(t);
  }
  part.partner.resize(part.mesh.n_vertices());
  for (const PeriodicPatches& sides : periodic)
    for (const auto& [a, b] : sides.vertices)
      if (is_used[a] && is_used[b]) {
        part.partner[number[a]] = number[b];
        part.partner[number[b]] = number[a];
      }
  // The patches that the completion adds come after the user's own patches.
  std::size_t n_own = complete.patches.size();
  while (n_own > 0 && !has_given[PatchId(n_own - 1)]) --n_own;
  part.mesh.patches.resize(n_own);
  return part;
}

/// Moves the entries that the sheets add behind all entries of the completion.
template <class I, class T>
void move_to_end(Column<I, T>& column, std::size_t begin, std::size_t end) {
  std::vector<T>& values = column.raw();
  std::rotate(values.begin() + static_cast<std::ptrdiff_t>(begin), values.begin() + static_cast<std::ptrdiff_t>(end), values.end());
}

void give_back_patches(const std::vector<LeftOut>& left_out, std::size_t n_before, TriMesh& boundary) {
  for (const LeftOut& plane : left_out)
    for (std::size_t i = n_before; i < boundary.n_triangles(); ++i) {
      const TriangleId t(i);
      if (std::ranges::all_of(corners(boundary, t), [&](const Point& p) { return p[plane.axis] == plane.at; })) boundary.triangle_patch[t] = plane.patch;
    }
}

}  // namespace

SheetedBoundary with_wake_sheets(const TriMesh& complete, std::size_t n_given, const SliverSplits& slivers, std::span<const PeriodicPatches> periodic,
                                 std::span<const WakeSheet> wakes, double first_height, const std::function<TriMesh(const TriMesh&)>& complete_again,
                                 const RunContext& context) {
  UserPart part = user_part(complete, n_given, slivers, periodic);
  SheetsOnWall made = add_wake_sheets(wakes, stream_of(complete), first_height, part.partner, part.mesh, context);
  SheetedBoundary result;
  result.boundary = complete_again(part.mesh);
  give_back_patches(part.left_out, part.mesh.n_triangles(), result.boundary);
  DoubledSheets& sheets = result.sheets = std::move(made.sheets);
  const std::size_t n_vertices = part.mesh.n_vertices(), n_triangles = part.mesh.n_triangles();
  const std::size_t n_own_vertices = sheets.n_given_vertices, n_own_triangles = sheets.n_given_triangles;
  const std::size_t shift = result.boundary.n_vertices() - n_vertices, n_added = n_vertices - n_own_vertices;

  result.slivers.report = slivers.report;
  const std::size_t n_completion = result.boundary.n_triangles() - n_triangles;
  constexpr CornerWeights k_whole = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  const auto keep_source = [&](TriangleId t, bool is_own) {
    result.slivers.sources.push_back(slivers.sources.empty() ? t : slivers.sources[t]);
    result.slivers.weights.push_back(!is_own ? CornerWeights{} : slivers.weights.empty() ? k_whole : slivers.weights[t]);
  };
  for (const TriangleId t : part.triangles) keep_source(t, true);
  for (std::size_t i = 0; i < n_completion; ++i) {
    result.slivers.sources.push_back(TriangleId(n_given + i));
    result.slivers.weights.push_back(k_whole);
  }
  for (const TriangleId t : made.sources) keep_source(part.triangles[t.index()], false);

  const auto moved = [&](VertexId v) {
    if (v.index() < n_own_vertices) return v;
    return v.index() < n_vertices ? VertexId(v.index() + shift) : VertexId(v.index() - n_added);
  };
  move_to_end(result.boundary.points, n_own_vertices, n_vertices);
  move_to_end(result.boundary.triangles, n_own_triangles, n_triangles);
  move_to_end(result.boundary.triangle_patch, n_own_triangles, n_triangles);
  for (TriangleVertices& t : result.boundary.triangles)
    for (VertexId& v : t) v = moved(v);
  for (DoubledSheets::BaseVertex& base_vertex : sheets.base_vertices)
    for (std::array<VertexId, 2>* sides : {&base_vertex.sides, &base_vertex.start})
      for (VertexId& v : *sides) v = moved(v);
  for (VertexId& v : sheets.borders) v = moved(v);
  sheets.n_given_vertices += shift;
  sheets.n_given_triangles += n_completion;
  return result;
}

void hold_sheets(const SheetedBoundary& sheeted, Domain& domain) {
  Column<VertexId, VertexId> number(sheeted.boundary.n_vertices());
  std::size_t n_sheet_triangles = 0;
  for (const TriangleId t : domain.wall.triangles.ids()) {
    const TriangleId on_boundary = domain.wall2surface[t];
    n_sheet_triangles += on_boundary.index() >= sheeted.sheets.n_given_triangles ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k) number[sheeted.boundary.triangles[on_boundary][k]] = domain.wall.triangles[t][k];
  }
  const std::size_t n_added = sheeted.boundary.n_vertices() - sheeted.sheets.n_given_vertices;
  if (n_sheet_triangles != sheeted.boundary.n_triangles() - sheeted.sheets.n_given_triangles)
    throw_bad_argument("making wake sheets", "a trailing edge is on a wall without layers", {},
                       "leave the patch of this wall out of the wake, or give the patch layers");
  domain.sheets = sheeted.sheets;
  domain.sheets.n_given_vertices = domain.wall.n_vertices() - n_added;
  domain.sheets.n_given_triangles = domain.wall.n_triangles() - n_sheet_triangles;
  for (DoubledSheets::BaseVertex& base_vertex : domain.sheets.base_vertices)
    for (std::array<VertexId, 2>* sides : {&base_vertex.sides, &base_vertex.start})
      for (VertexId& v : *sides) v = number[v];
  std::ranges::sort(domain.sheets.base_vertices, {}, [](const DoubledSheets::BaseVertex& base_vertex) { return base_vertex.sides[0]; });
  domain.constraints.vertex.resize(domain.wall.n_vertices());
  for (VertexId& v : domain.sheets.borders) {
    v = number[v];
    domain.constraints.vertex[v].freedom = Freedom::fixed;
  }
  std::ranges::sort(domain.sheets.borders);
}

}  // namespace sterna::volmesh
