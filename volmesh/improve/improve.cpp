// Rounds over the bad tetrahedra. Each: choose neighbourhoods that have no tetrahedron in common, worst first; improve each as a Region of its own; put the results
// back in order. A tetrahedron that its nearest neighbourhood could not help gets a wider one; one that this cannot help either is left until something
// changes beside it.

#include "volmesh/improve/improve.h"

#include <algorithm>
#include <cmath>

#include "geom/base/parallel.h"
#include "volmesh/improve/region.h"
#include "volmesh/improve/remaining.h"
#include "volmesh/improve/tet_quality.h"

namespace sterna::volmesh {
namespace {

using Corners = std::array<std::uint32_t, 4>;
constexpr std::uint8_t k_given_up = 2;   ///< attempts: the tetrahedra at its corners, then those at the corners of these
/// Jobs that a bad tetrahedron and those that took its place may start in all. On the boundary angles may force them, and small gains would go on for long.
constexpr std::uint8_t k_max_tries_boundary = 3;
constexpr std::uint8_t k_max_tries_free = 12;
constexpr std::size_t k_job_chunk = 4;
constexpr std::size_t k_scan_chunk = 1 << 15;
constexpr std::uint32_t k_dead = 0xffffffffu;

/// A neighbourhood that is improved on its own, and what became of it.
struct Job {
  std::uint32_t center = 0;
  std::vector<std::uint32_t> tets;      ///< ascending
  std::vector<std::uint32_t> vertices;  ///< ascending: local to global
  bool has_changed = false;
  std::vector<Vec3> points;             ///< of the local vertices, new ones at the end
  std::vector<std::uint32_t> removed;   ///< of `tets`
  std::vector<Corners> added;           ///< local corners
};

class Improver {
 public:
  Improver(const TetraBoundary& boundary, TetraResult& tets, const ImproveOptions& options, const RunContext& context)
      : limits_(quality_limits(options.improve_min_angle, options.improve_max_angle)), n_fixed_(boundary.points.size()), tets_(tets.tetrahedra), context_(context) {
    points_.reserve(n_fixed_ + tets.new_points.size());
    points_.assign(boundary.points.begin(), boundary.points.end());
    points_.insert(points_.end(), tets.new_points.begin(), tets.new_points.end());
    attempts_.assign(tets_.size(), 0);
    tries_.assign(tets_.size(), 0);
    find_bad();
  }

  int run(int max_rounds) {
    int round = 0;
    for (; round < max_rounds; ++round) {
      context_.check_stop();
      std::vector<Job> jobs = choose_jobs();
      if (jobs.empty()) break;
      parallel_chunks(context_, jobs.size(), k_job_chunk, [&](std::size_t begin, std::size_t end) {
        Region region(limits_);
        for (std::size_t i = begin; i < end; ++i) work(jobs[i], region);
      });
      for (const Job& job : jobs) put_back(job);
      drop_good();
    }
    return round;
  }

  /// Removes what has vanished: numbers close up in order.
  void finish(TetraResult& result) const;

 private:
  struct Bad {
    double quality;
    std::uint32_t tet;
    friend bool operator<(const Bad& a, const Bad& b) { return a.quality != b.quality ? a.quality < b.quality : a.tet < b.tet; }
  };

  double quality(const Corners& c) const { return tet_quality(points_[c[0]], points_[c[1]], points_[c[2]], points_[c[3]], limits_.obtuse_weight); }
  bool may_try(std::uint32_t tet) const {
    const bool is_free = std::ranges::all_of(tets_[tet], [&](std::uint32_t v) { return v >= n_fixed_; });
    return tries_[tet] < (is_free ? k_max_tries_free : k_max_tries_boundary);
  }
  bool is_alive(std::uint32_t tet) const { return tets_[tet][0] != k_dead; }
  void find_bad();
  void drop_good();
  std::vector<Job> choose_jobs();
  /// Marks the corners of all tetrahedra that touch a marked vertex.
  std::vector<std::uint8_t> widened(const std::vector<std::uint8_t>& marks) const;
  /// Calls f for every tetrahedron with a marked corner, ascending.
  std::vector<std::uint32_t> touching(const std::vector<std::uint8_t>& marks) const;
  void work(Job& job, Region& region) const;
  void put_back(const Job& job);

