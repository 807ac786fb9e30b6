// Steps: find_trouble; rings around the defects; proposal of heights and directions; apply_where_clear.
#include "volmesh/layer/repair_envelope.h"

#include <algorithm>

#include "geom/base/parallel.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/tetra/preflight.h"

namespace sterna::volmesh {
namespace {

/// Factor on the mean height around the defect, at the defect itself; 0.9 would hardly change the boundary, and 0.5 would cost too much layer height.
constexpr double k_lowered = 0.7;
constexpr std::uint8_t k_rings = 4;  ///< number of rings over which the reduction decreases to zero, so that no step causes another defect
constexpr std::uint8_t k_far = 255;

/// Marks vertices of the layer's top that have a defect as ring 0.
Column<VertexId, std::uint8_t> find_trouble(const LayerBase& base, const FillBoundary& boundary, BoundaryTraits traits,
                                            const std::vector<ErrorLocation>& locations, const RunContext& context) {
  Column<VertexId, std::uint8_t> ring(base.wall.n_vertices(), k_far);
  const TetraBoundary top{.points = boundary.points, .triangles = boundary.triangles, .hole_points = {}, .traits = traits};
  for (const PreflightFinding& finding : preflight(top, {.searches_crossings = false}, context).findings)
    for (const std::uint32_t t : finding.triangles)
      if (t < base.wall.n_triangles())
        for (std::size_t k = 0; k < 3; ++k) {  // opened ridges change the order of triangles, and disc cuts add growth lines
          const std::uint32_t p = boundary.triangles[t][k];
          ring[p < ring.size() ? VertexId(p) : base.wall.triangles[TriangleId(t)][k]] = 0;
        }
  for (const ErrorLocation& location : locations) {
    const auto end = boundary.points.begin() + static_cast<std::ptrdiff_t>(base.wall.n_vertices());
    const auto nearest = std::min_element(boundary.points.begin(), end,
                                          [&](const Vec3& a, const Vec3& b) { return distance(a, location.position) < distance(b, location.position); });
    ring[VertexId(static_cast<std::size_t>(nearest - boundary.points.begin()))] = 0;
  }
  return ring;
}

void number_rings(const LayerBase& base, Column<VertexId, std::uint8_t>& ring) {
  for (std::uint8_t next = 1; next <= k_rings; ++next)
    for (const VertexId v : ring.ids())
      if (ring[v] == k_far && std::ranges::any_of(base.topology.neighbours(v), [&](VertexId w) { return ring[w] == next - 1; })) ring[v] = next;
}

/// Proposes another height and direction for one vertex. Collapsed vertices and constrained directions are not changed.
void lower_and_smooth(const LayerBase& base, const Envelope& envelope, VertexId v, double share, EnvelopeShape& proposal) {
  if (envelope.is_collapsed(v)) return;
  double height = envelope.height[v];
  Vec3 direction = envelope.direction[v];
  int n = 1;
  for (const VertexId w : base.topology.neighbours(v)) {
    if (envelope.is_collapsed(w)) continue;
    height += envelope.height[w];
    direction += envelope.direction[w];
    ++n;
  }
  proposal.height[v] = std::min(envelope.height[v], share * height / n);
  const Vec3 smooth = normalized(direction);
  if (base.constraint[v].freedom == Freedom::free && base.worst_cosine(v, smooth) >= std::min(base.worst_cosine(v, envelope.direction[v]), 0.5))
    proposal.direction[v] = smooth;
}

}  // namespace

std::vector<VertexId> repair_envelope(const LayerBase& base, const FillBoundary& boundary, BoundaryTraits traits, const std::vector<ErrorLocation>& locations,
                                      Collider& collider, Envelope& envelope, const RunContext& context) {
  Column<VertexId, std::uint8_t> ring = find_trouble(base, boundary, traits, locations, context);
  number_rings(base, ring);
  EnvelopeShape proposal = envelope;
  for (const VertexId v : ring.ids())
    if (ring[v] != k_far) lower_and_smooth(base, envelope, v, k_lowered + (1.0 - k_lowered) * ring[v] / (k_rings + 1.0), proposal);
  return apply_where_clear(base, collider, envelope, proposal, context, 1.0);
}

}  // namespace sterna::volmesh
