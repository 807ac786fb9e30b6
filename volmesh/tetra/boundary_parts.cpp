#include "volmesh/tetra/boundary_parts.h"

#include <cmath>
#include <numeric>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/bvh.h"
#include "geom/math/measures.h"

namespace sterna::volmesh {
namespace {

constexpr double k_inside_winding = 0.5;  ///< winding numbers come out as 0 or 1 within 0.05

/// Number of the component of each vertex; components in order of their first triangle.
std::vector<std::int32_t> number_components(std::size_t n_points, std::span<const std::array<std::uint32_t, 3>> triangles, std::size_t& n_components) {
  std::vector<std::uint32_t> parent(n_points);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : triangles) {
    const std::uint32_t a = root(t[0]);
    parent[root(t[1])] = a;
    parent[root(t[2])] = a;
  }
  std::vector<std::int32_t> number(n_points, -1);
  n_components = 0;
  for (const auto& t : triangles) {
    std::int32_t& n = number[root(t[0])];
    if (n < 0) n = static_cast<std::int32_t>(n_components++);
  }
  for (std::uint32_t v = 0; v < number.size(); ++v) number[v] = number[root(v)];
  return number;
}

/// Volume that each surface encloses, m^3: negative when its normals point inwards. Relative to a point of its own, so that a distant small body keeps its digits.
std::vector<double> enclosed_volumes(const TetraBoundary& boundary, const BoundaryParts& parts, const std::vector<std::uint32_t>& first_vertex) {
  std::vector<CompensatedSum> sums(first_vertex.size());
  for (std::size_t t = 0; t < boundary.triangles.size(); ++t) {
    const auto surface = static_cast<std::size_t>(parts.triangle2surface[t]);
    const auto& [a, b, c] = boundary.triangles[t];
    sums[surface].add(tet_volume(boundary.points[first_vertex[surface]], boundary.points[a], boundary.points[b], boundary.points[c]));
  }
  std::vector<double> volumes;
  for (const CompensatedSum& sum : sums) volumes.push_back(sum.value());
  return volumes;
}

/// A region's outer surface, for asking what lies inside.
class Shell {
 public:
  Shell(const TetraBoundary& boundary, const BoundaryParts& parts, std::int32_t surface, const RunContext& context) : tree_(mesh_of(boundary, parts, surface), context) {}
  bool contains(const Vec3& p) const { return std::abs(tree_.winding_number(p)) > k_inside_winding; }

 private:
  static TriMesh mesh_of(const TetraBoundary& boundary, const BoundaryParts& parts, std::int32_t surface) {
    TriMesh mesh;
    for (const Vec3& p : boundary.points) mesh.points.push_back(p);
    for (std::size_t t = 0; t < boundary.triangles.size(); ++t) {
      const auto& [a, b, c] = boundary.triangles[t];
      if (parts.triangle2surface[t] == surface) mesh.triangles.push_back({VertexId(a), VertexId(b), VertexId(c)});
    }
    return mesh;
  }
  TriangleTree tree_;
};

}  // namespace

BoundaryParts find_parts(const TetraBoundary& boundary, std::span<const std::array<std::uint32_t, 3>> sheets, const RunContext& context) {
  BoundaryParts parts;
  std::size_t n_surfaces = 0;
  const std::vector<std::int32_t> component = number_components(boundary.points.size(), boundary.triangles, n_surfaces);
  std::vector<std::uint32_t> first_vertex(n_surfaces);
  parts.triangle2surface.resize(boundary.triangles.size());
  for (std::size_t t = boundary.triangles.size(); t-- > 0;) {
    const std::uint32_t v = boundary.triangles[t][0];
    parts.triangle2surface[t] = component[v];
    first_vertex[static_cast<std::size_t>(component[v])] = v;
  }

  const std::vector<double> volumes = enclosed_volumes(boundary, parts, first_vertex);
  parts.surface2region.assign(n_surfaces, -1);
  std::vector<std::size_t> outer;  // of each region
  for (std::size_t s = 0; s < n_surfaces; ++s) {
    if (volumes[s] >= 0.0) continue;
    parts.surface2region[s] = static_cast<std::int32_t>(outer.size());
    outer.push_back(s);
  }
  std::vector<Shell> shells;
  if (outer.size() > 1) {
    for (const std::size_t s : outer) shells.emplace_back(boundary, parts, static_cast<std::int32_t>(s), context);
  }
  const auto region_around = [&](std::uint32_t v, const std::string& what) {
    std::int32_t region = outer.size() == 1 ? 0 : -1;
    for (std::size_t r = 0; r < shells.size(); ++r) {
      const bool is_smaller = region < 0 || volumes[outer[r]] > volumes[outer[static_cast<std::size_t>(region)]];
      if (is_smaller && shells[r].contains(boundary.points[v])) region = static_cast<std::int32_t>(r);
    }
    if (region >= 0) return region;
    throw Error({.code = ErrorCode::not_orientable,
                 .attempted = "looking for the regions of the domain",
                 .problem = what + " lies in no region",
                 .places = {{boundary.points[v], "point " + std::to_string(v)}},
                 .hint = "normals must point into the domain: out of the bodies, and inwards on what encloses them"});
  };
  for (std::size_t s = 0; s < n_surfaces; ++s)
    if (volumes[s] >= 0.0) parts.surface2region[s] = region_around(first_vertex[s], "a closed part of the boundary");
  if (sheets.empty()) return parts;

  const std::vector<std::int32_t> sheet = number_components(boundary.points.size(), sheets, parts.n_sheet_surfaces);
  parts.surface2region.resize(n_surfaces + parts.n_sheet_surfaces, -1);
  for (const auto& t : sheets) {
    const std::size_t surface = n_surfaces + static_cast<std::size_t>(sheet[t[0]]);
    parts.triangle2surface.push_back(static_cast<std::int32_t>(surface));
    std::int32_t& region = parts.surface2region[surface];
    for (const std::uint32_t v : t)  // one that touches the boundary is in its region
      if (region < 0 && component[v] >= 0) region = parts.surface2region[static_cast<std::size_t>(component[v])];
  }
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    std::int32_t& region = parts.surface2region[static_cast<std::size_t>(parts.triangle2surface[boundary.triangles.size() + i])];
    if (region < 0) region = region_around(sheets[i][0], "a sheet");
  }
  return parts;
}

}  // namespace sterna::volmesh
