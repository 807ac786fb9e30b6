#include "volmesh/parts/warm_start.h"

#include <algorithm>
#include <cmath>

#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/keep_inside.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/untangle.h"

namespace sterna::volmesh {
namespace {

/// Fraction of the target that counts as full height (layer_report.cpp).
constexpr double k_full_height = 0.9;
/// Smallest sine between an edge and the normal at its end. With a smaller sine the edge does not define a direction in the tangent plane.
constexpr double k_least_sine = 1e-3;

/// The wall around a vertex for given points. Computes the angle-weighted normal, and the smallest cosine between a direction and the normals of the triangles.
class Surroundings {
 public:
  Surroundings(const LayerBase& base, const Column<VertexId, Point>& points) : base_(base), points_(points) {}

  Vec3 normal(VertexId v) const {
    Vec3 sum;
    for_each_corner(v, [&](const Point& a, const Point& b, const Point& c) {
      const Vec3 area = cross(b - a, c - a);
      if (norm2(area) > 0.0) sum += corner_angle(a, b, c) * normalized(area);
    });
    return norm2(sum) > 0.0 ? normalized(sum) : sum;
  }
  double worst_cosine(VertexId v, const Vec3& direction) const {
    double least = 1.0;
    for_each_corner(v, [&](const Point& a, const Point& b, const Point& c) {
      const Vec3 area = cross(b - a, c - a);
      if (norm2(area) > 0.0) least = std::min(least, dot(direction, normalized(area)));
    });
    return least;
  }
  const Point& point(VertexId v) const { return points_[v]; }

