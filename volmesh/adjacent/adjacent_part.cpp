// 1. closed_loops   joins edges to loops
// 2. locations_of      determines sizes around edges of the loops, and sizes from the curvature
// 3. mesh_face      meshes with geom/delaunay, in the plane of the part
// 4. prove          checks edges, directions, Euler number and positive areas
#include "volmesh/adjacent/adjacent_part.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "geom/delaunay/face_mesh.h"
#include "geom/math/predicates.h"
#include "volmesh/adjacent/adjacent_errors.h"
#include "volmesh/adjacent/check_adjacent.h"

namespace sterna::volmesh {
namespace {

constexpr double k_size_tolerance = 0.02;  ///< fraction of a size: tolerance at the centre of a circular loop, whose points are all at the same distance
constexpr const char* k_crossing_hint =
    "footprints of layers must not overlap or leave the patch: lower max_thickness of the layers that end here, move the bodies apart, or make the patch "
    "larger";

/// Returns the points that edges use, each once, ascending.
std::vector<std::uint32_t> used_points(std::span<const AdjacentEdge> edges) {
  std::vector<std::uint32_t> used;
  used.reserve(2 * edges.size());
  for (const AdjacentEdge& edge : edges) used.insert(used.end(), edge.begin(), edge.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  return used;
}

/// Rejects different points at the same location, because the triangulation would merge them.
void check_locations(const AdjacentRegion& region, const AdjacentTriangles& result, std::span<const AdjacentEdge> edges) {
  std::vector<std::uint32_t> used = used_points(edges);
  const auto at = [&](std::uint32_t i) -> const Point& { return point_of(region, result, i); };
  std::sort(used.begin(), used.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Point &a = at(i), &b = at(j);
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z != b.z ? a.z < b.z : i < j;
  });
  ErrorInfo info = adjacent_error(region, ErrorCode::self_intersection, "loops touch at points that they do not share");
  for (std::size_t i = 1; i < used.size(); ++i)
    if (at(used[i - 1]) == at(used[i])) info.add_location(at(used[i]), "points " + std::to_string(used[i - 1]) + " and " + std::to_string(used[i]));
  info.hint = k_crossing_hint;
  if (info.n_locations > 0) throw Error(std::move(info));
}

std::vector<SizePoint> locations_of(const AdjacentRegion& region, const AdjacentTriangles& result, const AdjacentPart& part) {
  const std::vector<std::uint32_t> used = used_points(part.edges);
  std::vector<SizePoint> locations(used.size());
  std::vector<double> n(used.size(), 0.0);
  for (const AdjacentEdge& edge : part.edges) {
    const double length = distance(point_of(region, result, edge[0]), point_of(region, result, edge[1]));
    for (const std::uint32_t i : edge) {
      const auto k = static_cast<std::size_t>(std::lower_bound(used.begin(), used.end(), i) - used.begin());
      locations[k].size += length;
      n[k] += 1.0;
    }
  }
  for (std::size_t k = 0; k < used.size(); ++k) {
    locations[k].size /= n[k];
    locations[k].point = point_of(region, result, used[k]);
  }
  locations.insert(locations.end(), part.curvature_sizes.begin(), part.curvature_sizes.end());
  // Within the tolerance the result depends on the order of the size points. Therefore they are sorted independently of the numbers of the points.
  std::ranges::sort(locations, {}, [](const SizePoint& s) { return std::tuple(s.point.x, s.point.y, s.point.z, s.size); });
  return locations;
}

struct PartBorder {
  delaunay::FaceBorder border;
  std::vector<std::uint32_t> point;  ///< point of each vertex, for all loops in order
};

PartBorder border_of(const AdjacentRegion& region, const AdjacentTriangles& result, const AdjacentPart& part) {
  PartBorder border;
  for (const std::vector<std::uint32_t>& loop : closed_loops(part.edges)) {
    border.border.loops.emplace_back();
    for (const std::uint32_t i : loop) {
      const Point& p = point_of(region, result, i);
      border.border.loops.back().push_back({part.frame.location(p), p});
      border.point.push_back(i);
    }
  }
  return border;
}

/// Rethrows an error of the mesher as an error of this patch.
[[noreturn]] void throw_for_patch(const AdjacentRegion& region, const Error& error) {
  ErrorInfo info = adjacent_error(region, error.code(), error.info().problem);
  info.locations = error.info().locations;
  info.n_locations = error.info().n_locations;
  info.hint = error.info().hint;
  if (error.code() == ErrorCode::self_intersection) {
    info.problem = "loops cross or touch: " + error.info().problem;
    info.hint = k_crossing_hint;
  }
  throw Error(std::move(info));
}

void prove(const AdjacentRegion& region, const AdjacentPart& part, const AdjacentTriangles& result, std::size_t first_triangle,
           const delaunay::FaceMesh& mesh) {
  const auto location = [&](AdjacentEdge edge) { return 0.5 * (point_of(region, result, edge[0]) + point_of(region, result, edge[1])); };
  const std::span<const std::array<std::uint32_t, 3>> triangles(result.triangles.begin() + static_cast<std::ptrdiff_t>(first_triangle), result.triangles.end());
  const AdjacentCheck check = check_adjacent(part.edges, triangles);
  if (!check.reversed.empty() && check.reversed.size() == part.edges.size()) {
    ErrorInfo info =
        adjacent_error(region, ErrorCode::bad_argument,
                       "all edges have the wrong sense: the region must be on their left, seen against the surface normal that points into the domain");
    info.add_location(location(check.reversed.front()), "for example this edge");
    throw Error(std::move(info));
  }
  if (!check.missing.empty() || !check.open.empty()) {
    ErrorInfo info = adjacent_error(region, ErrorCode::self_intersection, "loops are nested wrongly: a hole within a hole, or outside the outer border");
    for (const AdjacentEdge& edge : check.missing) info.add_location(location(edge), "the region is not on the left of this edge");
    for (const AdjacentEdge& edge : check.open) info.add_location(location(edge), "the region would end here");
    info.hint = k_crossing_hint;
    throw Error(std::move(info));
  }
  ErrorInfo info = adjacent_error(region, ErrorCode::internal,
                                  "the triangulation is invalid: Euler number " + std::to_string(check.euler_number) + " of " +
                                      std::to_string(check.n_components) + " parts with " + std::to_string(check.n_loops) + " borders");
  for (const AdjacentEdge& edge : check.repeated) info.add_location(location(edge), "edge of more than two triangles");
  for (const TriangleVertices& t : mesh.triangles) {
    const auto at = [&](VertexId v) { return Vec2{mesh.uv[v.index()].u, mesh.uv[v.index()].v}; };
    if (orient2d(at(t[0]), at(t[1]), at(t[2])) <= 0) info.add_location(mesh.points[t[0].index()], "triangle without positive area");
  }
  if (info.n_locations > 0 || !check.is_planar()) throw Error(std::move(info));
}

}  // namespace

const Point& point_of(const AdjacentRegion& region, const AdjacentTriangles& result, std::uint32_t i) {
  return i < region.points.size() ? region.points[i] : result.new_points[i - region.points.size()];
}

void check_closed(const AdjacentRegion& region, const AdjacentTriangles& result, std::span<const AdjacentEdge> edges, ErrorInfo info) {
  std::vector<std::uint32_t> begins, ends;
  for (const AdjacentEdge& edge : edges) {
    begins.push_back(edge[0]);
    ends.push_back(edge[1]);
  }
  std::sort(begins.begin(), begins.end());
  std::sort(ends.begin(), ends.end());
  for (const std::uint32_t i : used_points(edges)) {
    const auto n_begin = std::upper_bound(begins.begin(), begins.end(), i) - std::lower_bound(begins.begin(), begins.end(), i);
    const auto n_end = std::upper_bound(ends.begin(), ends.end(), i) - std::lower_bound(ends.begin(), ends.end(), i);
    if (n_begin != n_end)
      info.add_location(point_of(region, result, i),
                        "point " + std::to_string(i) + ": " + std::to_string(n_end) + " edges end and " + std::to_string(n_begin) + " begin here");
  }
  if (info.n_locations > 0) throw Error(std::move(info));
}

std::vector<std::vector<std::uint32_t>> closed_loops(std::span<const AdjacentEdge> edges) {
  // Edges are sorted by their start. For each start the next edge that is not used yet is taken.
  const std::vector<std::uint32_t> used = used_points(edges);
  const auto number = [&](std::uint32_t i) { return static_cast<std::size_t>(std::lower_bound(used.begin(), used.end(), i) - used.begin()); };
  std::vector<std::size_t> first(used.size() + 1, 0);
  for (const AdjacentEdge& edge : edges) ++first[number(edge[0]) + 1];
  for (std::size_t k = 0; k < used.size(); ++k) first[k + 1] += first[k];
  std::vector<std::size_t> outgoing(edges.size()), fill(first.begin(), first.end() - 1), at(first.begin(), first.end() - 1);
  for (std::size_t e = 0; e < edges.size(); ++e) outgoing[fill[number(edges[e][0])]++] = e;
  std::vector<std::uint8_t> is_taken(edges.size(), 0);
  std::vector<std::vector<std::uint32_t>> loops;
  for (std::size_t start = 0; start < edges.size(); ++start) {
    if (is_taken[start] != 0) continue;
    loops.emplace_back();
    for (std::size_t e = start; is_taken[e] == 0;) {
      is_taken[e] = 1;
      loops.back().push_back(edges[e][0]);
      if (edges[e][1] == edges[start][0]) break;
      std::size_t& cursor = at[number(edges[e][1])];
      while (is_taken[outgoing[cursor]] != 0) ++cursor;
      e = outgoing[cursor];
    }
  }
  return loops;
}

void mesh_part(const AdjacentRegion& region, const AdjacentPart& part, const EndOptions& options, AdjacentTriangles& result, const RunContext& context) {
  if (!part.triangles.empty()) {
    ErrorInfo info = adjacent_error(region, ErrorCode::geometry_failed,
                                    "the footprint of the layers crosses a sharp edge of the patch, or leaves the re-meshed part of the patch");
    info.hint = k_crossing_hint;
    check_closed(region, result, part.edges, std::move(info));
  }
  check_locations(region, result, part.edges);
  const PartBorder border = border_of(region, result, part);
  const SizePointTree grown(locations_of(region, result, part), options.size_growth - 1.0, context);
  const delaunay::SizeFunction size = [&](Uv, const Point& p) {
    const double by_loops = grown.smallest(p, {.tolerance = k_size_tolerance});
    return region.size ? std::min(by_loops, region.size(p)) : by_loops;
  };
  delaunay::FaceMeshOptions face_options;
  face_options.size_growth = options.size_growth - 1.0;
  face_options.min_angle = options.min_angle;
  face_options.max_triangles = options.max_triangles;
  delaunay::FaceMesh mesh;
  try {
    const ParameterBox box = delaunay::box_of(border.border);
    const SurfacePtr surface = part.triangles.empty() ? plane_surface(part.frame, box)
                                                      : projected_surface(part.frame, box, *region.surface, *region.original, part.triangles, context);
    mesh = delaunay::mesh_face(*surface, border.border, size, Vec2{1.0, 1.0}, face_options, context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    throw_for_patch(region, error);
  }
  const std::size_t first_triangle = result.triangles.size(), n_before = region.points.size() + result.new_points.size();
  result.new_points.insert(result.new_points.end(), mesh.points.begin() + mesh.n_border, mesh.points.end());
  result.triangles.reserve(first_triangle + mesh.triangles.size());
  for (const TriangleVertices& t : mesh.triangles) {
    auto& triangle = result.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      triangle[k] = t[k].value() < mesh.n_border ? border.point[t[k].index()] : static_cast<std::uint32_t>(n_before + t[k].index() - mesh.n_border);
  }
  prove(region, part, result, first_triangle, mesh);
  if (mesh.report.min_angle < result.min_angle) {
    result.min_angle = mesh.report.min_angle;
    result.worst_location = mesh.report.worst_location;
  }
}

}  // namespace sterna::volmesh
