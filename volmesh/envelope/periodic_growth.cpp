#include "volmesh/envelope/periodic_growth.h"

#include <algorithm>
#include <array>
#include <span>

#include "volmesh/envelope/retract.h"
#include "volmesh/envelope/untangle.h"
#include "volmesh/envelope/validity.h"

namespace sterna::volmesh {
namespace {

constexpr int k_rounds = 20;  ///< number of rounds, after which vertices that are not equal collapse

/// Returns the direction with the best visibility of the triangles of all members. Candidates are the directions of the members and their mean.
Vec3 common_direction(const LayerBase& base, const Envelope& envelope, const std::vector<VertexId>& group) {
  std::vector<Vec3> candidates;
  Vec3 sum;
  for (const VertexId v : group) {
    candidates.push_back(envelope.direction[v]);
    sum += envelope.direction[v];
  }
  if (std::ranges::all_of(candidates, [&](const Vec3& d) { return d == candidates.front(); })) return candidates.front();
  const Vec3 mean = constrained(base.constraint[group.front()], sum);
  if (norm2(mean) > 0.0) candidates.insert(candidates.begin(), mean);
  Vec3 best = candidates.front();
  double best_cosine = -2.0;
  for (const Vec3& d : candidates) {
    double cosine = 2.0;
    for (const VertexId v : group) cosine = std::min(cosine, base.worst_cosine(v, d));
    if (cosine <= best_cosine) continue;
    best_cosine = cosine;
    best = d;
  }
  return best;
}

}  // namespace

std::vector<VertexId> equalise_partners(const LayerBase& base, const EnvelopeOptions& options, Collider* collider, Envelope& envelope,
                                        const RunContext& context) {
  if (base.groups.empty() && base.level.empty()) return {};
  const EnvelopeScale scale = scale_of(base, options);
  const EnvelopeShape before = envelope;
  for (const std::vector<VertexId>& group : base.groups) {
    const Vec3 direction = common_direction(base, envelope, group);
    for (const VertexId v : group) envelope.direction[v] = direction;
  }
  for (int round = 0;; ++round) {
    context.check_stop();
    bool is_equal = true;
    const auto make_level = [&](std::span<const VertexId> group) {
      const VertexId lowest = *std::ranges::min_element(group, {}, [&](VertexId v) { return envelope.height[v]; });
      const bool is_same = std::ranges::all_of(group, [&](VertexId v) { return envelope.height[v] == envelope.height[lowest]; });
      if (is_same) return;
      is_equal = false;
      const double height = round < k_rounds ? envelope.height[lowest] : 0.0;
      const HeightLimit reason = envelope.limit[lowest];
      for (const VertexId v : group) lower(envelope, v, height, reason, scale);
    };
    for (const std::vector<VertexId>& group : base.groups) make_level(group);
    for (const std::array<VertexId, 2>& pair : base.level) make_level(pair);
    if (is_equal && round > 0) break;
    std::vector<VertexId> changed = difference(before, envelope, context).vertices;
    if (changed.empty()) break;
    unwarp(base, options, HeightLimit::warp, envelope, context, &changed);
    if (!collider) continue;
    changed = difference(before, envelope, context).vertices;
    retract_collisions(base, options, *collider, envelope, context, &changed);
  }
  return difference(before, envelope, context).vertices;
}

}  // namespace sterna::volmesh
