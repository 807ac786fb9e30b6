#include "volmesh/envelope/smooth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/parallel.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/multi_normal_taper.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

constexpr double k_relaxation = 0.5;  ///< docs/method/envelope.md, "Smoothing"
/// Smoothing may lower a height of the envelope to this fraction of its upper limit, which is well above the 0.9 that counts as full height.
constexpr double k_smooth_floor = 0.94;
/// Directions may be inclined to the face normals by up to 65 degrees; if that is not possible, half the best possible cosine must remain.
constexpr double k_cone_cosine = 0.4226;
/// Weight of a vertex on a convex feature. It is small because such a feature needs no room, and its multi-normal fan must not tilt the growth lines of the
/// smooth surface beside it.
constexpr double k_convex_feature_weight = 0.2;
constexpr int k_concave_rings = 8;  ///< number of rings of the wide smoothing around concave features; a layer is 4 to 9 edges thick by eq. (1)
constexpr int k_region_rounds = 6;
constexpr double k_worthwhile_share = 0.93;  ///< another round is made only if the last one reduced the number of invalid elements to at most this fraction
constexpr int k_region_rings = 6;

/// Calls f(neighbour, weight) for the vertices that the smoothing of v uses.
template <class F>
void for_each_partner(const LayerBase& base, const Classification& classes, VertexId v, const F& f) {
  const VertexClass& own = classes.vertex[v];
  if (own.is_corner) return;
  if (own.is_ridge) {
    for_each_edge(base.topology, v, [&](HalfedgeId h, VertexId other) {
      if (classes.is_feature[h]) f(other, base.mirror_weight(v, other) / distance(base.wall.points[v], base.wall.points[other]));
    });
    return;
  }
  for (const VertexId other : base.topology.neighbours(v)) {
    if (base.share_base_vertex(v, other)) continue;
    const VertexClass& flags = classes.vertex[other];
    const bool is_convex_feature = !flags.is_smooth() && flags.is_convex && !flags.is_concave;
    f(other, base.mirror_weight(v, other) * (is_convex_feature ? k_convex_feature_weight : 1.0) / distance(base.wall.points[v], base.wall.points[other]));
  }
}

}  // namespace

void grow_region(const LayerBase& base, int rings, Column<VertexId, std::uint8_t>& region, const RunContext& context) {
  for (int ring = 0; ring < rings; ++ring) {
    Column<VertexId, std::uint8_t> next = region;
    parallel_for(context, region.size(), [&](std::size_t i) {
      const VertexId v(i);
      if (region[v]) return;
      for (const VertexId other : base.topology.neighbours(v))
        if (region[other]) next[v] = 1;
    });
    region = std::move(next);
  }
}

void smooth_heights(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope, const RunContext& context) {
  for (int sweep = 0; sweep < options.height_sweeps; ++sweep) {
    Column<VertexId, double> next = envelope.height;
    parallel_for(context, next.size(), [&](std::size_t i) {
      const VertexId v(i);
      if (envelope.is_collapsed(v)) return;
      double sum = 0.0, weights = 0.0;
      for_each_partner(base, classes, v, [&](VertexId other, double weight) {
        if (envelope.is_collapsed(other)) return;
        sum += weight * std::log(envelope.height[other]);
        weights += weight;
      });
      if (weights == 0.0) return;
      const double own = std::log(envelope.height[v]);
      double h = std::exp(own + k_relaxation * (sum / weights - own));
      if (classes.vertex[v].is_concave) h = std::min(h, envelope.height[v]);
      const double ceiling = std::min(envelope.target[v], envelope.cap[v]);
      next[v] = std::clamp(h, std::min(options.height_floor * ceiling, envelope.height[v]), ceiling);
    });
    envelope.height = std::move(next);
  }
  for (const VertexId v : envelope.height.ids())
    if (!envelope.is_collapsed(v)) envelope.cap[v] = std::min(envelope.cap[v], envelope.height[v]);
}

