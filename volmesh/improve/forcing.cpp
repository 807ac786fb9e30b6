#include "volmesh/improve/forcing.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "geom/mesh/bvh.h"
#include "volmesh/improve/tet_quality.h"

namespace sterna::volmesh {
namespace {

/// Smallest overlap that counts, as a fraction of the smaller extent along an axis. Rounding and near-parallel edges cannot produce such an overlap.
constexpr double k_least_overlap = 1e-3;
/// Sine of an angle: below it two edges count as parallel, and their common normals are face normals.
constexpr double k_forcing_parallel = 1e-6;

using Core = std::array<Vec3, 4>;

Core core_of(const TetraBoundary& boundary, std::uint32_t triangle, double low) {
  const auto& v = boundary.triangles[triangle];
  const Vec3 &a = boundary.points[v[0]], &b = boundary.points[v[1]], &c = boundary.points[v[2]];
  const double opposite_a = norm(c - b), opposite_b = norm(a - c), opposite_c = norm(b - a), perimeter = opposite_a + opposite_b + opposite_c;
  const Vec3 normal = cross(b - a, c - a);
  // The radius of the inscribed circle is twice the area divided by the perimeter. The three planes meet above the centre of that circle.
  const Vec3 rise = (std::tan(low) / perimeter) * normal;
  return {a, b, c, (opposite_a * a + opposite_b * b + opposite_c * c) / perimeter + rise};
}

Box box_of(const Core& core) {
  Box box{core[0], core[0]};
  for (const Vec3& p : core)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.min[axis] = std::min(box.min[axis], p[axis]);
      box.max[axis] = std::max(box.max[axis], p[axis]);
    }
  return box;
}

bool is_separated_along(const Core& a, const Core& b, const Vec3& axis) {
  const auto extent = [&](const Core& core) {
    const auto [low, high] = std::minmax({dot(axis, core[0] - a[0]), dot(axis, core[1] - a[0]), dot(axis, core[2] - a[0]), dot(axis, core[3] - a[0])});
    return std::array<double, 2>{low, high};
  };
  const auto of_a = extent(a), of_b = extent(b);
  const double common = std::min(of_a[1], of_b[1]) - std::max(of_a[0], of_b[0]);
  return common <= k_least_overlap * std::min(of_a[1] - of_a[0], of_b[1] - of_b[0]);
}

/// Returns true if two convex bodies overlap. They do not overlap if and only if they are separate along a face normal, or along a normal of an edge of each
/// body.
bool do_overlap(const Core& a, const Core& b) {
  constexpr std::uint8_t k_faces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  constexpr std::uint8_t k_edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  for (const auto& f : k_faces)
    for (const Core* core : {&a, &b})
      if (is_separated_along(a, b, cross((*core)[f[1]] - (*core)[f[0]], (*core)[f[2]] - (*core)[f[0]]))) return false;
  for (const auto& e : k_edges)
    for (const auto& f : k_edges) {
      const Vec3 u = a[e[1]] - a[e[0]], v = b[f[1]] - b[f[0]], axis = cross(u, v);
      if (norm2(axis) <= k_forcing_parallel * k_forcing_parallel * norm2(u) * norm2(v)) continue;
      if (is_separated_along(a, b, axis)) return false;
    }
  return true;
}

/// Returns true if a tetrahedron within the limits can have both triangles as faces. They must share an edge, and their hull must be such a tetrahedron.
bool can_share(const TetraBoundary& boundary, std::uint32_t triangle, std::uint32_t other, double low, double high) {
  const auto &v = boundary.triangles[triangle], &w = boundary.triangles[other];
  const auto is_shared = [&](std::uint32_t x) { return std::ranges::find(v, x) != v.end(); };
  if (std::ranges::count_if(w, is_shared) != 2) return false;
  const Vec3& apex = boundary.points[*std::ranges::find_if_not(w, is_shared)];
  const Vec3 &a = boundary.points[v[0]], &b = boundary.points[v[1]], &c = boundary.points[v[2]];
  if (tet_quality(a, b, c, apex, 1.0) <= 0.0) return false;
  const auto [of_smallest, of_largest] = dihedral_cosines(a, b, c, apex);
  return of_smallest <= std::cos(low) && of_largest >= std::cos(high);
}

}  // namespace

std::vector<std::uint32_t> forcing_triangles(const TetraBoundary& boundary, std::span<const std::uint32_t> target, double low, double high,
                                             const RunContext& context) {
  std::vector<Core> cores(target.size());
  std::vector<Box> boxes(target.size());
  for (std::size_t i = 0; i < target.size(); ++i) {
    cores[i] = core_of(boundary, target[i], low);
    boxes[i] = box_of(cores[i]);
  }
  const BoxTree tree(boxes, context);
  struct Hit {
    std::uint32_t location, triangle;
  };
  using Hits = std::vector<Hit>;
  const Hits hits = parallel_reduce(
      context, boundary.triangles.size(), Hits{},
      [&](std::size_t begin, std::size_t end) {
        Hits found;
        for (std::size_t t = begin; t < end; ++t) {
          const auto triangle = static_cast<std::uint32_t>(t);
          const Core core = core_of(boundary, triangle, low);
          tree.for_each_overlap(box_of(core), [&](std::uint32_t i) {
            if (target[i] != triangle && do_overlap(cores[i], core) && !can_share(boundary, target[i], triangle, low, high)) found.push_back({i, triangle});
            return true;
          });
        }
        return found;
      },
      [](Hits a, const Hits& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
  std::vector<std::uint32_t> result(target.size(), k_unforced);
  for (const Hit& hit : hits) result[hit.location] = std::min(result[hit.location], hit.triangle);
  return result;
}

}  // namespace sterna::volmesh
