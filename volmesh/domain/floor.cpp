// 1. require_sheet: determines which parts are open, and checks that they match farfield_floor.
// 2. up_of: determines the vertical axis from the area vector of the sheet.
// 3. box_above: determines the sides and the lid.
// 4. snap_border: moves open-boundary vertices into the sides.
#include "volmesh/domain/floor.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "geom/mesh/bvh.h"
#include "volmesh/case/ignored_requests.h"
#include "volmesh/domain/flatten_borders.h"
#include "volmesh/domain/shape_sizes.h"

namespace sterna::volmesh {
namespace {

constexpr const char* k_floor_attempt = "making the box above the floor";
constexpr double k_default_lid = 0.5;  ///< height of the lid above the highest point, as a fraction of the longest horizontal side

/// Returns 1 for components that are open. \throws unless these contain the patches of farfield_floor, and no other part is open
std::vector<std::uint8_t> require_sheet(const TriMesh& mesh, const Topology& topology, const Components& components, const std::string& floor) {
  std::vector<std::uint8_t> is_open(components.count, 0), is_floor(components.count, 0);
  std::vector<TriangleId> open_at(components.count);
  bool is_named = false;
  for (const TriangleId t : mesh.triangles.ids()) {
    const std::uint32_t c = components.component[t];
    for (int k = 0; k < 3; ++k) {
      if (!topology.is_boundary(halfedge(t, k))) continue;
      is_open[c] = 1;
      open_at[c] = t;
    }
    if (!matches_glob(mesh.patches[mesh.triangle_patch[t]].name, floor)) continue;
    is_named = true;
    is_floor[c] = 1;
  }
  if (!is_named) {
    std::string names;
    for (const Patch& patch : mesh.patches) names += (names.empty() ? "\"" : ", \"") + patch.name + "\"";
    throw_bad_argument(k_floor_attempt, "the surface has no patch \"" + floor + "\"", {},
                       "set farfield_floor to the name of the open floor surface; the patches are " + names);
  }
  ErrorInfo closed{.code = ErrorCode::bad_argument,
                   .attempted = k_floor_attempt,
                   .problem = "patch \"" + floor + "\" is not part of an open floor surface: its surface is closed",
                   .hint = "leave the floor out: a closed surface needs no sides (fluid = \"inside\" for a domain, a farfield around bodies)"};
  ErrorInfo other{
      .code = ErrorCode::open_surface, .attempted = k_floor_attempt, .hint = "close this part, or add its patches to the pattern of farfield_floor"};
  bool has_sheet = false;
  for (std::uint32_t c = 0; c < components.count; ++c) {
    has_sheet |= is_open[c] != 0 && is_floor[c] != 0;
    if (is_open[c] == 0 || is_floor[c] != 0) continue;
    ++other.n_locations;
    if (other.locations.size() < k_max_locations) other.locations.push_back({corners(mesh, open_at[c])[0], "an open part that is not the floor"});
  }
  if (!has_sheet) throw Error(std::move(closed));
  other.problem = std::to_string(other.n_locations) + " open parts have no patch \"" + floor + "\"";
  if (other.n_locations > 0) throw Error(std::move(other));
  return is_open;
}

std::size_t up_of(const TriMesh& mesh, const Components& components, const std::vector<std::uint8_t>& is_open) {
  Vec3 sum;
  TriangleId first(0);
  for (const TriangleId t : mesh.triangles.ids()) {
    if (is_open[components.component[t]] == 0) continue;
    const auto [a, b, c] = corners(mesh, t);
    sum += area_vector(a, b, c);
    first = t;
  }
  std::size_t up = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(sum[k]) > std::abs(sum[up])) up = k;
  if (sum[up] < 0.0)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = k_floor_attempt,
                 .problem = std::string("the normals of the floor point downwards, along -") + "xyz"[up] + ", away from the fluid above it",
                 .locations = {{corners(mesh, first)[0], "a triangle of the floor"}},
                 .hint = "reverse the triangles of the floor; volume_mesh does this automatically"});
  return up;
}

std::vector<std::array<VertexId, 2>> floor_border_of(const Topology& topology) {
  std::vector<std::array<VertexId, 2>> edges;
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (topology.is_boundary(h)) edges.push_back({topology.from(h), topology.to(h)});
  }
  return edges;
}

