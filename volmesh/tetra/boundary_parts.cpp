#include "volmesh/tetra/boundary_parts.h"

#include <cmath>
#include <map>
#include <numeric>

#include "geom/base/disjoint_sets.h"
#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/mesh/bvh.h"

namespace sterna::volmesh {
namespace {

constexpr double k_inside_winding = 0.5;  ///< limit between outside and inside; computed winding numbers are 0 or 1 within 0.05

/// Returns the component number of each vertex. Components are in the order of their first triangles.
std::vector<std::int32_t> number_components(std::size_t n_points, std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t& n_components) {
  DisjointSets components(n_points);
  for (const auto& t : triangles) {
    components.join(t[0], t[1]);
    components.join(t[0], t[2]);
  }
  std::vector<std::int32_t> number(n_points, -1);
  n_components = 0;
  for (const auto& t : triangles) {
    std::int32_t& n = number[components.root(t[0])];
    if (n < 0) n = static_cast<std::int32_t>(n_components++);
  }
  for (std::uint32_t v = 0; v < number.size(); ++v) number[v] = number[components.root(v)];
  return number;
}

/// Returns the volume that each component encloses in m^3. It is negative if the normals of the component point inwards. It is computed relative to a point of
/// the component, so that it is accurate for a small distant body.
std::vector<double> enclosed_volumes(const TetraBoundary& boundary, const std::vector<std::int32_t>& component,
                                     const std::vector<std::uint32_t>& first_vertex) {
  std::vector<CompensatedSum> sums(first_vertex.size());
  for (const auto& [a, b, c] : boundary.triangles) {
    const auto k = static_cast<std::size_t>(component[a]);
    sums[k].add(tet_volume(boundary.points[first_vertex[k]], boundary.points[a], boundary.points[b], boundary.points[c]));
  }
  std::vector<double> volumes;
  for (const CompensatedSum& sum : sums) volumes.push_back(sum.value());
  return volumes;
}

/// Outer surface of a region, used for inside tests.
class Shell {
 public:
  Shell(const TetraBoundary& boundary, const std::vector<std::int32_t>& component, std::int32_t number, const RunContext& context)
      : tree_(mesh_of(boundary, component, number), context) {}
  bool contains(const Vec3& p) const { return std::abs(tree_.winding_number(p)) > k_inside_winding; }

 private:
  static TriMesh mesh_of(const TetraBoundary& boundary, const std::vector<std::int32_t>& component, std::int32_t number) {
    TriMesh mesh;
    for (const Vec3& p : boundary.points) mesh.points.push_back(p);
    for (const auto& [a, b, c] : boundary.triangles)
      if (component[a] == number) mesh.triangles.push_back({VertexId(a), VertexId(b), VertexId(c)});
    return mesh;
  }
  TriangleTree tree_;
};

/// Regions of the components of a closed boundary, in the order of the components that enclose them. Components that consist of sheets only enclose nothing and
/// have the number -1.
class Regions {
 public:
  Regions(const TetraBoundary& boundary, const std::vector<std::int32_t>& component, std::size_t n_components, const std::vector<std::uint8_t>& is_baffle,
          const RunContext& context)
      : boundary_(boundary) {
    std::vector<std::uint32_t> first_vertex(n_components);
    for (std::size_t t = boundary.triangles.size(); t-- > 0;)
      first_vertex[static_cast<std::size_t>(component[boundary.triangles[t][0]])] = boundary.triangles[t][0];
    volumes_ = enclosed_volumes(boundary, component, first_vertex);
    of_component_.assign(n_components, -1);
    for (std::size_t k = 0; k < n_components; ++k) {
      if (is_baffle[k] != 0 || volumes_[k] >= 0.0) continue;
      of_component_[k] = static_cast<std::int32_t>(outer_.size());
      outer_.push_back(k);
    }
    if (outer_.size() > 1)
      for (const std::size_t k : outer_) shells_.emplace_back(boundary, component, static_cast<std::int32_t>(k), context);
    for (std::size_t k = 0; k < n_components; ++k)
      if (is_baffle[k] == 0 && volumes_[k] >= 0.0) of_component_[k] = around(first_vertex[k], "a closed part of the boundary");
  }
  std::int32_t of(std::int32_t component) const { return of_component_[static_cast<std::size_t>(component)]; }