  QualityLimits limits_;
  std::size_t n_fixed_;
  std::vector<Corners>& tets_;
  const RunContext& context_;
  std::vector<Vec3> points_;
  std::vector<std::uint8_t> attempts_;  ///< neighbourhoods in vain since the last change beside it
  std::vector<std::uint8_t> tries_;
  std::vector<Bad> bad_;  ///< may name tetrahedra twice, or good ones, until drop_good()
  // Incidence of the marked vertices of this round.
  std::vector<std::uint32_t> first_, incident_;
};

void Improver::find_bad() {
  using List = std::vector<Bad>;
  bad_ = parallel_reduce(
      context_, tets_.size(), List{},
      [&](std::size_t begin, std::size_t end) {
        List list;
        for (std::size_t t = begin; t < end; ++t)
          if (const double q = quality(tets_[t]); q < limits_.target) list.push_back({q, static_cast<std::uint32_t>(t)});
        return list;
      },
      [](List a, List b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      },
      k_scan_chunk);
  std::sort(bad_.begin(), bad_.end());
}

void Improver::drop_good() {
  std::erase_if(bad_, [&](Bad& bad) {
    if (!is_alive(bad.tet)) return true;
    bad.quality = quality(tets_[bad.tet]);
    return bad.quality >= limits_.target;
  });
  std::sort(bad_.begin(), bad_.end());
  bad_.erase(std::unique(bad_.begin(), bad_.end(), [](const Bad& a, const Bad& b) { return a.tet == b.tet; }), bad_.end());
}

std::vector<std::uint32_t> Improver::touching(const std::vector<std::uint8_t>& marks) const {
  using List = std::vector<std::uint32_t>;
  return parallel_reduce(
      context_, tets_.size(), List{},
      [&](std::size_t begin, std::size_t end) {
        List list;
        for (std::size_t t = begin; t < end; ++t)
          if (is_alive(static_cast<std::uint32_t>(t)) && std::ranges::any_of(tets_[t], [&](std::uint32_t v) { return marks[v] != 0; })) list.push_back(static_cast<std::uint32_t>(t));
        return list;
      },
      [](List a, List b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      },
      k_scan_chunk);
}

std::vector<std::uint8_t> Improver::widened(const std::vector<std::uint8_t>& marks) const {
  std::vector<std::uint8_t> wide = marks;
  for (const std::uint32_t t : touching(marks))
    for (const std::uint32_t v : tets_[t]) wide[v] = 1;
  return wide;
}

std::vector<Job> Improver::choose_jobs() {
  std::uint8_t level = k_given_up;
  for (const Bad& bad : bad_)
    if (may_try(bad.tet)) level = std::min(level, attempts_[bad.tet]);
  if (level == k_given_up) return {};

  std::vector<std::uint8_t> marks(points_.size(), 0);
  for (const Bad& bad : bad_)
    if (attempts_[bad.tet] == level && may_try(bad.tet))
      for (const std::uint32_t v : tets_[bad.tet]) marks[v] = 1;
  if (level > 0) marks = widened(marks);
  const std::vector<std::uint32_t> active = touching(marks);
  first_.assign(points_.size() + 1, 0);
  for (const std::uint32_t t : active)
    for (const std::uint32_t v : tets_[t]) first_[v + 1] += marks[v];
  for (std::size_t v = 0; v < points_.size(); ++v) first_[v + 1] += first_[v];
  incident_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const std::uint32_t t : active)
    for (const std::uint32_t v : tets_[t])
      if (marks[v]) incident_[next[v]++] = t;

