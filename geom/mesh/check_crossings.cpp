// G2: tests all boundary faces and the envelope for crossings, in one exact triangle-triangle test.
#include "geom/math/measures.h"
#include "geom/math/predicates.h"
#include "geom/mesh/baffles.h"
#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {
namespace {

/// Adds both triangulations of a quad, so that anything that crosses the bilinear surface on either side of a diagonal is found. In a planar quad the two
/// would overlap, so one suffices. Faces with a repeated node are left out (reported as bad_index).
void add_face(const HybridMesh& mesh, const FaceSlots& slots, std::uint32_t slot, CrossingCandidates& candidates) {
  const Face face = slots.face(slot);
  const auto add = [&](std::size_t i, std::size_t j, std::size_t k) {
    const std::array<std::uint32_t, 3> nodes = {face.nodes[i].value(), face.nodes[j].value(), face.nodes[k].value()};
    if (nodes[0] == nodes[1] || nodes[1] == nodes[2] || nodes[2] == nodes[0]) return;
    candidates.triangles.push_back(nodes);
    candidates.slots.push_back(slot);
  };
  add(0, 1, 2);
  if (face.size == 3) return;
  add(0, 2, 3);
  const auto point = [&](std::size_t k) { return mesh.points[face.nodes[k]]; };
  if (orient3d(point(0), point(1), point(2), point(3)) == 0) return;
  add(0, 1, 3);
  add(1, 2, 3);
}

CrossingCandidates collect_candidates(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match) {
  std::vector<std::uint32_t> doubled;  // duplicates of a face, which is tested once; G1 reports the duplicates
  for (const FaceIssue& issue : match.issues)
    if (issue.violation == Violation::duplicate_marker) doubled.push_back(issue.slot);
  std::sort(doubled.begin(), doubled.end());
  std::vector<std::uint32_t> envelope = match.interface;
  std::sort(envelope.begin(), envelope.end());
  return crossing_candidates(mesh, slots, doubled, envelope);
}

}  // namespace

CrossingCandidates crossing_candidates(const HybridMesh& mesh, const FaceSlots& slots, std::span<const std::uint32_t> doubled,
                                       std::span<const std::uint32_t> envelope) {
  // The two sides of a baffle count once, and so do their nodes.
  const BaffleSides baffles = find_baffle_sides(mesh);
  CrossingCandidates candidates;
  for (std::uint32_t slot = slots.first_boundary(); slot < slots.size(); ++slot)
    if (!std::binary_search(doubled.begin(), doubled.end(), slot) && !baffles.is_second(slot - slots.first_boundary())) add_face(mesh, slots, slot, candidates);
  for (const std::uint32_t slot : envelope) add_face(mesh, slots, slot, candidates);
  if (baffles.empty()) return candidates;
  for (auto& triangle : candidates.triangles)
    for (std::uint32_t& node : triangle) node = baffles.twin[node];
  return candidates;
}

void check_crossings(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const CrossingTest* ahead, const RunContext& context,
                     Findings& findings) {
  const CrossingCandidates candidates = collect_candidates(mesh, slots, match);
  const bool is_done = ahead && ahead->triangles == candidates.triangles;
  const CrossingPairs crossings = is_done ? ahead->crossings : find_crossings(mesh.points.raw(), candidates.triangles, context);
  const auto corners_of = [&](std::uint32_t t) {
    const auto& v = candidates.triangles[t];
    return std::array{mesh.points.raw()[v[0]], mesh.points.raw()[v[1]], mesh.points.raw()[v[2]]};
  };
  const auto name_of = [&](std::uint32_t slot) { return slots.is_boundary(slot) ? slots.name(slot) : "the envelope face of " + slots.name(slot); };
  for (const auto& [a, b] : crossings.pairs) {
    const std::uint32_t slot_a = candidates.slots[a], slot_b = candidates.slots[b];
    const bool is_envelope = !slots.is_boundary(slot_a) || !slots.is_boundary(slot_b);
    findings.add(is_envelope ? Violation::envelope_intersection : Violation::boundary_intersection, [&, a = a, b = b] {
      // The smaller triangle's centre is nearer to the crossing.
      const auto ca = corners_of(a), cb = corners_of(b);
      const auto& c = triangle_area(ca[0], ca[1], ca[2]) <= triangle_area(cb[0], cb[1], cb[2]) ? ca : cb;
      const Point location = (c[0] + c[1] + c[2]) / 3.0;
      std::string what = name_of(slot_a) + " crosses " + name_of(slot_b);
      if (!slots.is_boundary(slot_a) && !slots.is_boundary(slot_b)) what += near_patch(mesh, location);
      return std::pair(location, std::move(what));
    });
  }
}

}  // namespace sterna::check_parts