  /// Returns the smallest region that contains a point.
  std::int32_t around(std::uint32_t v, const std::string& what) const {
    std::int32_t region = outer_.size() == 1 ? 0 : -1;
    for (std::size_t r = 0; r < shells_.size(); ++r) {
      const bool is_smaller = region < 0 || volumes_[outer_[r]] > volumes_[outer_[static_cast<std::size_t>(region)]];
      if (is_smaller && shells_[r].contains(boundary_.points[v])) region = static_cast<std::int32_t>(r);
    }
    if (region >= 0) return region;
    throw Error({.code = ErrorCode::not_orientable,
                 .attempted = "finding the regions of the domain",
                 .problem = what + " lies in no region",
                 .locations = {{boundary_.points[v], "point " + std::to_string(v)}},
                 .hint = "normals must point into the domain: outwards on bodies, inwards on the surfaces around the bodies"});
  }

 private:
  const TetraBoundary& boundary_;
  std::vector<double> volumes_;
  std::vector<std::int32_t> of_component_;
  std::vector<std::size_t> outer_;  ///< component that encloses each region
  std::vector<Shell> shells_;
};

BoundaryParts parts_without_baffles(const TetraBoundary& boundary, const RunContext& context) {
  BoundaryParts parts;
  std::size_t n_surfaces = 0;
  const std::vector<std::int32_t> component = number_components(boundary.points.size(), boundary.triangles, n_surfaces);
  const Regions regions(boundary, component, n_surfaces, std::vector<std::uint8_t>(n_surfaces, 0), context);
  for (const auto& t : boundary.triangles) parts.triangle2surface.push_back(component[t[0]]);
  for (std::size_t s = 0; s < n_surfaces; ++s) parts.surface2region.push_back(regions.of(static_cast<std::int32_t>(s)));
  parts.surface2second.assign(n_surfaces, -1);
  return parts;
}

}  // namespace

BoundaryParts find_parts(const TetraBoundary& boundary, const JoinedBoundary* joined, const RunContext& context) {
  if (!joined) return parts_without_baffles(boundary, context);
  // Both sides of sheets are included here. Each component is then the boundary of one region, or a part of that boundary.
  std::size_t n_components = 0, n_connected = 0;
  const std::vector<std::int32_t> component = number_components(boundary.points.size(), boundary.triangles, n_components);
  const std::vector<std::int32_t> connected = number_components(joined->points.size(), joined->triangles(), n_connected);
  const auto triangles = joined->triangles(), baffles = joined->baffles();
  const auto component_of = [&](std::size_t facet) { return component[boundary.triangles[joined->facet2triangle[facet]][0]]; };
  std::vector<std::uint8_t> is_baffle(n_components, 1);
  for (std::size_t i = 0; i < triangles.size(); ++i) is_baffle[static_cast<std::size_t>(component_of(i))] = 0;
  const Regions regions(boundary, component, n_components, is_baffle, context);

  BoundaryParts parts;
  std::map<std::array<std::int32_t, 2>, std::int32_t> surfaces;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto [surface, is_new] = surfaces.try_emplace({connected[triangles[i][0]], component_of(i)}, static_cast<std::int32_t>(surfaces.size()));
    if (is_new) parts.surface2region.push_back(regions.of(component_of(i)));
    parts.triangle2surface.push_back(surface->second);
  }
  const std::size_t n_surfaces = surfaces.size();
  const std::vector<std::int32_t> baffle = number_components(joined->points.size(), baffles, parts.n_baffle_surfaces);
  parts.surface2region.resize(n_surfaces + parts.n_baffle_surfaces, -1);
  parts.surface2second.assign(n_surfaces + parts.n_baffle_surfaces, -1);
  for (std::size_t i = 0; i < baffles.size(); ++i) {
    const std::size_t surface = n_surfaces + static_cast<std::size_t>(baffle[baffles[i][0]]);
    parts.triangle2surface.push_back(static_cast<std::int32_t>(surface));
    std::int32_t& region = parts.surface2region[surface];
    if (region >= 0) continue;
    const std::int32_t first = component_of(triangles.size() + i);
    region = is_baffle[static_cast<std::size_t>(first)] != 0 ? regions.around(boundary.triangles[joined->facet2triangle[triangles.size() + i]][0], "a baffle")
                                                             : regions.of(first);
    for (const std::uint32_t v : baffles[i]) {
      const std::int32_t second = component[joined->sources[v][1]];
      if (is_baffle[static_cast<std::size_t>(second)] == 0 && regions.of(second) != region) parts.surface2second[surface] = regions.of(second);
    }
  }
  return parts;
}

}  // namespace sterna::volmesh
