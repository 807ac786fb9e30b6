#include "surfmesh/face/face_strip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/delaunay/face_state.h"
#include "geom/math/predicates.h"

namespace sterna::surfmesh {
namespace {

using delaunay::sample;

/// The shape of a short side affects the strip over a distance of this many times its length.
constexpr double k_end_reach = 2.0;

struct Grid {
  std::size_t n_rows = 0, n_columns = 0;  ///< numbers of points
  std::vector<std::uint32_t> id;
  std::uint32_t operator()(std::size_t i, std::size_t j) const { return id[i * n_columns + j]; }
};

}  // namespace

std::optional<BandedFace> mesh_strip(const Surface& surface, const FaceBorder& border, const StripSides& sides) {
  if (border.loops.size() != 1) return std::nullopt;
  const auto& loop = border.loops.front();
  const std::size_t n = loop.size(), n_along = sides.n_along, n_across = sides.n_across;
  const std::size_t n_end = sides.is_end_pointed ? 0 : n_across, n_start = sides.is_start_pointed ? 0 : n_across;
  if (n_along == 0 || n_across == 0 || 2 * n_along + n_end + n_start != n) return std::nullopt;
  const auto at = [&](std::size_t k) { return (sides.first_long + k) % n; };
  const auto first_side = [&](std::size_t i) { return at(i); };
  const auto second_side = [&](std::size_t i) { return at(2 * n_along + n_end - i); };
  const auto start_side = [&](std::size_t j) { return sides.is_start_pointed ? at(0) : at(n - j); };
  const auto end_side = [&](std::size_t j) { return sides.is_end_pointed ? at(n_along) : at(n_along + j); };

  BandedFace result;
  FaceMesh& mesh = result.mesh;
  mesh.n_border = static_cast<std::uint32_t>(n);
  for (const BorderPoint& p : loop) {
    mesh.points.push_back(p.point);
    mesh.uv.push_back(p.uv);
  }
  const auto between = [](Uv a, Uv b, double t) { return (1.0 - t) * a + t * b; };
  // Deviation of the short sides from straight lines in (u, v). It is carried into the strip over a few lengths of the short sides.
  const double width_start = distance(loop[first_side(0)].point, loop[second_side(0)].point),
               width_end = distance(loop[first_side(n_along)].point, loop[second_side(n_along)].point);
  std::vector<double> along{0.0};
  for (std::size_t i = 0; i < n_along; ++i) along.push_back(along.back() + distance(loop[first_side(i)].point, loop[first_side(i + 1)].point));
  const auto fading = [](double way, double width) { return width > 0.0 ? std::max(0.0, 1.0 - way / (k_end_reach * width)) : 0.0; };
  Grid grid{n_along + 1, n_across + 1, {}};
  for (std::size_t i = 0; i <= n_along; ++i)
    for (std::size_t j = 0; j <= n_across; ++j) {
      const double t = static_cast<double>(j) / static_cast<double>(n_across);
      std::size_t given = n;
      if (i == 0) given = start_side(j);
      else if (i == n_along) given = end_side(j);
      else if (j == 0) given = first_side(i);
      else if (j == n_across) given = second_side(i);
      if (given < n) {
        grid.id.push_back(static_cast<std::uint32_t>(given));
        continue;
      }
      Uv uv = between(loop[first_side(i)].uv, loop[second_side(i)].uv, t);
      const Uv bent_start = loop[start_side(j)].uv - between(loop[first_side(0)].uv, loop[second_side(0)].uv, t),
               bent_end = loop[end_side(j)].uv - between(loop[first_side(n_along)].uv, loop[second_side(n_along)].uv, t);
      uv = uv + fading(along[i], width_start) * bent_start + fading(along.back() - along[i], width_end) * bent_end;
      grid.id.push_back(static_cast<std::uint32_t>(mesh.points.size()));
      mesh.uv.push_back(uv);
      mesh.points.push_back(surface.point(uv));
    }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) mesh.triangles.push_back({VertexId(a), VertexId(b), VertexId(c)});
  };
  for (std::size_t i = 0; i < n_along; ++i)
    for (std::size_t j = 0; j < n_across; ++j) {
      const std::uint32_t a = grid(i, j), b = grid(i + 1, j), c = grid(i + 1, j + 1), d = grid(i, j + 1);
      if (is_first_diagonal(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d], (i + j) % 2 == 0)) {
        add(a, b, c);
        add(a, c, d);
      } else {
        add(a, b, d);
        add(b, c, d);
      }
      const double length = 0.5 * (distance(mesh.points[a], mesh.points[b]) + distance(mesh.points[d], mesh.points[c])),
                   height = 0.5 * (distance(mesh.points[a], mesh.points[d]) + distance(mesh.points[b], mesh.points[c]));
      result.bands.max_stretch = std::max(result.bands.max_stretch, length / height);
    }
  for (const TriangleVertices& t : mesh.triangles) {
    const auto in_plane = [&](VertexId v) { return Vec2{mesh.uv[v.index()].u, mesh.uv[v.index()].v}; };
    if (orient2d(in_plane(t[0]), in_plane(t[1]), in_plane(t[2])) <= 0) return std::nullopt;
  }
  for (const Uv uv : mesh.uv) mesh.normals.push_back(sample(surface, uv).frame.normal);
  mesh.report.min_angle = std::numbers::pi;  // there are no isotropic triangles
  mesh.n_band = mesh.triangles.size();
  result.bands.n_triangles = static_cast<std::int64_t>(mesh.n_band);
  return result;
}

}  // namespace sterna::surfmesh
