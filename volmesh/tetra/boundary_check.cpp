#include "volmesh/tetra/boundary_check.h"

#include <algorithm>
#include <numeric>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/predicates.h"

namespace sterna::volmesh {
namespace {

constexpr std::size_t k_triangles_drawn = 1000;
/// TetGen uses int for counts, and needs space for the points that it adds.
constexpr std::size_t k_count_limit = std::size_t{1} << 29;

using Offenders = std::vector<std::size_t>;

/// Returns all i in [0, n) with is_bad(i), ascending.
template <class F>
Offenders find_all(const RunContext& context, std::size_t n, const F& is_bad) {
  return parallel_reduce(
      context, n, Offenders{},
      [&](std::size_t begin, std::size_t end) {
        Offenders found;
        for (std::size_t i = begin; i < end; ++i) {
          if (is_bad(i)) found.push_back(i);
        }
        return found;
      },
      [](Offenders a, Offenders b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
}

ErrorInfo info(ErrorCode code, std::string problem, std::string hint = {}) {
  return {.code = code, .attempted = "checking the boundary of the tetrahedra", .problem = std::move(problem), .hint = std::move(hint)};
}

[[noreturn]] void throw_for_triangles(ErrorInfo error, const TetraBoundary& boundary, const Offenders& triangles, const std::string& what) {
  for (std::size_t i = 0; i < std::min(triangles.size(), k_max_locations); ++i) error.locations.push_back(location_of_triangle(boundary, triangles[i], what));
  for (std::size_t i = 0; i < std::min(triangles.size(), k_triangles_drawn); ++i) add_triangle(error.geometry, boundary, triangles[i]);
  error.n_locations = static_cast<std::int64_t>(triangles.size());
  throw Error(std::move(error));
}

[[noreturn]] void throw_for_points(ErrorInfo error, const TetraBoundary& boundary, const Offenders& points, const std::string& what) {
  for (std::size_t i = 0; i < std::min(points.size(), k_max_locations); ++i) {
    error.locations.push_back({boundary.points[points[i]], "point " + std::to_string(points[i]) + " " + what});
  }
  error.n_locations = static_cast<std::int64_t>(points.size());
  throw Error(std::move(error));
}

void check_counts_and_indices(const TetraBoundary& boundary, const RunContext& context) {
  const std::size_t n_points = boundary.points.size();
  if (boundary.triangles.empty()) throw Error(info(ErrorCode::bad_argument, "the boundary has no triangles"));
  if (n_points > k_count_limit || boundary.triangles.size() > k_count_limit) {
    throw Error(info(ErrorCode::overflow, std::to_string(n_points) + " points and " + std::to_string(boundary.triangles.size()) + " triangles, limit " +
                                              std::to_string(k_count_limit)));
  }
  const Offenders bad = find_all(context, boundary.triangles.size(),
                                 [&](std::size_t t) { return std::ranges::any_of(boundary.triangles[t], [&](std::uint32_t v) { return v >= n_points; }); });
  if (bad.empty()) return;
  ErrorInfo error =
      info(ErrorCode::bad_argument, std::to_string(bad.size()) + " triangles with a vertex index out of range, limit " + std::to_string(n_points));
  for (std::size_t i = 0; i < std::min(bad.size(), k_max_locations); ++i) {
    const auto& t = boundary.triangles[bad[i]];
    const auto known = std::ranges::find_if(t, [&](std::uint32_t v) { return v < n_points; });
    error.locations.push_back({known == t.end() ? Vec3{} : boundary.points[*known], "triangle " + std::to_string(bad[i]) + " (" + std::to_string(t[0]) + ", " +
                                                                                        std::to_string(t[1]) + ", " + std::to_string(t[2]) + ")"});
  }
  error.n_locations = static_cast<std::int64_t>(bad.size());
  throw Error(std::move(error));
}

void check_coordinates(const TetraBoundary& boundary, const RunContext& context) {
  const Offenders infinite = find_all(context, boundary.points.size(), [&](std::size_t i) { return !is_finite(boundary.points[i]); });
  if (!infinite.empty())
    throw_for_points(info(ErrorCode::bad_argument, std::to_string(infinite.size()) + " points with a coordinate that is not finite"), boundary, infinite,
                     "is not finite");
  for (const Vec3& hole : boundary.hole_points) {
    if (!is_finite(hole)) throw Error(info(ErrorCode::bad_argument, "a hole point is not finite"));
  }
}

void check_points_used(const TetraBoundary& boundary, std::span<const std::array<std::uint32_t, 3>> baffles, const RunContext& context) {
  std::vector<std::uint8_t> is_used(boundary.points.size(), 0);
  for (const auto& triangles : {boundary.triangles, baffles}) {
    for (const auto& t : triangles)
      for (const std::uint32_t v : t) is_used[v] = 1;
  }
  const Offenders unused = find_all(context, is_used.size(), [&](std::size_t i) { return !is_used[i]; });
  if (!unused.empty())
    throw_for_points(info(ErrorCode::bad_argument, std::to_string(unused.size()) + " points that no triangle uses"), boundary, unused, "is unused");
}

void check_no_twin_points(const TetraBoundary& boundary, const RunContext& context) {
  std::vector<std::uint32_t> order(boundary.points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) {
    const Vec3& p = boundary.points[v];
    return std::array{p.x + 0.0, p.y + 0.0, p.z + 0.0};  // adding 0.0 converts -0 to 0, which is the same location
  };
  parallel_sort(context, order, [&](std::uint32_t a, std::uint32_t b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  Offenders twins = find_all(context, order.size(), [&](std::size_t i) { return i > 0 && key(order[i - 1]) == key(order[i]); });
  if (twins.empty()) return;
  for (std::size_t& i : twins) i = order[i];
  std::ranges::sort(twins);
  throw_for_points(info(ErrorCode::self_intersection, std::to_string(twins.size()) + " points coincide with another point",
                        "weld these points, or move the touching parts of the boundary apart"),
                   boundary, twins, "coincides with another point");
}

/// Returns true if the points are collinear. They are if and only if their projections to all three coordinate planes are collinear.
bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
  return orient2d({a.x, a.y}, {b.x, b.y}, {c.x, c.y}) == 0 && orient2d({a.y, a.z}, {b.y, b.z}, {c.y, c.z}) == 0 &&
         orient2d({a.z, a.x}, {b.z, b.x}, {c.z, c.x}) == 0;
}

void check_triangles(const TetraBoundary& boundary, const RunContext& context) {
  const Offenders flat = find_all(context, boundary.triangles.size(), [&](std::size_t i) {
    const auto& t = boundary.triangles[i];
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0] || is_degenerate(boundary.points[t[0]], boundary.points[t[1]], boundary.points[t[2]]);
  });
  if (!flat.empty())
    throw_for_triangles(info(ErrorCode::bad_argument, std::to_string(flat.size()) + " triangles whose corners are equal or lie on a line"), boundary, flat,
                        "without area");
}

struct DirectedEdge {
  std::uint64_t vertices;  ///< lower vertex << 32 | higher vertex
  std::uint64_t use;       ///< triangle << 1 | 1 if the edge runs from the high to the low vertex
};

void check_edges(const TetraBoundary& boundary, const RunContext& context) {
  std::vector<DirectedEdge> edges(3 * boundary.triangles.size());
  parallel_for(context, boundary.triangles.size(), [&](std::size_t t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = boundary.triangles[t][k], b = boundary.triangles[t][(k + 1) % 3];
      edges[3 * t + k] = {std::min(a, b) << 32 | std::max(a, b), t << 1 | static_cast<std::uint64_t>(a > b)};
    }
  });
  parallel_sort(context, edges,
                [](const DirectedEdge& a, const DirectedEdge& b) { return a.vertices != b.vertices ? a.vertices < b.vertices : a.use < b.use; });
  Offenders open, tangled;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].vertices == edges[i].vertices) ++end;
    if (end - i == 1) {
      open.push_back(edges[i].use >> 1);
    } else if (end - i > 2 || ((edges[i].use ^ edges[i + 1].use) & 1) == 0) {
      tangled.push_back(edges[i].use >> 1);
    }
    i = end;
  }
  if (!open.empty()) {
    throw_for_triangles(info(ErrorCode::open_surface, std::to_string(open.size()) + " edges with one triangle only; the boundary must be closed"), boundary,
                        open, "has an open edge");
  }
  if (!tangled.empty()) {
    throw_for_triangles(
        info(ErrorCode::non_manifold_surface, std::to_string(tangled.size()) + " edges with more than two triangles, or with two triangles of the same sense"),
        boundary, tangled, "has such an edge");
  }
}

}  // namespace

