#include "volmesh/envelope/set_upright.h"

#include <algorithm>
#include <array>
#include <vector>

#include "geom/base/parallel.h"
#include "geom/base/sort_unique.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/retract.h"

namespace sterna::volmesh {
namespace {

constexpr double k_lean_cosine = 0.26;  ///< 75 degrees: largest angle between a facet's normal and the direction from cell to cell
constexpr double k_seen_cosine = 0.2;   ///< 78 degrees: largest angle between a facet's normal and a growth line
constexpr double k_seen_share = 0.85;   ///< fraction of the best possible cosine that is required, if it is less than the limit above
constexpr std::array<double, 3> k_upright_heights = {1.0, 0.7, 0.4};  ///< fractions of a growth line's height, tried in this order
constexpr std::size_t k_facet_chunk = 256;

/// Returns the step in metres along the growth line at v from the wall to its first node, for a straight growth line.
Vec3 straight_step(const LayerBase& base, const EnvelopeScale& scale, const Envelope& envelope, VertexId v) {
  if (envelope.is_collapsed(v)) return {};
  const double least = std::max(normal_height(base, envelope, v), height_for_first_cell(scale.growth(v), scale.n(v)));
  return scale.first_step(v) / least * envelope.height[v] * envelope.direction[v];
}

/// Returns the cosine between a facet's normal and the direction from the centre of one flat cell above the facet to the centre of the next. In this direction
/// corner i has the weight (1 + a_i / (a_1 + a_2 + a_3)) / 4, where a_i is its height above the facet (growth_law.h).
double column_cosine(const std::array<Vec3, 3>& steps, const Vec3& normal) {
  std::array<double, 3> a{};
  for (std::size_t k = 0; k < 3; ++k) a[k] = std::max(0.0, dot(steps[k], normal));
  const double sum = a[0] + a[1] + a[2];
  if (!(sum > 0.0)) return 1.0;
  Vec3 way;
  for (std::size_t k = 0; k < 3; ++k) way += 0.25 * (1.0 + a[k] / sum) * steps[k];
  return dot(way, normal) / norm(way);
}

/// Returns the inclined growth lines at facets with inclined flat cells, ascending.
std::vector<VertexId> leaning_lines(const LayerBase& base, const EnvelopeScale& scale, const Envelope& envelope, const RunContext& context) {
  std::vector<VertexId> lines = parallel_collect<VertexId>(
      context, base.wall.n_triangles(),
      [&](std::size_t begin, std::size_t end, std::vector<VertexId>& found) {
        for (std::size_t i = begin; i < end; ++i) {
          const TriangleVertices& v = base.wall.triangles[TriangleId(i)];
          const Vec3& normal = base.unit_normal[TriangleId(i)];
          const auto leans = [&](VertexId w, double cosine) { return !envelope.is_collapsed(w) && dot(envelope.direction[w], normal) < cosine; };
          // If no growth line is outside the cone, their mean is not outside either.
          if (std::ranges::none_of(v, [&](VertexId w) { return leans(w, k_lean_cosine); })) continue;
          const auto step = [&](VertexId w) { return straight_step(base, scale, envelope, w); };
          if (column_cosine({step(v[0]), step(v[1]), step(v[2])}, normal) >= k_lean_cosine) continue;
          for (const VertexId w : v)
            if (leans(w, k_seen_cosine) && base.multi_normal_of(w) == nullptr) found.push_back(w);
        }
      },
      k_facet_chunk);
  sort_unique(lines);
  return lines;
}

}  // namespace

void set_upright(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context) {
  if (!has_common_growth(options)) return;
  const EnvelopeScale scale = scale_of(base, options);
  for (const double share : k_upright_heights) {
    ShapeChange change;
    for (const VertexId v : leaning_lines(base, scale, envelope, context)) {
      const Vec3 upright = pull_towards_visible(base, v, envelope.direction[v], std::min(k_seen_cosine, k_seen_share * base.visibility[v]));
      if (upright == envelope.direction[v]) continue;
      change.vertices.push_back(v);
      change.direction.push_back(upright);
      change.height.push_back(share * envelope.height[v]);
    }
    if (change.vertices.empty()) return;
    for (const VertexId v : apply_where_clear(base, collider, envelope, std::move(change), context))
      if (share < 1.0 && envelope.limit[v] == HeightLimit::none) envelope.limit[v] = HeightLimit::warp;
  }
}

}  // namespace sterna::volmesh
