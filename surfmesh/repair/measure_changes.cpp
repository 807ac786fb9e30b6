// Facets are sampled at points of a regular pattern whose gaps are at most `sampling`; the distance to the other surface changes by no more than the way, so no
// point is farther than the largest sample plus that.
#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "geom/mesh/bvh.h"
#include "surfmesh/repair/repair_state.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_sampling_share = 2e-3;  ///< of L
constexpr int k_max_cuts = 64;             ///< of an edge: a facet as long as the body has 2145 samples at most

TriMesh mesh_of_facets(const std::vector<Vec3>& points, const std::vector<Facet>& facets) {
  TriMesh mesh;
  mesh.points.raw() = points;
  for (const Facet& f : facets) mesh.triangles.push_back({VertexId(f[0]), VertexId(f[1]), VertexId(f[2])});
  return mesh;
}

/// Calls visit for samples of a triangle. \return how far a point of it is from the nearest sample at most
template <class Visit>
double sample(const std::array<Vec3, 3>& c, double spacing, const Visit& visit) {
  const double longest = std::max({distance(c[0], c[1]), distance(c[1], c[2]), distance(c[2], c[0])});
  const int n = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, k_max_cuts);
  const Vec3 u = (c[1] - c[0]) / n, v = (c[2] - c[0]) / n;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n - i; ++j) visit(c[0] + static_cast<double>(i) * u + static_cast<double>(j) * v);
  return longest / n;
}

/// A facet by its corners' coordinates, whatever their order.
using FacetKey = std::array<std::array<double, 3>, 3>;
FacetKey key_of(const std::array<Vec3, 3>& c) {
  FacetKey key;
  for (std::size_t k = 0; k < 3; ++k) key[k] = {c[k].x, c[k].y, c[k].z};
  std::sort(key.begin(), key.end());
  return key;
}

/// Ascending.
std::vector<FacetKey> keys_of(const std::vector<Vec3>& points, const std::vector<Facet>& facets) {
  std::vector<FacetKey> keys;
  for (const Facet& f : facets) keys.push_back(key_of({points[f[0]], points[f[1]], points[f[2]]}));
  std::sort(keys.begin(), keys.end());
  return keys;
}

struct Farthest {
  double given = 0.0, filled = 0.0, spacing = 0.0;
};

}  // namespace

void measure_changes(RepairState& state, const std::vector<Vec3>& input_points, const std::vector<Facet>& input_facets, const RunContext& context) {
  const auto combine = [](Farthest a, const Farthest& b) { return Farthest{std::max(a.given, b.given), std::max(a.filled, b.filled), std::max(a.spacing, b.spacing)}; };
  const double spacing = k_sampling_share * state.length;
  const std::vector<FacetKey> input_keys = keys_of(input_points, input_facets), result_keys = keys_of(state.points, state.facets);
  const TriangleTree input(mesh_of_facets(input_points, input_facets), context);
  const Farthest out = parallel_reduce(
      context, state.facets.size(), Farthest{},
      [&](std::size_t begin, std::size_t end) {
        Farthest far;
        for (std::size_t t = begin; t < end; ++t) {
          if (std::binary_search(input_keys.begin(), input_keys.end(), key_of(state.corners(t)))) continue;  // as it was
          double& value = state.info[t].mark == FacetMark::given ? far.given : far.filled;
          far.spacing = std::max(far.spacing, sample(state.corners(t), spacing, [&](const Vec3& p) { value = std::max(value, input.nearest(p).distance); }));
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
          far.spacing = std::max(far.spacing, sample(c, spacing,
                                                     [&](const Vec3& p) { far.given = std::max(far.given, result.nearest(p).distance); }));
        }
        return far;
      },
      combine, 256);
  state.report.moved = out.given;
  state.report.from_result = std::max(out.given, out.filled);
  state.report.from_input = in.given;
  state.report.sampling = std::max(out.spacing, in.spacing);
}

}  // namespace sterna::surfmesh
