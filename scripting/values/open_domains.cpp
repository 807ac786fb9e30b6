#include "scripting/values/open_domains.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/topology.h"
#include "scripting/values/summary.h"
#include "volmesh/domain/complete_boundary.h"

namespace sterna::scripting {
namespace {

constexpr double k_full_opening = 0.35;    ///< fraction of the surface's longest side in the plane; if the opening is smaller, it is a hole in a body
constexpr double k_opening_at_zero = 0.1;  ///< the same fraction for a plane through the origin
constexpr double k_most_covered = 0.1;     ///< fraction of the area of the opening's box; if more is covered, it is a face with a hole and no opening
constexpr double k_longest_section = 4.0;  ///< distance of two parallel end planes, relative to the width of the opening; if it is larger, the surface is a
                                           ///< tube
constexpr double k_sheet_vector = 0.6;     ///< fraction of the area; the area vectors of a sheet add up to more than this fraction, those of half a sphere to
                                           ///< 0.5
constexpr double k_main_part = 0.5;        ///< fraction of the total area that the main part must have

std::string plane_text(const volmesh::OpenBorderPlane& plane) { return fmt::format("{} = {:.6g} m", "xyz"[plane.axis], plane.at); }

bool is_opening(const volmesh::OpenBorderPlane& plane, const Box& box) {
  double widest = 0.0, body = 0.0, area = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (k == plane.axis) continue;
    const double side = plane.border.max[k] - plane.border.min[k];
    widest = std::max(widest, side);
    body = std::max(body, box.max[k] - box.min[k]);
    area *= side;
  }
  return widest >= (plane.at == 0.0 ? k_opening_at_zero : k_full_opening) * body && plane.covered <= k_most_covered * area;
}

/// Returns true if two parallel planes are so far apart that the surface between them is a tube.
bool is_tube(const std::vector<volmesh::OpenBorderPlane>& planes) {
  for (const volmesh::OpenBorderPlane& a : planes)
    for (const volmesh::OpenBorderPlane& b : planes) {
      if (a.axis != b.axis || a.at >= b.at) continue;
      double widest = 0.0;
      for (std::size_t k = 0; k < 3; ++k)
        if (k != a.axis) widest = std::max(widest, a.border.max[k] - a.border.min[k]);
      if (b.at - a.at > k_longest_section * widest) return true;
    }
  return false;
}

}  // namespace