  std::vector<std::uint8_t> is_taken(tets_.size(), 0);
  std::vector<Job> jobs;
  const auto add_corners = [&](std::vector<std::uint32_t>& vertices, std::span<const std::uint32_t> tets) {
    for (const std::uint32_t t : tets) vertices.insert(vertices.end(), tets_[t].begin(), tets_[t].end());
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  };
  const auto tets_at = [&](const std::vector<std::uint32_t>& vertices) {
    std::vector<std::uint32_t> tets;
    for (const std::uint32_t v : vertices) tets.insert(tets.end(), incident_.begin() + first_[v], incident_.begin() + first_[v + 1]);
    std::ranges::sort(tets);
    tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
    return tets;
  };
  for (const Bad& bad : bad_) {
    if (attempts_[bad.tet] != level || !may_try(bad.tet) || is_taken[bad.tet]) continue;
    Job job{.center = bad.tet};
    std::vector<std::uint32_t> core;
    add_corners(core, std::span(&bad.tet, 1));
    job.tets = tets_at(core);
    if (level > 0) {
      add_corners(core, job.tets);
      job.tets = tets_at(core);
    }
    if (std::ranges::any_of(job.tets, [&](std::uint32_t t) { return is_taken[t] != 0; })) continue;
    for (const std::uint32_t t : job.tets) is_taken[t] = 1;
    add_corners(job.vertices, job.tets);
    jobs.push_back(std::move(job));
  }
  return jobs;
}

void Improver::work(Job& job, Region& region) const {
  const auto local = [&](std::uint32_t v) { return static_cast<std::uint32_t>(std::ranges::lower_bound(job.vertices, v) - job.vertices.begin()); };
  std::vector<std::uint32_t> degree(job.vertices.size(), 0);
  std::vector<Corners> corners(job.tets.size());
  for (std::size_t i = 0; i < job.tets.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) ++degree[corners[i][k] = local(tets_[job.tets[i]][k])];
  std::vector<Vec3> points(job.vertices.size());
  std::vector<VertexRole> roles(job.vertices.size(), VertexRole::kept);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t v = job.vertices[i];
    points[i] = points_[v];
    if (v < n_fixed_) roles[i] = VertexRole::boundary;
    else if (degree[i] == first_[v + 1] - first_[v]) roles[i] = VertexRole::free;  // unmarked vertices have no incidence here
  }
  region.assign(points, roles, corners);
  job.has_changed = region.improve(static_cast<std::uint32_t>(std::ranges::lower_bound(job.tets, job.center) - job.tets.begin()));
  if (!job.has_changed) return;
  job.points.assign(region.points().begin(), region.points().end());
  for (std::size_t i = 0; i < region.tets().size(); ++i) {
    const Region::Tet& tet = region.tets()[i];
    if (i < job.tets.size() && !tet.is_alive) job.removed.push_back(job.tets[i]);
    if (i >= job.tets.size() && tet.is_alive) job.added.push_back(tet.corners);
  }
}

void Improver::put_back(const Job& job) {
  const auto n_tries = static_cast<std::uint8_t>(tries_[job.center] + 1);
  tries_[job.center] = n_tries;
  if (!job.has_changed) {
    ++attempts_[job.center];
    return;
  }
  for (const std::uint32_t t : job.tets) attempts_[t] = 0;
  const auto n_old = static_cast<std::uint32_t>(job.vertices.size());
  const auto shift = static_cast<std::uint32_t>(points_.size());
  for (std::size_t i = 0; i < n_old; ++i) points_[job.vertices[i]] = job.points[i];
  points_.insert(points_.end(), job.points.begin() + n_old, job.points.end());
  for (std::size_t i = 0; i < std::max(job.added.size(), job.removed.size()); ++i) {
    std::uint32_t slot = 0;
    if (i < job.removed.size()) {
      slot = job.removed[i];
    } else {
      slot = static_cast<std::uint32_t>(tets_.size());
      tets_.emplace_back();
      attempts_.push_back(0);
      tries_.push_back(0);
    }
    if (i >= job.added.size()) {
      tets_[slot][0] = k_dead;
      continue;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t v = job.added[i][k];
      tets_[slot][k] = v < n_old ? job.vertices[v] : shift + (v - n_old);
    }
    tries_[slot] = n_tries;
    bad_.push_back({0.0, slot});
  }
}

