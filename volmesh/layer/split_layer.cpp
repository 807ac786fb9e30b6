#include "volmesh/layer/split_layer.h"

#include <algorithm>
#include <type_traits>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "volmesh/envelope/patch_layers.h"
#include "volmesh/tetra/verify.h"

namespace sterna::volmesh {
namespace {

using Origin = BoundarySplits::Origin;

/// Splits on one of the two surfaces that form the boundary of the tetrahedra.
struct SplitPart {
  const TriMesh& mesh;
  std::size_t first_triangle;            ///< number of the first triangle of the surface in the boundary
  std::vector<std::size_t> points = {};  ///< indices in splits.points of the points on this surface
  bool has_triangle(std::size_t t) const { return t >= first_triangle && t < first_triangle + mesh.n_triangles(); }
  TriangleId triangle(const Origin& origin) const { return TriangleId(origin.triangle - first_triangle); }
};

void find_points(const BoundarySplits& splits, SplitPart& part) {
  for (std::size_t i = 0; i < splits.points.size(); ++i)
    if (part.has_triangle(splits.origins[i].triangle)) part.points.push_back(i);
}

/// Returns the sum of weight * value over the corners of a triangle. Values at corners with zero weight are not evaluated.
template <class T, class F>
T mixed(const TriangleVertices& corners, const Origin& origin, T sum, const F& value) {
  for (std::size_t k = 0; k < 3; ++k)
    if (origin.weights[k] != 0.0) sum += origin.weights[k] * value(corners[k]);
  return sum;
}

/// Returns the surface with split triangles. New vertices lie on the old triangles.
TriMesh split_mesh(const SplitPart& part, const BoundarySplits& splits, std::span<const std::uint32_t> node2vertex) {
  const TriMesh& old = part.mesh;
  TriMesh mesh;
  mesh.patches = old.patches;
  mesh.points = old.points;
  for (const std::size_t i : part.points) {
    const Origin& origin = splits.origins[i];
    mesh.points.push_back(mixed(old.triangles[part.triangle(origin)], origin, Point{}, [&](VertexId v) { return old.points[v]; }));
  }
  for (std::size_t t = 0; t < splits.triangles.size(); ++t) {
    if (!part.has_triangle(splits.parents[t])) continue;
    const auto& nodes = splits.triangles[t];
    mesh.triangles.push_back({VertexId(node2vertex[nodes[0]]), VertexId(node2vertex[nodes[1]]), VertexId(node2vertex[nodes[2]])});
    mesh.triangle_patch.push_back(old.triangle_patch[TriangleId(splits.parents[t] - part.first_triangle)]);
  }
  return mesh;
}

/// Returns for each point of the split boundary the vertex on its surface. Old vertices keep their number, and new ones follow in their order.
std::vector<std::uint32_t> vertices_of_nodes(const SplitPart& wall, const SplitPart& outer, const BoundarySplits& splits) {
  const std::size_t n_wall = wall.mesh.n_vertices(), n_old = n_wall + outer.mesh.n_vertices();
  std::vector<std::uint32_t> node2vertex(n_old + splits.points.size());
  for (std::size_t i = 0; i < n_old; ++i) node2vertex[i] = static_cast<std::uint32_t>(i < n_wall ? i : i - n_wall);
  for (const SplitPart* part : {&wall, &outer})
    for (std::size_t i = 0; i < part->points.size(); ++i) node2vertex[n_old + part->points[i]] = static_cast<std::uint32_t>(part->mesh.n_vertices() + i);
  return node2vertex;
}

/// Returns the envelope with the heights and directions of new growth lines, which run from the wall's new vertex to the envelope's new point. A new point is
/// collapsed if all corners with a non-zero weight are collapsed.
Envelope split_envelope(const Envelope& old, const SplitPart& part, const BoundarySplits& splits, const TriMesh& new_wall) {
  Envelope envelope = old;
  for (std::size_t i = 0; i < part.points.size(); ++i) {
    const Origin& origin = splits.origins[part.points[i]];
    const TriangleVertices& corners = part.mesh.triangles[part.triangle(origin)];
    const auto mean = [&](const Column<VertexId, double>& column) { return mixed(corners, origin, 0.0, [&](VertexId v) { return column[v]; }); };
    const double mean_height = mean(old.height);
    const Vec3 line = mean_height > 0.0 ? splits.points[part.points[i]] - new_wall.points[VertexId(part.mesh.n_vertices() + i)]
                                        : mixed(corners, origin, Vec3{}, [&](VertexId v) { return old.direction[v]; });
    const std::size_t nearest = static_cast<std::size_t>(std::ranges::max_element(origin.weights) - origin.weights.begin());
    for_each_column(
        [&](const auto& of_old, auto& column) {
          if constexpr (std::is_same_v<decltype(column), Column<VertexId, double>&>) column.push_back(mean(of_old));
          else column.push_back(of_old[corners[nearest]]);
        },
        old, envelope);
    envelope.direction.raw().back() = normalized(line);
    envelope.height.raw().back() = mean_height > 0.0 ? norm(line) : 0.0;
  }
  return envelope;
}

/// Converts boundary points and splits from the numbers of fill() to the points of the new fill_boundary().
void renumber(const SplitPart& wall, const SplitPart& outer, std::span<const std::uint32_t> node2vertex, TetraResult& tets, const RunContext& context) {
  const std::size_t n_wall = wall.mesh.n_vertices(), n_old = n_wall + outer.mesh.n_vertices();
  std::vector<std::uint8_t> is_outer(node2vertex.size(), 0);
  for (std::size_t i = n_wall; i < n_old; ++i) is_outer[i] = 1;
  for (const std::size_t i : outer.points) is_outer[n_old + i] = 1;
  const auto n_new_wall = static_cast<std::uint32_t>(n_wall + wall.points.size());
  parallel_for(context, tets.tetrahedra.size(), [&](std::size_t i) {
    for (std::uint32_t& v : tets.tetrahedra[i])
      if (v < node2vertex.size()) v = node2vertex[v] + (is_outer[v] ? n_new_wall : 0);
  });
  tets.splits = {};
}

bool is_proven(const FillBoundary& boundary, const TetraResult& tets, const RunContext& context) {
  try {
    verify_tetrahedra({.points = boundary.points, .triangles = boundary.triangles, .hole_points = {}}, tets, context);
    return true;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::tetra_result_invalid) throw;
    context.info("boundary splits: the layer is lower where its prism columns were split, so the tetrahedra are made again (" + error.info().problem + ")");
    return false;
  }
}

}  // namespace