std::optional<std::string> ends_in_planes(const TriMesh& mesh, const RunContext& context) {
  std::vector<volmesh::OpenBorderPlane> planes;
  try {
    planes = volmesh::open_border_planes_of(mesh, context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    return std::nullopt;
  }
  std::array<int, 3> n_across{};
  for (const volmesh::OpenBorderPlane& plane : planes) ++n_across[plane.axis];
  const bool is_between_four = std::ranges::count(n_across, 2) > 1;
  const Box box = bounding_box(mesh);
  if (planes.empty() || planes.size() > 3 || is_between_four || is_tube(planes)) return std::nullopt;
  if (!std::ranges::all_of(planes, [&](const volmesh::OpenBorderPlane& plane) { return is_opening(plane, box); })) return std::nullopt;
  std::string text = "the surface is open, and all its open boundaries lie in the " + std::string(planes.size() == 1 ? "plane " : "planes ");
  for (std::size_t i = 0; i < planes.size(); ++i) text += (i == 0 ? "" : i + 1 == planes.size() ? " and " : ", ") + plane_text(planes[i]);
  return text + ": the domain ends there in symmetry planes, unless farfield_sides or periodic define other kinds; to close the surface instead, use repair";
}

std::optional<std::string> is_open_sheet(const TriMesh& mesh, const RunContext& context) {
  std::optional<Topology> topology;
  try {
    topology.emplace(mesh, context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    return std::nullopt;
  }
  if (topology->n_boundary_halfedges() == 0) return std::nullopt;
  const Components components = connected_components(mesh, *topology);
  std::vector<double> area(components.count, 0.0);
  std::vector<Vec3> sum(components.count);
  std::vector<char> is_open(components.count, 0);
  std::vector<Box> boxes(components.count);
  double all = 0.0;
  for (const TriangleId t : mesh.triangles.ids()) {
    const std::uint32_t c = components.component[t];
    const auto k = corners(mesh, t);
    area[c] += triangle_area(k[0], k[1], k[2]);
    all += triangle_area(k[0], k[1], k[2]);
    sum[c] += area_vector(k[0], k[1], k[2]);
    for (const Point& p : k) boxes[c].add(p);
    for (int side = 0; side < 3; ++side) is_open[c] |= static_cast<char>(topology->is_boundary(halfedge(t, side)));
  }
  const auto largest = static_cast<std::size_t>(std::ranges::max_element(area) - area.begin());
  if (!is_open[largest] || area[largest] < k_main_part * all || norm(sum[largest]) < k_sheet_vector * area[largest]) return std::nullopt;
  const Box& box = boxes[largest];
  return fmt::format(
      "the surface is an open sheet of {:.4g} m2 from {} to {}, without sides and a lid: the fluid has no boundary there. Wrapping makes a closed body with "
      "fluid on both sides. For flow on one side (terrain, a floor), --farfield \"box floor=PATCH\" adds sides and a lid; or give sides and a lid, and --fluid "
      "inside",
      area[largest], format_point(box.min), format_point(box.max));
}

SurfaceValue with_floor_upwards(const SurfaceValue& wall, const std::string& floor, const RunContext& context) {
  const Topology topology(wall.mesh, context);
  const Components components = connected_components(wall.mesh, topology);
  std::vector<char> is_open(components.count, 0);
  Vec3 sum;
  for (const TriangleId t : wall.mesh.triangles.ids())
    for (int side = 0; side < 3; ++side) is_open[components.component[t]] |= static_cast<char>(topology.is_boundary(halfedge(t, side)));
  for (const TriangleId t : wall.mesh.triangles.ids()) {
    const auto k = corners(wall.mesh, t);
    if (is_open[components.component[t]] != 0) sum += area_vector(k[0], k[1], k[2]);
  }
  const std::array along = {sum.x, sum.y, sum.z};
  const double most = *std::ranges::max_element(along, {}, [](double x) { return std::abs(x); });
  if (most >= 0.0) return wall;
  SurfaceValue turned = wall;
  for (const TriangleId t : wall.mesh.triangles.ids())
    if (is_open[components.component[t]] != 0) std::swap(turned.mesh.triangles[t][1], turned.mesh.triangles[t][2]);
  turned.true_surface = {};  // its triangles have another orientation
  turned.parts.clear();
  const std::string text = "the floor \"" + floor + "\" had normals pointing downwards: its orientation is reversed, because the fluid is above the floor";
  context.info("surface: " + text);
  turned.report.messages.push_back(text);
  turned.history.push_back({.changes = {"turned: " + text}});
  return turned;
}

SurfaceValue as_body(const SurfaceValue& wall, bool has_farfield, const RunContext& context) {
  if (!has_farfield || wall.report.is_closed || wall.options.fluid == "inside") return wall;
  SurfaceValue turned = wall;
  const std::int64_t n = volmesh::turn_to_bodies(turned.mesh, context);
  if (n == 0) return wall;
  turned.true_surface = {};  // its triangles have another orientation
  turned.parts.clear();
  const std::string text = fmt::format("reversed {} open {} with inward normals: inside a farfield the normals must point out of {}", count_text(n),
                                       n == 1 ? "part" : "parts", n == 1 ? "it" : "them");
  context.warn("surface: " + text + "; if the surface encloses the fluid, give no farfield");
  turned.report.messages.push_back(text);
  turned.history.push_back({.changes = {"turned: " + text}});
  return turned;
}

}  // namespace sterna::scripting