void Improver::finish(TetraResult& result) const {
  std::erase_if(tets_, [](const Corners& c) { return c[0] == k_dead; });
  std::vector<std::uint32_t> number(points_.size(), 0);
  for (std::size_t v = 0; v < n_fixed_; ++v) number[v] = 1;
  for (const Corners& c : tets_)
    for (const std::uint32_t v : c) number[v] = 1;
  std::uint32_t next = 0;
  result.new_points.clear();
  for (std::size_t v = 0; v < points_.size(); ++v) {
    if (!number[v]) continue;
    number[v] = next++;
    if (v >= n_fixed_) result.new_points.push_back(points_[v]);
  }
  parallel_for(context_, tets_.size(), [&](std::size_t t) {
    for (std::uint32_t& v : tets_[t]) v = number[v];
  });
}

struct Summary {
  std::int64_t n_bad = 0;
  std::int64_t n_bad_free = 0;
  double min_cosine = 1.0;   ///< of the largest angle
  double max_cosine = -1.0;  ///< of the smallest
};

Summary summarise(const TetraBoundary& boundary, const TetraResult& tets, const ImproveOptions& options, const RunContext& context) {
  const std::size_t n_fixed = boundary.points.size();
  const double highest = std::cos(options.improve_min_angle), lowest = std::cos(options.improve_max_angle);
  return parallel_reduce(
      context, tets.tetrahedra.size(), Summary{},
      [&](std::size_t begin, std::size_t end) {
        Summary s;
        for (std::size_t t = begin; t < end; ++t) {
          const Corners& c = tets.tetrahedra[t];
          const auto place = [&](std::uint32_t v) { return v < n_fixed ? boundary.points[v] : tets.new_points[v - n_fixed]; };
          const auto [of_smallest, of_largest] = dihedral_cosines(place(c[0]), place(c[1]), place(c[2]), place(c[3]));
          s.max_cosine = std::max(s.max_cosine, of_smallest);
          s.min_cosine = std::min(s.min_cosine, of_largest);
          if (of_smallest <= highest && of_largest >= lowest) continue;
          ++s.n_bad;
          s.n_bad_free += std::ranges::all_of(c, [&](std::uint32_t v) { return v >= n_fixed; });
        }
        return s;
      },
      [](const Summary& a, const Summary& b) {
        return Summary{a.n_bad + b.n_bad, a.n_bad_free + b.n_bad_free, std::min(a.min_cosine, b.min_cosine), std::max(a.max_cosine, b.max_cosine)};
      });
}

}  // namespace

ImproveReport improve_tetrahedra(const TetraBoundary& boundary, TetraResult& tets, const ImproveOptions& options, const RunContext& context) {
  const Summary before = summarise(boundary, tets, options, context);
  ImproveReport report{.n_bad_before = before.n_bad, .min_angle_before = std::acos(before.max_cosine), .max_angle_before = std::acos(before.min_cosine)};
  Improver improver(boundary, tets, options, context);
  report.rounds = improver.run(options.improve_rounds);
  improver.finish(tets);
  const Summary after = summarise(boundary, tets, options, context);
  report.n_bad_after = after.n_bad;
  report.n_bad_free_after = after.n_bad_free;
  report.min_angle_after = std::acos(after.max_cosine);
  report.max_angle_after = std::acos(after.min_cosine);
  if (report.n_bad_after > 0) list_remaining(boundary, tets, options, report, context);
  return report;
}

}  // namespace sterna::volmesh