Box box_above(const TriMesh& mesh, const std::vector<std::array<VertexId, 2>>& border, std::size_t up, const FarfieldOptions& options) {
  Box box, of_border;
  for (const auto& [from, to] : border) of_border.add(mesh.points[from]);
  const Box all = bounding_box(mesh);
  const std::array from = {options.farfield_from_x, options.farfield_from_y, options.farfield_from_z},
                   to = {options.farfield_to_x, options.farfield_to_y, options.farfield_to_z};
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (k == up) continue;
    box.min[k] = is_automatic(from[k]) ? of_border.min[k] : from[k];
    box.max[k] = is_automatic(to[k]) ? of_border.max[k] : to[k];
    longest = std::max(longest, box.max[k] - box.min[k]);
  }
  box.min[up] = all.min[up];
  box.max[up] = is_automatic(to[up]) ? all.max[up] + k_default_lid * longest : to[up];
  const double margin = k_shape_margin * body_length(mesh);
  if (!is_automatic(from[up]) && from[up] > all.min[up] + margin) {
    const Point lowest = *std::ranges::min_element(mesh.points, {}, [&](const Point& p) { return p[up]; });
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = k_floor_attempt,
                 .problem = std::string("the box begins at ") + "xyz"[up] + " = " + in_metres(from[up]) + ", above the lowest point of the floor at " +
                            in_metres(all.min[up]),
                 .locations = {{lowest, "the lowest point"}},
                 .hint = "lower the corner farfield_from: the fluid begins at the floor, also where the corner is lower"});
  }
  if (box.max[up] >= all.max[up] + margin) return box;
  const Point highest = *std::ranges::max_element(mesh.points, {}, [&](const Point& p) { return p[up]; });
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = k_floor_attempt,
               .problem = std::string("the lid at ") + "xyz"[up] + " = " + in_metres(box.max[up]) + " is less than " + in_metres(margin) +
                          " above the highest point of the surface at " + in_metres(all.max[up]),
               .locations = {{highest, "the highest point"}},
               .hint = "raise the upper corner of the box"});
}

std::string side_name(const EndPlane& side) { return k_box_sides[2 * side.axis + (side.inward < 0.0 ? 1 : 0)]; }

double off(const Point& p, const EndPlane& side) { return std::abs(p[side.axis] - side.at); }

/// Returns the location of an open-boundary edge that lies in none of the sides: the end of the edge that is farther from its nearest side, or either end if
/// each end lies in another side.
ErrorLocation location_off(const TriMesh& mesh, const std::array<VertexId, 2>& edge, const std::array<EndPlane, 4>& sides) {
  const auto nearest = [&](const Point& p) { return *std::ranges::min_element(sides, {}, [&](const EndPlane& side) { return off(p, side); }); };
  Point worst = mesh.points[edge[0]];
  if (const Point& other = mesh.points[edge[1]]; off(other, nearest(other)) > off(worst, nearest(worst))) worst = other;
  const EndPlane side = nearest(worst);
  return {worst, "the border of the floor is " + in_metres(off(worst, side)) + " from the nearest side, " + side_name(side) + " at " + "xyz"[side.axis] +
                     " = " + in_metres(side.at)};
}

