#include "volmesh/domain/farfield.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "volmesh/domain/shape_sizes.h"

namespace sterna::volmesh {
namespace {

constexpr double k_margin = 0.25;  ///< body lengths: smallest distance between wall and sphere, enough for the layer and a few tetrahedra
constexpr std::size_t k_most_triangles = 20'000'000;
constexpr std::uint32_t k_not_made = 0xffffffff;

/// Regular icosahedron with the coordinates 0, +-1 and +-golden ratio. Faces are counter-clockwise as seen from outside.
const double k_golden = (1.0 + std::sqrt(5.0)) / 2.0;
const std::array<Vec3, 12> k_corners = {{{-1, k_golden, 0},
                                         {1, k_golden, 0},
                                         {-1, -k_golden, 0},
                                         {1, -k_golden, 0},
                                         {0, -1, k_golden},
                                         {0, 1, k_golden},
                                         {0, -1, -k_golden},
                                         {0, 1, -k_golden},
                                         {k_golden, 0, -1},
                                         {k_golden, 0, 1},
                                         {-k_golden, 0, -1},
                                         {-k_golden, 0, 1}}};
constexpr std::array<std::array<std::uint32_t, 3>, 20> k_faces = {{{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                                                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                                                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
/// Ratio of the edge of the icosahedron to its circumradius.
const double k_edge_ratio = 2.0 / std::sqrt(1.0 + k_golden * k_golden);

/// Unit sphere. Every face of an icosahedron is split into f^2 triangles (class I), and the points are projected onto the sphere. Points on shared edges are
/// made once.
class Subdivision {
 public:
  explicit Subdivision(std::uint32_t f) : f_(f) {
    for (const Vec3& corner : k_corners) points_.push_back(normalized(corner));
    for (auto& row : first_on_edge_) row.fill(k_not_made);
    for (const auto& face : k_faces) split(face);
  }
  const std::vector<Vec3>& points() const { return points_; }
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }

 private:
  std::uint32_t add(const Vec3& p) {
    points_.push_back(normalized(p));
    return static_cast<std::uint32_t>(points_.size() - 1);
  }
  /// Returns the point that is i steps from corner a towards corner b, with 0 <= i <= f.
  std::uint32_t on_edge(std::uint32_t a, std::uint32_t b, std::uint32_t i) {
    if (i == 0) return a;
    if (i == f_) return b;
    if (a > b) return on_edge(b, a, f_ - i);
    std::uint32_t& first = first_on_edge_[a][b];
    if (first == k_not_made) {
      first = static_cast<std::uint32_t>(points_.size());
      for (std::uint32_t k = 1; k < f_; ++k) add(static_cast<double>(f_ - k) * k_corners[a] + static_cast<double>(k) * k_corners[b]);
    }
    return first + i - 1;
  }
  void split(const std::array<std::uint32_t, 3>& face) {
    const auto [a, b, c] = face;
    // Row j has f - j + 1 points, from edge a-c to edge b-c.
    std::vector<std::uint32_t> below, row;
    for (std::uint32_t j = 0; j <= f_; ++j) {
      row.clear();
      for (std::uint32_t i = 0; i <= f_ - j; ++i) {
        if (j == 0) row.push_back(on_edge(a, b, i));
        else if (i == 0) row.push_back(on_edge(a, c, j));
        else if (i == f_ - j) row.push_back(on_edge(b, c, j));
        else row.push_back(add(static_cast<double>(f_ - i - j) * k_corners[a] + static_cast<double>(i) * k_corners[b] + static_cast<double>(j) * k_corners[c]));
      }
      for (std::uint32_t i = 0; j > 0 && i < row.size(); ++i) {
        triangles_.push_back({below[i], below[i + 1], row[i]});
        if (i + 1 < row.size()) triangles_.push_back({below[i + 1], row[i + 1], row[i]});
      }
      below = row;
    }
  }

  std::uint32_t f_;
  std::vector<Vec3> points_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::array<std::array<std::uint32_t, 12>, 12> first_on_edge_{};
};

ErrorInfo bad(std::string problem, std::string hint) {
  return {.code = ErrorCode::bad_argument, .attempted = "making the farfield sphere", .problem = std::move(problem), .hint = std::move(hint)};
}

std::uint32_t frequency(double radius, double edge) {
  const double f = std::max(1.0, std::round(k_edge_ratio * radius / edge));
  if (20.0 * f * f > static_cast<double>(k_most_triangles)) {
    throw Error(bad("an edge length of " + in_metres(edge) + " on a sphere of radius " + in_metres(radius) + " needs more than " +
                        std::to_string(k_most_triangles) + " triangles",
                    "raise farfield.farfield_edge"));
  }
  return static_cast<std::uint32_t>(f);
}

/// Returns the radius of the largest ball around the origin inside the polyhedron.
double inner_radius(const Subdivision& sphere) {
  double least = 1.0;
  for (const auto& t : sphere.triangles()) {
    const Vec3& a = sphere.points()[t[0]];
    least = std::min(least, dot(a, normalized(cross(sphere.points()[t[1]] - a, sphere.points()[t[2]] - a))));
  }
  return least;
}

Vec3 center_of(const TriMesh& wall, const FarfieldOptions& options, std::span<const EndPlane> ends) {
  Vec3 center = bounding_box(wall).center();
  const std::array given = {options.farfield_center_x, options.farfield_center_y, options.farfield_center_z};
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0.0;
    int n_planes = 0;
    for (const EndPlane& end : ends) {
      if (end.axis != k) continue;
      sum += end.at;
      ++n_planes;
    }
    if (n_planes > 0) center[k] = sum / n_planes;
    if (!is_automatic(given[k])) center[k] = given[k];
  }
  return center;
}

void check_encloses(const TriMesh& wall, const Vec3& center, double inner, double length) {
  Vec3 farthest = center;
  for (const Point& p : wall.points) {
    if (norm2(p - center) > norm2(farthest - center)) farthest = p;
  }
  const double needed = distance(farthest, center) + k_margin * length;
  if (needed <= inner) return;
  ErrorInfo error = bad("the flat triangles of the sphere come within " + in_metres(inner) + " of its centre, but the wall and a margin of " +
                            std::to_string(k_margin) + " body lengths reach out to " + in_metres(needed),
                        "raise farfield.farfield_radius (default 50 body lengths, here " + in_metres(k_default_radius * length) + ")");
  error.locations.push_back({farthest, "farthest point of the wall"});
  throw Error(std::move(error));
}

}  // namespace

TriMesh farfield_sphere(const TriMesh& wall, const FarfieldOptions& options, const RunContext& context, std::span<const EndPlane> ends) {
  if (wall.triangles.empty())
    throw Error({.code = ErrorCode::empty_surface, .attempted = "making the farfield sphere", .problem = "the wall has no triangles"});
  const double length = body_length(wall);
  const Vec3 center = center_of(wall, options, ends);
  const double radius = is_automatic(options.farfield_radius) ? k_default_radius * length : options.farfield_radius;
  const double edge = common_edge(options.farfield_edge, k_default_edge * radius);
  const Subdivision sphere(frequency(radius, edge));
  check_encloses(wall, center, radius * inner_radius(sphere), length);
  context.check_stop();

  TriMesh mesh;
  const PatchId patch = mesh.patches.push_back({"farfield", PatchKind::farfield});
  mesh.points.reserve(sphere.points().size());
  for (const Vec3& p : sphere.points()) mesh.points.push_back(center + radius * p);
  mesh.triangles.reserve(sphere.triangles().size());
  // The order of corners is reversed, so normals point inwards.
  for (const auto& t : sphere.triangles()) mesh.triangles.push_back({VertexId(t[0]), VertexId(t[2]), VertexId(t[1])});
  mesh.triangle_patch.assign(mesh.triangles.size(), patch);
  return mesh;
}

}  // namespace sterna::volmesh