SplitLayer split_layer(const LayerBase& base, const Envelope& envelope, const TriMesh& outer, const MeshCase& options, const TrueSurface& true_surface,
                       TetraResult& tets, const RunContext& context) {
  SplitPart wall_part{base.wall, 0}, outer_part{outer, base.wall.n_triangles()};
  find_points(tets.splits, wall_part);
  find_points(tets.splits, outer_part);
  const std::vector<std::uint32_t> node2vertex = vertices_of_nodes(wall_part, outer_part, tets.splits);

  SplitLayer layer;
  auto wall = std::make_unique<TriMesh>(split_mesh(wall_part, tets.splits, node2vertex));
  if (true_surface) {
    parallel_for(context, wall_part.points.size(), [&](std::size_t i) {
      Point& p = wall->points[VertexId(base.wall.n_vertices() + i)];
      const Origin& origin = tets.splits.origins[wall_part.points[i]];
      p = true_surface(p, wall_part.triangle(origin), origin.weights);
    });
  }
  auto split_outer = std::make_unique<TriMesh>(split_mesh(outer_part, tets.splits, node2vertex));
  for (std::size_t i = 0; i < outer_part.points.size(); ++i) split_outer->points[VertexId(outer.n_vertices() + i)] = tets.splits.points[outer_part.points[i]];
  layer.envelope = split_envelope(envelope, wall_part, tets.splits, *wall);
  layer.wall = std::move(wall);
  layer.outer = std::move(split_outer);
  auto split_base = std::make_unique<LayerBase>(*layer.wall, context);
  split_base->demand = demand_of(*split_base, options.envelope, options.patches, options.first_heights.get(), context);
  split_base->truncation = truncation_by_patches(split_base->wall, options.prisms, options.patches);
  layer.base = std::move(split_base);

  layer.extrusion = extrude_prisms(*layer.base, options.envelope, options.prisms, layer.envelope, context);
  Collider collider(*layer.base, layer.outer.get(), context);
  require_clear_input(collider, context);
  const TestedEnvelope tested = certify_envelope(*layer.base, collider, layer.envelope, context);
  require_proved(tested);
  layer.certificate = tested;
  layer.clear = tested.clear;
  layer.boundary = fill_boundary(*layer.base, layer.extrusion, unlinked(*layer.outer));
  renumber(wall_part, outer_part, node2vertex, tets, context);
  layer.is_filled = is_proven(layer.boundary, tets, context);
  return layer;
}

}  // namespace sterna::volmesh