ErrorLocation location_of_triangle(const TetraBoundary& boundary, std::size_t triangle, const std::string& what) {
  const auto& t = boundary.triangles[triangle];
  std::string name = "boundary triangle " + std::to_string(triangle);
  if (!boundary.triangle_patch.empty()) name += " of patch \"" + boundary.patch_names[boundary.triangle_patch[triangle]] + "\"";
  return {(boundary.points[t[0]] + boundary.points[t[1]] + boundary.points[t[2]]) / 3.0, name + " " + what};
}

void add_triangle(TroubleGeometry& geometry, const TetraBoundary& boundary, std::size_t triangle) {
  const auto first = static_cast<std::uint32_t>(geometry.points.size());
  for (const std::uint32_t v : boundary.triangles[triangle]) geometry.points.push_back(boundary.points[v]);
  geometry.triangles.push_back({first, first + 1, first + 2});
}

void check_boundary(const TetraBoundary& boundary, const RunContext& context, std::span<const std::array<std::uint32_t, 3>> baffles) {
  check_counts_and_indices(boundary, context);
  const TetraBoundary of_baffles{.points = boundary.points, .triangles = baffles, .hole_points = {}};
  if (!baffles.empty()) check_counts_and_indices(of_baffles, context);
  check_coordinates(boundary, context);
  check_points_used(boundary, baffles, context);
  check_no_twin_points(boundary, context);
  check_triangles(boundary, context);
  check_triangles(of_baffles, context);
  check_edges(boundary, context);
}

}  // namespace sterna::volmesh
