#include "volmesh/case/body_wake.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geom/base/error.h"
#include "geom/base/print_text.h"
#include "geom/math/measures.h"
#include "volmesh/case/layer_rules.h"

namespace sterna::volmesh {
namespace {

constexpr double k_side_share = 1e-6;  ///< distance within which a patch lies in a side of a domain's box, as a fraction of the box's longest side

bool is_wake_unrefined(const TriMesh& surface, const MeshCase& options) {
  const std::string& shape = options.farfield.farfield_shape;
  if (!options.sources.empty() || !options.wakes.empty() || shape == "none" || shape == "surface") return false;
  bool has_walls = false;
  for (const Patch& patch : surface.patches) {
    const PatchKind kind = with_kind(patch, options.patches).kind;
    if (kind == PatchKind::inflow || kind == PatchKind::outflow || kind == PatchKind::farfield) return false;
    has_walls |= kind == PatchKind::wall;
  }
  return has_walls;
}

/// Returns true if the surface encloses its fluid. Computes the flux of x along x: normals point into the fluid, and openings in planes y or z = constant
/// contribute nothing to this flux.
bool encloses_fluid(const TriMesh& surface) {
  const double middle = bounding_box(surface).center().x;
  double volume = 0.0;
  for (const TriangleId t : surface.triangles.ids()) {
    const auto [a, b, c] = corners(surface, t);
    volume += area_vector(a, b, c).x * ((a.x + b.x + c.x) / 3.0 - middle);
  }
  return volume < 0.0;
}

/// Finds the patches that are outer walls of a domain. They lie in one side of its box, or reach from side to side along two axes.
Column<PatchId, std::uint8_t> outer_patches(const TriMesh& surface, const Box& domain) {
  std::vector<Box> boxes(surface.patches.size());
  for (const TriangleId t : surface.triangles.ids())
    for (const Point& p : corners(surface, t)) boxes[surface.triangle_patch[t].index()].add(p);
  const double tolerance = k_side_share * domain.longest_side();
  Column<PatchId, std::uint8_t> is_outer(surface.patches.size(), 0);
  for (const PatchId p : surface.patches.ids()) {
    const Box& box = boxes[p.index()];
    if (box.empty()) continue;
    int n_spanned = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_low = box.min[k] - domain.min[k] <= tolerance, is_high = domain.max[k] - box.max[k] <= tolerance;
      n_spanned += is_low && is_high ? 1 : 0;
      if ((is_low || is_high) && box.max[k] - box.min[k] <= tolerance) is_outer[p] = 1;
    }
    if (n_spanned >= 2) is_outer[p] = 1;
  }
  return is_outer;
}

/// Returns the distance in metres from a point in the box to the side of the box along a direction.
double way_out(const Box& domain, const Point& from, const Vec3& along) {
  double way = 1e300;
  for (std::size_t k = 0; k < 3; ++k)
    if (along[k] != 0.0) way = std::min(way, ((along[k] > 0.0 ? domain.max[k] : domain.min[k]) - from[k]) / along[k]);
  return way;
}

bool needs_family_wake(const FamilyOptions& family) { return family.family_wake == "on" || (family.family_wake == "automatic" && family.refinement != 1.0); }

}  // namespace

SizeSource wake_behind(const TriMesh& wall, const BodyWake& wake) {
  const Vec3& direction = wake.direction;
  const std::string attempted = "placing a wake";
  const bool is_domain = encloses_fluid(wall);
  const Box domain = bounding_box(wall);
  const Column<PatchId, std::uint8_t> is_outer = is_domain ? outer_patches(wall, domain) : Column<PatchId, std::uint8_t>(wall.patches.size(), 0);
  Box box;
  for (const TriangleId t : wall.triangles.ids()) {
    const PatchId patch = wall.triangle_patch[t];
    if (wall.patches[patch].kind != PatchKind::wall || is_outer[patch]) continue;
    for (const VertexId v : wall.triangles[t]) box.add(wall.points[v]);
  }
  if (box.empty())
    throw_bad_argument(attempted, is_domain ? "the surface encloses its fluid, and there is no wall inside it" : "the surface has no walls", {},
                       "give the wake's points: wake{ {1, 0, 0}, {1, 5, 0}, length = 10, height = 0.2, size = 0.05 }");
  if (!(norm(direction) > 0.0)) throw Error({.code = ErrorCode::bad_argument, .attempted = attempted, .problem = "the direction has no length"});
  // Directions across the flow: `sideways` (along y if the flow is vertical) and upwards.
  const Vec3 along = normalized(direction), sideways = cross(Vec3{0.0, 0.0, 1.0}, along);
  const Vec3 across = norm(sideways) > 0.0 ? normalized(sideways) : Vec3{0.0, 1.0, 0.0}, up = cross(along, across);
  const auto extent = [&](const Vec3& axis) {
    const Vec3 half = 0.5 * (box.max - box.min);
    return std::abs(axis.x) * half.x + std::abs(axis.y) * half.y + std::abs(axis.z) * half.z;
  };
  const double height = 2.0 * extent(up), body = box.longest_side();
  constexpr double k_cells_over_height = 8.0, k_cells_over_length = 50.0;
  SizeSource source{.kind = SourceKind::wake};
  source.from = box.center() - extent(across) * across;
  source.to = box.center() + extent(across) * across;
  source.direction = along;
  source.length = extent(along) + wake.length * body;
  if (is_domain) source.length = std::min(source.length, way_out(domain, box.center(), along));  // the wake ends where the fluid ends
  source.height = height;
  source.spread = wake.spread;
  source.size = is_automatic(wake.size) ? std::max(height / k_cells_over_height, body / k_cells_over_length) : wake.size;
  source.size_end = is_automatic(wake.size_end) ? 2.0 * source.size : wake.size_end;
  return source;
}

bool has_bare_wake(const TriMesh& surface, const MeshCase& options) { return is_wake_unrefined(surface, options) && !needs_family_wake(options.family); }

MeshCase with_family_wake(const TriMesh& surface, MeshCase options, const RunContext& context) {
  if (!needs_family_wake(options.family) || !is_wake_unrefined(surface, options)) return options;
  const BodyWake wake;
  TriMesh walls = surface;
  for (Patch& patch : walls.patches) patch.kind = with_kind(patch, options.patches).kind;
  const SizeSource source = wake_behind(walls, wake);
  const double f = options.family.refinement;
  context.info(
      print_text("wake source of a mesh family member: edges of %.4g m, %.4g m at the far end, %g body lengths behind the walls along x; custom sources or "
                 "family_wake = \"off\" replace this wake",
                 source.size / f, source.size_end / f, wake.length));
  options.sources.push_back(source);
  return options;
}

}  // namespace sterna::volmesh
