// Facets are sampled at points of a regular pattern. No point of a facet is farther than `sampling` from a sample. Between two points the distance to the other
// surface changes by no more than the distance of the points. Therefore no point is farther than the largest sample plus `sampling`.
#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/mesh/bvh.h"
#include "surfmesh/repair/repair_state.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_sampling_share = 2e-3;  ///< relative to the body length L
constexpr double k_most_samples = 1e5;     ///< approximate limit for the total number of samples; above it the spacing is increased
constexpr double k_max_steps = 1e4;        ///< largest number of samples in one row

TriMesh mesh_of_facets(const std::vector<Vec3>& points, const std::vector<Facet>& facets) {
  TriMesh mesh;
  mesh.points.raw() = points;
  for (const Facet& f : facets) mesh.triangles.push_back({VertexId(f[0]), VertexId(f[1]), VertexId(f[2])});
  return mesh;
}

/// Calls visit for samples of a triangle. The samples lie in rows parallel to its longest edge. The rows, and the samples within a row, are one spacing apart.
template <class Visit>
void sample(std::array<Vec3, 3> c, double spacing, const Visit& visit) {
  if (distance(c[1], c[2]) > distance(c[0], c[1])) c = {c[1], c[2], c[0]};
  if (distance(c[1], c[2]) > distance(c[0], c[1])) c = {c[1], c[2], c[0]};
  const auto steps = [&](double length) { return std::max(1, static_cast<int>(std::ceil(std::min(length / spacing, k_max_steps)))); };
  const int n_rows = steps(std::min(distance(c[0], c[2]), distance(c[1], c[2])));
  for (int row = 0; row <= n_rows; ++row) {
    const double t = static_cast<double>(row) / n_rows;
    const Vec3 a = c[0] + t * (c[2] - c[0]), b = c[1] + t * (c[2] - c[1]);
    const int n = row == n_rows ? 0 : steps(distance(a, b));
    for (int i = 0; i <= n; ++i) visit(a + (n > 0 ? static_cast<double>(i) / n : 0.0) * (b - a));
  }
}

/// Key of a facet: the coordinates of its corners, independent of their order.
using FacetKey = std::array<std::array<double, 3>, 3>;
FacetKey key_of(const std::array<Vec3, 3>& c) {
  FacetKey key;
  for (std::size_t k = 0; k < 3; ++k) key[k] = {c[k].x, c[k].y, c[k].z};
  std::sort(key.begin(), key.end());
  return key;
}

/// Returns the keys in ascending order.
std::vector<FacetKey> keys_of(const std::vector<Vec3>& points, const std::vector<Facet>& facets) {
  std::vector<FacetKey> keys;
  for (const Facet& f : facets) keys.push_back(key_of({points[f[0]], points[f[1]], points[f[2]]}));
  std::sort(keys.begin(), keys.end());
  return keys;
}

struct Farthest {
  double given = 0.0, filled = 0.0;
};

}  // namespace

void measure_changes(RepairState& state, const std::vector<Vec3>& input_points, const std::vector<Facet>& input_facets, const RunContext& context) {
  const auto combine = [](Farthest a, const Farthest& b) { return Farthest{std::max(a.given, b.given), std::max(a.filled, b.filled)}; };
  const std::vector<FacetKey> input_keys = keys_of(input_points, input_facets), result_keys = keys_of(state.points, state.facets);
  double area = 0.0;
  for (std::size_t t = 0; t < state.facets.size(); ++t) {
    const auto c = state.corners(t);
    if (!std::binary_search(input_keys.begin(), input_keys.end(), key_of(c))) area += triangle_area(c[0], c[1], c[2]);
  }
  const double spacing = std::max(k_sampling_share * state.length, std::sqrt(area / k_most_samples));
  const TriangleTree input(mesh_of_facets(input_points, input_facets), context);
  const Farthest out = parallel_reduce(
      context, state.facets.size(), Farthest{},
      [&](std::size_t begin, std::size_t end) {
        Farthest far;
        for (std::size_t t = begin; t < end; ++t) {
          if (std::binary_search(input_keys.begin(), input_keys.end(), key_of(state.corners(t)))) continue;  // the facet is unchanged
          double& value = state.info[t].mark == FacetMark::given ? far.given : far.filled;
          sample(state.corners(t), spacing, [&](const Vec3& p) { value = std::max(value, input.nearest(p).distance); });
        }
        return far;
      },
      combine, 256);
  const TriangleTree result(mesh_of_facets(state.points, state.facets), context);
  const Farthest in = parallel_reduce(
      context, input_facets.size(), Farthest{},
      [&](std::size_t begin, std::size_t end) {
        Farthest far;
        for (std::size_t t = begin; t < end; ++t) {
          const Facet& f = input_facets[t];
          const std::array<Vec3, 3> c{input_points[f[0]], input_points[f[1]], input_points[f[2]]};
          if (std::binary_search(result_keys.begin(), result_keys.end(), key_of(c))) continue;
          sample(c, spacing, [&](const Vec3& p) { far.given = std::max(far.given, result.nearest(p).distance); });
        }
        return far;
      },
      combine, 256);
  state.report.moved = out.given;
  state.report.from_result = std::max(out.given, out.filled);
  state.report.from_input = in.given;
  state.report.sampling = spacing;
}

}  // namespace sterna::surfmesh
