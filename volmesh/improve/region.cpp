#include "volmesh/improve/region.h"

#include <algorithm>

#include "geom/math/predicates.h"
#include "volmesh/improve/tet_quality.h"

namespace sterna::volmesh {
namespace {

/// A change must raise the worst quality by this factor: progress that cannot go on for ever.
constexpr double k_gain = 1.01;
/// The class that is not worked on must not lose; beyond that its qualities count for more, lest they hide progress of the other.
constexpr double k_slack = 2.0;
/// Changes per region before the mesh takes a fresh look at what is worst.
constexpr int k_max_changes = 12;

}  // namespace

QualityLimits quality_limits(double min_angle, double max_angle) {
  return {.target = std::sin(min_angle), .obtuse_weight = std::sin(min_angle) / std::sin(max_angle)};
}

void Region::assign(std::span<const Vec3> points, std::span<const VertexRole> roles, std::span<const Corners> tets) {
  points_.assign(points.begin(), points.end());
  roles_.assign(roles.begin(), roles.end());
  for (auto& list : incident_) list.clear();
  incident_.resize(std::max(incident_.size(), points.size()));
  tets_.clear();
  for (const Corners& corners : tets) {
    for (const std::uint32_t v : corners) incident_[v].push_back(static_cast<std::uint32_t>(tets_.size()));
    tets_.push_back({corners, quality(corners)});
  }
}

double Region::quality(const Corners& c) const { return tet_quality(points_[c[0]], points_[c[1]], points_[c[2]], points_[c[3]], limits_.obtuse_weight); }

bool Region::touches_boundary(const Corners& c) const {
  return std::ranges::any_of(c, [&](std::uint32_t v) { return v < roles_.size() && roles_[v] == VertexRole::boundary; });
}
bool Region::touches_boundary(const Face& face) const {
  return std::ranges::any_of(face, [&](std::uint32_t v) { return roles_[v] == VertexRole::boundary; });
}

void Region::compare_with(std::span<const std::uint32_t> removed) {
  before_ = {limits_.target, limits_.target};
  for (const std::uint32_t t : removed) {
    double& before = before_[touches_boundary(tets_[t].corners)];
    before = std::min(before, tets_[t].quality);
  }
}

double Region::gain_of(double quality, bool is_boundary) const {
  if (quality <= 0.0) return -1.0;
  const double gain = quality / before_[is_boundary];
  if (is_boundary == is_for_boundary_) return gain;
  return gain < 1.0 ? -1.0 : k_slack * gain;
}

double Region::gain(const Face& face, const Vec3& apex, bool is_boundary) const {
  return gain_of(tet_quality(points_[face[0]], points_[face[1]], points_[face[2]], apex, limits_.obtuse_weight), is_boundary);
}

Region::Face Region::opposite(const Corners& c, std::size_t corner) {
  constexpr std::uint8_t k_faces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  return {c[k_faces[corner][0]], c[k_faces[corner][1]], c[k_faces[corner][2]]};
}

bool Region::apply(const Change& change) {
  if (!(change.gain > k_gain)) return false;
  const auto place = [&](std::uint32_t v) -> const Vec3& { return v == change.moved ? change.place : points_[v]; };
  // Cavities grew while they were compared with what they had at first.
  compare_with(change.removed);
  for (const Corners& c : change.added) {
    const Vec3 &p0 = place(c[0]), &p1 = place(c[1]), &p2 = place(c[2]), &p3 = place(c[3]);
    if (orient3d(p0, p1, p2, p3) <= 0) return false;
    const bool is_boundary = touches_boundary(c);
    if (gain_of(tet_quality(p0, p1, p2, p3, limits_.obtuse_weight), is_boundary) <= (is_boundary == is_for_boundary_ ? k_gain : 0.0)) return false;
  }

  if (change.moved == points_.size()) {
    points_.push_back(change.place);
    roles_.push_back(VertexRole::free);
    incident_.resize(std::max(incident_.size(), points_.size()));
  } else if (change.moved != k_none) {
    points_[change.moved] = change.place;
  }
  for (const std::uint32_t t : change.removed) {
    tets_[t].is_alive = false;
    for (const std::uint32_t v : tets_[t].corners) std::erase(incident_[v], t);
  }
  for (const Corners& c : change.added) {
    for (const std::uint32_t v : c) incident_[v].push_back(static_cast<std::uint32_t>(tets_.size()));
    tets_.push_back({c, quality(c)});
  }
  return true;
}

bool Region::help(std::uint32_t tet) { return remove_edge_or_faces(tet) || smooth(tet) || contract(tet) || insert(tet); }

bool Region::improve(std::uint32_t tet) {
  for (int n_changes = 0; n_changes < k_max_changes; ++n_changes) {
    is_for_boundary_ = touches_boundary(tets_[tet].corners);
    const std::size_t n_before = tets_.size();
    if (!help(tet)) return n_changes > 0;
    const auto is_worse = [&](std::uint32_t t) { return tets_[t].is_alive && tets_[t].quality < limits_.target; };
    std::uint32_t next = is_worse(tet) ? tet : k_none;
    for (auto t = static_cast<std::uint32_t>(n_before); t < tets_.size(); ++t)
      if (is_worse(t) && (next == k_none || tets_[t].quality < tets_[next].quality)) next = t;
    if (next == k_none) return true;
    tet = next;
  }
  return true;
}

}  // namespace sterna::volmesh