void snap_border(const std::vector<std::array<VertexId, 2>>& border, const std::array<EndPlane, 4>& sides, const std::string& floor, TriMesh& mesh) {
  const double tolerance = k_flat_border * body_length(mesh);
  ErrorInfo info{.code = ErrorCode::open_surface,
                 .attempted = k_floor_attempt,
                 .hint = "cut the floor along the sides of the box, or place the box corners at the corners of the floor; close holes of the floor"};
  for (const std::array<VertexId, 2>& edge : border) {
    const bool is_in_side = std::ranges::any_of(
        sides, [&](const EndPlane& side) { return off(mesh.points[edge[0]], side) <= tolerance && off(mesh.points[edge[1]], side) <= tolerance; });
    if (is_in_side) continue;
    ++info.n_locations;
    if (info.locations.size() < k_max_locations) info.locations.push_back(location_off(mesh, edge, sides));
  }
  info.problem = std::to_string(info.n_locations) + " of " + std::to_string(border.size()) + " border edges of the floor \"" + floor +
                 "\" lie in none of the vertical sides of the box; the limit is " + in_metres(tolerance);
  if (info.n_locations > 0) throw Error(std::move(info));
  const Column<VertexId, Point> before = mesh.points;
  for (const std::array<VertexId, 2>& edge : border)
    for (const VertexId v : edge)
      for (const EndPlane& side : sides)
        if (off(before[v], side) <= tolerance) mesh.points[v][side.axis] = side.at;
  for (const TriangleId t : mesh.triangles.ids()) {
    const TriangleVertices& v = mesh.triangles[t];
    const auto [a, b, c] = corners(mesh, t);
    if (mesh.points[v[0]] == before[v[0]] && mesh.points[v[1]] == before[v[1]] && mesh.points[v[2]] == before[v[2]]) continue;
    if (dot(area_vector(a, b, c), area_vector(before[v[0]], before[v[1]], before[v[2]])) > 0.0) continue;
    ++info.n_locations;
    if (info.locations.size() < k_max_locations) info.locations.push_back({a, "this triangle"});
  }
  if (info.n_locations == 0) return;
  info.problem = std::to_string(info.n_locations) + " triangles at the border of the floor \"" + floor +
                 "\" would be inverted by moving the border into the sides of the box";
  throw Error(std::move(info));
}

}  // namespace

FloorBox fit_floor(const Topology& topology, const FarfieldOptions& options, TriMesh& mesh) {
  if (options.farfield_shape != "box")
    throw_bad_argument(k_floor_attempt, "the farfield shape is \"" + options.farfield_shape + "\"", {}, "a floor needs farfield = box{ floor = ... }");
  require_used_farfield(options);
  const Components components = connected_components(mesh, topology);
  const std::vector<std::uint8_t> is_open = require_sheet(mesh, topology, components, options.farfield_floor);
  FloorBox floor;
  for (const std::uint32_t c : components.component) floor.is_body.push_back(is_open[c] != 0 ? 0 : 1);
  floor.up = up_of(mesh, components, is_open);
  const std::vector<std::array<VertexId, 2>> border = floor_border_of(topology);
  floor.box = box_above(mesh, border, floor.up, options);
  std::size_t n = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (k == floor.up) continue;
    floor.sides[n++] = {.axis = k, .at = floor.box.min[k], .inward = 1.0};
    floor.sides[n++] = {.axis = k, .at = floor.box.max[k], .inward = -1.0};
  }
  snap_border(border, floor.sides, options.farfield_floor, mesh);
  const double common = common_edge(options.farfield_edge, k_default_edge * 0.5 * floor.box.longest_side());
  for (std::size_t side = 0; side < 6; ++side) floor.edges[side] = edge_of_side(options.farfield_sides, k_box_sides[side], common);
  return floor;
}

void check_bodies_above(const FloorBox& floor, const TriMesh& boundary, const RunContext& context) {
  if (std::ranges::count(floor.is_body, 1) == 0) return;
  TriMesh shell{.points = boundary.points, .triangles = {}, .triangle_patch = {}, .patches = boundary.patches};
  for (const TriangleId t : boundary.triangles.ids()) {
    if (t.index() < floor.is_body.size() && floor.is_body[t.index()] != 0) continue;
    shell.triangles.push_back(boundary.triangles[t]);
    shell.triangle_patch.push_back(boundary.triangle_patch[t]);
  }
  const TriangleTree tree(shell, context);
  ErrorInfo info{.code = ErrorCode::bad_argument,
                 .attempted = k_floor_attempt,
                 .hint = "move the bodies into the box and above the floor, unite them with the floor, or leave them out"};
  for (const TriangleId t : boundary.triangles.ids()) {
    if (t.index() >= floor.is_body.size() || floor.is_body[t.index()] == 0) continue;
    const Point p = corners(boundary, t)[0];
    if (std::abs(tree.winding_number(p)) >= 0.5) continue;
    ++info.n_locations;
    if (info.locations.size() < k_max_locations) info.locations.push_back({p, "a triangle of a closed part"});
  }
  info.problem = std::to_string(info.n_locations) + " triangles of closed parts are below the floor or outside the sides of the box";
  if (info.n_locations > 0) throw Error(std::move(info));
}

}  // namespace sterna::volmesh
