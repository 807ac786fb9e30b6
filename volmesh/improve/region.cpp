#include "volmesh/improve/region.h"

#include <algorithm>
#include <limits>

#include "geom/math/predicates.h"
#include "volmesh/improve/tet_quality.h"

namespace sterna::volmesh {
namespace {

/// A change must raise the worst quality by this factor: progress that cannot go on for ever.
constexpr double k_gain = 1.002;
/// Changes per region before the mesh takes a fresh look at what is worst.
constexpr int k_max_changes = 60;

}  // namespace

QualityLimits quality_limits(double min_angle, double max_angle) {
  return {.target = std::sin(min_angle), .obtuse_weight = std::sin(min_angle) / std::sin(max_angle)};
}

void Region::assign(std::span<const Vec3> points, std::span<const std::uint8_t> is_free, std::span<const Corners> tets) {
  points_.assign(points.begin(), points.end());
  is_free_.assign(is_free.begin(), is_free.end());
  for (auto& list : incident_) list.clear();
  incident_.resize(std::max(incident_.size(), points.size()));
  tets_.clear();
  for (const Corners& corners : tets) {
    for (const std::uint32_t v : corners) incident_[v].push_back(static_cast<std::uint32_t>(tets_.size()));
    tets_.push_back({corners, quality(corners), true, false});
  }
}

double Region::quality(const Corners& c) const { return tet_quality(points_[c[0]], points_[c[1]], points_[c[2]], points_[c[3]], limits_.obtuse_weight); }

double Region::quality(const Face& face, const Vec3& apex) const {
  return tet_quality(points_[face[0]], points_[face[1]], points_[face[2]], apex, limits_.obtuse_weight);
}

double Region::worst(std::span<const std::uint32_t> tets) const {
  double result = 1.0;
  for (const std::uint32_t t : tets) result = std::min(result, tets_[t].quality);
  return result;
}

bool Region::is_better(double after, double before) const { return after > 0.0 && after > k_gain * before; }

Region::Face Region::opposite(const Corners& c, std::size_t corner) {
  constexpr std::uint8_t k_faces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  return {c[k_faces[corner][0]], c[k_faces[corner][1]], c[k_faces[corner][2]]};
}

bool Region::apply(const Change& change) {
  const auto place = [&](std::uint32_t v) -> const Vec3& { return v == change.moved ? change.place : points_[v]; };
  for (const Corners& c : change.added)
    if (orient3d(place(c[0]), place(c[1]), place(c[2]), place(c[3])) <= 0) return false;

  if (change.moved == points_.size()) {
    points_.push_back(change.place);
    is_free_.push_back(1);
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
    tets_.push_back({c, quality(c), true, false});
  }
  return true;
}

bool Region::help(std::uint32_t tet) { return remove_edge_or_faces(tet) || smooth(tet) || contract(tet) || insert(tet); }

bool Region::improve() {
  int n_changes = 0;
  while (n_changes < k_max_changes) {
    std::uint32_t chosen = k_none;
    double lowest = limits_.target;
    for (std::uint32_t t = 0; t < tets_.size(); ++t)
      if (tets_[t].is_alive && !tets_[t].is_stuck && tets_[t].quality < lowest) {
        lowest = tets_[t].quality;
        chosen = t;
      }
    if (chosen == k_none) break;
    if (!help(chosen)) {
      tets_[chosen].is_stuck = true;
      continue;
    }
    ++n_changes;
    for (Tet& tet : tets_) tet.is_stuck = false;
  }
  return n_changes > 0;
}

}  // namespace sterna::volmesh