 private:
  template <class F>
  void for_each_corner(VertexId v, const F& f) const {
    for (const HalfedgeId h : base_.topology.outgoing(v)) f(points_[v], points_[base_.topology.to(h)], points_[base_.topology.from(previous(h))]);
  }
  const LayerBase& base_;
  const Column<VertexId, Point>& points_;
};

/// Frame of three directions: the normal, an edge projected to the tangent plane, and the direction normal to both.
struct Frame {
  Vec3 normal, along, across;
  Vec3 to_own(const Vec3& v) const { return {dot(v, normal), dot(v, along), dot(v, across)}; }
  Vec3 from_own(const Vec3& v) const { return v.x * normal + v.y * along + v.z * across; }
};

std::optional<Frame> frame_of(const Surroundings& around, VertexId v, VertexId neighbour) {
  const Vec3 normal = around.normal(v), edge = around.point(neighbour) - around.point(v);
  const Vec3 along = edge - dot(edge, normal) * normal;
  if (norm2(normal) == 0.0 || !(norm(along) > k_least_sine * norm(edge))) return std::nullopt;
  const Vec3 unit = normalized(along);
  return Frame{normal, unit, cross(normal, unit)};
}

/// Returns the direction of the start, turned with the wall. The constraints of this wall are not applied yet.
Vec3 carried_direction(const LayerBase& base, const Surroundings& before, const Surroundings& now, VertexId v, const Vec3& direction) {
  for (const HalfedgeId h : base.topology.outgoing(v)) {
    const VertexId neighbour = base.topology.to(h);
    const std::optional<Frame> there = frame_of(before, v, neighbour), here = frame_of(now, v, neighbour);
    if (there && here) return normalized(here->from_own(there->to_own(direction)));
  }
  return base.vertex_normal[v];
}

/// Returns heights and directions of the start, adapted to the present targets. The result is not valid yet. \post where something limited the height of the
/// start, the height is not larger than that
Envelope carried_envelope(const LayerBase& base, const EnvelopeOptions& options, const StartingEnvelope& start, const RunContext& context) {
  Envelope envelope = initial_envelope(base, options, context);
  const Surroundings before(base, start.points), now(base, base.wall.points);
  const EnvelopeScale scale = scale_of(base, options);
  const Envelope& was = start.envelope;
  parallel_for(context, base.wall.n_vertices(), [&](std::size_t i) {
    const VertexId v(i);
    if (envelope.is_collapsed(v)) return;  // the vertex is fixed, or there is no direction from which all faces are visible
    const auto collapse = [&](HeightLimit reason) {
      envelope.height[v] = 0.0;
      envelope.limit[v] = reason;
    };
    if (was.is_collapsed(v)) return collapse(was.limit[v]);
    const Vec3 carried = carried_direction(base, before, now, v, was.direction[v]);
    envelope.direction[v] = pull_into_cone(base, v, carried, before.worst_cosine(v, was.direction[v]));
    double height = was.target[v] > 0.0 ? envelope.target[v] * (was.height[v] / was.target[v]) : envelope.target[v];
    if (was.limit[v] != HeightLimit::none) height = std::min(height, was.height[v]);
    if (was.cap[v] < was.target[v]) envelope.cap[v] = std::min(envelope.cap[v], was.cap[v]);
    if (height < scale.h_min(v)) return collapse(was.limit[v] == HeightLimit::none ? HeightLimit::warp : was.limit[v]);
    envelope.height[v] = height;
    envelope.limit[v] = was.limit[v];
  });
  return envelope;
}

/// Makes the envelope valid and clear. Heights lowered by this grow back where possible.
void make_valid(const LayerBase& base, const EnvelopeOptions& options, Collider& collider, Envelope& envelope, const RunContext& context) {
  const EnvelopeShape before = envelope;
  keep_inside(base, options, envelope, context);
  unwarp(base, options, HeightLimit::warp, envelope, context);
  share_gaps(base, options, collider, envelope, context);
  retract_collisions(base, options, collider, envelope, context);
  if (const std::vector<VertexId> lowered = difference(before, envelope, context).vertices; !lowered.empty())
    regrow_clear(base, collider, envelope, context, &lowered);
  seat_on_surfaces(base, options, &collider, envelope, context);
}

/// Area that has full height in the start but not here, as a fraction of the wall's area, and the vertex at which most of it is missing.
struct Loss {
  double share = 0.0;
  VertexId worst;
};
Loss lost_coverage(const LayerBase& base, const Envelope& was, const Envelope& envelope) {
  double area = 0.0, before = 0.0, now = 0.0, most = 0.0;
  Loss loss;
  for (const VertexId v : envelope.height.ids()) {
    const bool was_full = was.target[v] > 0.0 && normal_height(base, was, v) >= k_full_height * was.target[v];
    const bool is_full = envelope.target[v] > 0.0 && normal_height(base, envelope, v) >= k_full_height * envelope.target[v];
    area += base.vertex_area[v];
    before += was_full ? base.vertex_area[v] : 0.0;
    now += is_full ? base.vertex_area[v] : 0.0;
    if (!was_full || is_full) continue;
    if (const double missing = base.vertex_area[v] * (1.0 - envelope.height[v] / std::max(envelope.target[v], 1e-300));
        !loss.worst.is_valid() || missing > most) {
      most = missing;
      loss.worst = v;
    }
  }
  if (area > 0.0) loss.share = (before - now) / area;
  return loss;
}

}  // namespace

WarmStart warm_start(const LayerBase& base, const EnvelopeOptions& options, const StartingEnvelope& start, Collider& collider, const RunContext& context) {
  const auto refuse = [](std::string objection, const Point& location = {}) { return WarmStart{{}, std::move(objection), location}; };
  const std::size_t n = base.wall.n_vertices();
  if (start.points.size() != n || start.envelope.height.size() != n)
    return refuse("the wall has " + std::to_string(n) + " vertices, but the starting envelope has " + std::to_string(start.points.size()));
  if (!base.groups.empty()) return refuse("the layers on periodic sides must match each other");
  Envelope envelope = carried_envelope(base, options, start, context);
  make_valid(base, options, collider, envelope, context);
  if (const Loss loss = lost_coverage(base, start.envelope, envelope); loss.share > k_lost_coverage)
    return refuse("full height would be lost on " + number_text(100.0 * loss.share, 3) + " % of the area, but at most " +
                      number_text(100.0 * k_lost_coverage, 3) + " % are allowed",
                  base.wall.points[loss.worst]);
  if (const EnvelopeCertificate proof = certify_envelope(base, collider, envelope, context); !proof.is_proved())
    return refuse(std::to_string(proof.n_invalid_macro_elements) + " elements would be invalid and " + std::to_string(proof.n_crossings + proof.n_swallowings) +
                      " surfaces would intersect",
                  proof.worst_macro_element.location);
  return {std::move(envelope), {}, {}};
}

}  // namespace sterna::volmesh
