#include "volmesh/improve/region.h"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <cstdio>

#include "geom/math/predicates.h"

namespace sterna::volmesh {
namespace {

/// A change must lower the sum of costs by this much: progress that cannot go on for ever.
constexpr double k_least_drop = 0.01;
/// A bad tetrahedron away from the boundary costs as much as so many at it.
constexpr double k_interior_weight = 5.0;

}  // namespace

void Region::assign(std::span<const Vec3> points, std::span<const VertexRole> roles, std::span<const Corners> tets) {
  points_.assign(points.begin(), points.end());
  roles_.assign(roles.begin(), roles.end());
  changed_.assign(points.size(), 0);
  clock_ = 1;
  for (auto& list : incident_) list.clear();
  incident_.resize(std::max(incident_.size(), points.size()));
  tets_.clear();
  for (const Corners& corners : tets) {
    for (const std::uint32_t v : corners) incident_[v].push_back(static_cast<std::uint32_t>(tets_.size()));
    const double q = quality(corners);
    tets_.push_back({corners, q, cost_of(q, touches_boundary(corners))});
  }
}

double Region::quality(const Corners& c) const { return tet_quality(points_[c[0]], points_[c[1]], points_[c[2]], points_[c[3]], limits_.obtuse_weight); }

bool Region::touches_boundary(const Corners& c) const {
  return std::ranges::any_of(c, [&](std::uint32_t v) { return v < roles_.size() && roles_[v] == VertexRole::boundary; });
}
bool Region::touches_boundary(const Face& face) const {
  return std::ranges::any_of(face, [&](std::uint32_t v) { return roles_[v] == VertexRole::boundary; });
}

/// Below the target a step, so that their number counts, and a slope, so that the worst gain most; above it a little up to twice the target, so that others keep clear of it.
double Region::cost_of(double quality, bool is_boundary) const {
  const double x = quality / limits_.target;
  if (x >= 2.0) return 0.0;
  const double soft = 0.25 * (1.0 - 0.5 * x) * (1.0 - 0.5 * x);
  return x >= 1.0 ? soft : (soft + 1.0 - 0.5 * x) * (is_boundary ? 1.0 : k_interior_weight);
}

double Region::slope_of_cost(double quality, bool is_boundary) const {
  const double x = quality / limits_.target;
  if (x >= 2.0) return 0.0;
  const double soft = 0.25 * (1.0 - 0.5 * x);
  return (x >= 1.0 ? soft : (soft + 0.5) * (is_boundary ? 1.0 : k_interior_weight)) / limits_.target;
}

void Region::compare_with(std::span<const std::uint32_t> removed) {
  cost_before_ = 0.0;
  worst_allowed_ = limits_.floor;
  for (const std::uint32_t t : removed) {
    cost_before_ += tets_[t].cost;
    worst_allowed_ = std::min(worst_allowed_, tets_[t].quality);
  }
}

double Region::cost(const Corners& c) const {
  const double q = quality(c);
  return q < worst_allowed_ || q <= 0.0 ? k_infinite : q >= 2.0 * limits_.target ? 0.0 : cost_of(q, touches_boundary(c));
}

double Region::cost(const Face& face, const Vec3& apex) const {
  const double q = tet_quality(points_[face[0]], points_[face[1]], points_[face[2]], apex, limits_.obtuse_weight);
  return q < worst_allowed_ || q <= 0.0 ? k_infinite : q >= 2.0 * limits_.target ? 0.0 : cost_of(q, touches_boundary(face));
}

Region::Face Region::opposite(const Corners& c, std::size_t corner) {
  constexpr std::uint8_t k_faces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  return {c[k_faces[corner][0]], c[k_faces[corner][1]], c[k_faces[corner][2]]};
}

bool Region::apply(const Change& change) {
  if (!(change.drop > k_least_drop)) return false;
  const auto place = [&](std::uint32_t v) -> const Vec3& { return v == change.moved ? change.place : points_[v]; };
  compare_with(change.removed);
  double sum = 0.0;
  for (const Corners& c : change.added) {
    const Vec3 &p0 = place(c[0]), &p1 = place(c[1]), &p2 = place(c[2]), &p3 = place(c[3]);
    if (orient3d(p0, p1, p2, p3) <= 0) return false;
    const double q = tet_quality(p0, p1, p2, p3, limits_.obtuse_weight);
    if (q < worst_allowed_ || q <= 0.0) return false;
    sum += cost_of(q, touches_boundary(c));
  }
  if (!(cost_before_ - sum > k_least_drop)) return false;

  if (change.moved == points_.size()) {
    points_.push_back(change.place);
    roles_.push_back(VertexRole::free);
    changed_.push_back(0);
    incident_.resize(std::max(incident_.size(), points_.size()));
  } else if (change.moved != k_none) {
    points_[change.moved] = change.place;
  }
  ++clock_;
  for (const std::uint32_t t : change.removed) {
    tets_[t].is_alive = false;
    for (const std::uint32_t v : tets_[t].corners) {
      std::erase(incident_[v], t);
      changed_[v] = clock_;
    }
  }
  for (const Corners& c : change.added) {
    for (const std::uint32_t v : c) {
      incident_[v].push_back(static_cast<std::uint32_t>(tets_.size()));
      changed_[v] = clock_;
    }
    const double q = quality(c);
    tets_.push_back({c, q, cost_of(q, touches_boundary(c))});
  }
  return true;
}

bool Region::is_stuck(std::uint32_t tet) const {
  return std::ranges::all_of(tets_[tet].corners, [&](std::uint32_t v) { return changed_[v] <= tets_[tet].tried; }) && tets_[tet].tried > 0;
}

struct Stat { std::atomic<long> n[8]; std::atomic<double> t[4]; ~Stat() { fprintf(stderr,"help %ld flips %ld smooth %ld contract %ld insert %ld | ms %.0f %.0f %.0f %.0f\n",n[0].load(),n[1].load(),n[2].load(),n[3].load(),n[4].load(),t[0]*1e3,t[1]*1e3,t[2]*1e3,t[3]*1e3);} } stat;
double now() { timespec ts; clock_gettime(CLOCK_THREAD_CPUTIME_ID,&ts); return double(ts.tv_sec)+1e-9*double(ts.tv_nsec); }
bool Region::help(std::uint32_t tet) {
  ++stat.n[0];
  double t=now();
  bool r=remove_edge_or_faces(tet); double u=now(); stat.t[0]+=u-t; if(r){++stat.n[1];return true;} t=u;
  r=smooth(tet); u=now(); stat.t[1]+=u-t; if(r){++stat.n[2];return true;} t=u;
  r=contract(tet); u=now(); stat.t[2]+=u-t; if(r){++stat.n[3];return true;} t=u;
  r=insert(tet); u=now(); stat.t[3]+=u-t; if(r){++stat.n[4];return true;}
  return false;
}

bool Region::improve(std::span<const std::uint32_t> tets, std::span<const std::uint8_t> n_failures) {
  static const int kf = getenv("KF") ? atoi(getenv("KF")) : 4;
  std::vector<std::uint32_t> work(tets.begin(), tets.end());
  for (std::size_t i = 0; i < tets.size(); ++i) tets_[tets[i]].n_failures = n_failures[i];
  const std::uint32_t start = clock_;
  for (;;) {
    std::uint32_t worst = k_none;
    std::erase_if(work, [&](std::uint32_t t) { return !tets_[t].is_alive || tets_[t].quality >= limits_.target || tets_[t].n_failures >= kf; });
    for (const std::uint32_t t : work)
      if (!is_stuck(t) && (worst == k_none || tets_[t].quality < tets_[worst].quality)) worst = t;
    if (worst == k_none) return clock_ > start;
    const std::size_t n_before = tets_.size();
    if (!help(worst)) {
      tets_[worst].tried = clock_;
      ++tets_[worst].n_failures;
    }
    for (std::size_t t = n_before; t < tets_.size(); ++t) work.push_back(static_cast<std::uint32_t>(t));
  }
}

}  // namespace sterna::volmesh