void smooth_directions(const LayerBase& base, const Classification& classes, int sweeps, Envelope& envelope, const RunContext& context,
                       const Column<VertexId, std::uint8_t>* region) {
  std::vector<VertexId> moving;
  for (const VertexId v : envelope.direction.ids())
    if ((!region || (*region)[v]) && !classes.vertex[v].is_corner && base.visibility[v] > 0.0 && !is_tapered(base, envelope, v)) moving.push_back(v);
  std::vector<Vec3> next(moving.size());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    parallel_for(context, moving.size(), [&](std::size_t i) {
      const VertexId v = moving[i];
      Vec3 sum;
      double weights = 0.0;
      for_each_partner(base, classes, v, [&](VertexId other, double weight) {
        sum += weight * envelope.direction[other];
        weights += weight;
      });
      const Vec3 mean = weights > 0.0 ? sum / weights : envelope.direction[v];
      const Vec3 d = normalized(envelope.direction[v] + k_relaxation * (mean - envelope.direction[v]));
      next[i] = norm2(d) > 0.0 ? pull_into_cone(base, v, d, k_cone_cosine) : envelope.direction[v];
    });
    parallel_for(context, moving.size(), [&](std::size_t i) { envelope.direction[moving[i]] = next[i]; });
  }
}

Column<VertexId, std::uint8_t> concave_region(const LayerBase& base, const Classification& classes, const RunContext& context) {
  Column<VertexId, std::uint8_t> region(base.wall.n_vertices());
  for (const VertexId v : region.ids()) region[v] = classes.vertex[v].is_concave ? 1 : 0;
  grow_region(base, k_concave_rings, region, context);
  return region;
}

void smooth_tangled_regions(const LayerBase& base, const Classification& classes, const EnvelopeOptions& options, Envelope& envelope,
                            const RunContext& context) {
  std::size_t n_before = std::numeric_limits<std::size_t>::max();
  for (int round = 0; round < k_region_rounds; ++round) {
    const std::vector<TriangleId> bad = invalid_macros(base, envelope, context);
    if (bad.empty() || static_cast<double>(bad.size()) > k_worthwhile_share * static_cast<double>(n_before)) return;
    n_before = bad.size();
    Column<VertexId, std::uint8_t> region(base.wall.n_vertices(), 0);
    for (const TriangleId t : bad)
      for (const VertexId v : base.wall.triangles[t]) region[v] = 1;
    grow_region(base, k_region_rings, region, context);
    smooth_directions(base, classes, options.direction_sweeps, envelope, context, &region);
  }
}

Envelope relaxed(const LayerBase& base, const Classification& classes, const Column<VertexId, std::uint8_t>& region, const Envelope& envelope,
                 const RunContext& context) {
  Envelope proposal = envelope;
  parallel_for(context, base.wall.n_vertices(), [&](std::size_t i) {
    const VertexId v(i);
    if (!region[v] || envelope.is_collapsed(v) || !classes.vertex[v].is_smooth() || is_tapered(base, envelope, v)) return;
    Vec3 sum;
    double weights = 0.0;
    for_each_partner(base, classes, v, [&](VertexId other, double weight) {
      sum += weight * (envelope.height[other] * envelope.direction[other]);
      weights += weight;
    });
    if (weights == 0.0) return;
    // The Laplacian of the wall is subtracted from that of the envelope. Otherwise the curvature of a coarse wall would outweigh a thin layer.
    const Vec3 own = envelope.height[v] * envelope.direction[v];
    const Vec3 growth = project(base.constraint[v], own + k_relaxation * (sum / weights - own));
    const double length = norm(growth);
    if (length == 0.0) return;
    const double ceiling = std::min(envelope.target[v], envelope.cap[v]);
    proposal.direction[v] = pull_into_cone(base, v, growth / length, k_cone_cosine);
    proposal.height[v] = std::clamp(length, std::min(k_smooth_floor * ceiling, envelope.height[v]), std::max(ceiling, envelope.height[v]));
  });
  return proposal;
}

void smooth_envelope(const LayerBase& base, const Classification& classes, int sweeps, Envelope& envelope, const RunContext& context) {
  const Column<VertexId, std::uint8_t> everywhere(base.wall.n_vertices(), 1);
  for (int sweep = 0; sweep < sweeps; ++sweep) apply_where_valid(base, envelope, relaxed(base, classes, everywhere, envelope, context), context);
}

}  // namespace sterna::volmesh
