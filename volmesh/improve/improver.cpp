#include "volmesh/improve/improver.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>

#include "geom/base/parallel.h"
#include "geom/base/sort_unique.h"
#include "geom/math/measures.h"

namespace sterna::volmesh {
namespace {

/// Number of bad tetrahedra per group: larger groups have fewer bad tetrahedra between two groups, smaller groups occupy more cores.
constexpr std::size_t k_group = 300;
constexpr std::uint32_t k_ring_shift = 28;
/// Returns the number of vertex rings around the bad tetrahedra that a group claims. Every third pass adds a ring, for tetrahedra that could not be improved
/// within one ring.
constexpr std::uint32_t rings_of(int pass) { return pass % 3 == 2 ? 2 : 1; }
constexpr std::size_t k_job_chunk = 1;
constexpr std::uint32_t k_no_region = 0xffffffffu;
/// Limits for the number of tetrahedra graded in all passes: per run, and per tetrahedron. Usual meshes need 20 to 400 per tetrahedron. Fans of thousands of
/// slivers would take days without the limits.
constexpr std::uint64_t k_least_effort = 300'000'000, k_effort_of_tet = 500, k_effort_of_job = 20'000'000;
/// Effort that every run may use without a test of its benefit, per run and per considered tetrahedron. It takes 10 s for a million considered tetrahedra.
constexpr std::uint64_t k_free_effort = 2'000'000, k_free_effort_of_tet = 100;
/// After that effort, the run ends if the last passes, one of each kind, graded more than this number of tetrahedra per repaired one. Usual bad tetrahedra are
/// repaired with a few thousand. On walls full of slivers the passes would continue for minutes.
constexpr int k_costly_repair = 10'000;
constexpr std::size_t k_judged_passes = 3;
/// The run also ends after a single pass that graded this many times as many tetrahedra per repaired one. On tessellated cylinders with thousands of slivers
/// one pass takes longer than all other steps.
constexpr double k_hopeless_factor = 5.0;
constexpr double k_expected_passes = 2.5;  ///< expected number of passes that are as long as the next one, for the progress report
constexpr double k_hard_counts = 3.0;      ///< a tetrahedron beyond the hard limits counts like this number of bad ones, as in the costs of a Region
/// Changes may make tetrahedra down to this fraction of the target while the mesh contains worse tetrahedra.
constexpr double k_floor = 0.5;
/// Ratio of the volume of a prism to that of a fitting tetrahedron. The reference of gate G9 is a prism of a third of the height of a regular tetrahedron.
constexpr double k_prism_over_tet = 3.0;
constexpr std::size_t k_listing_chunk = 1 << 15;

std::uint64_t spread_bits(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

}  // namespace

Improver::Improver(const TetraBoundary& boundary, TetraResult& tets, const QualityLimits& limits, const RunContext& context)
    : limits_(limits), n_fixed_(boundary.points.size()), n_about_(tets.tetrahedra.size()), tets_(tets.tetrahedra), context_(context) {
  points_.reserve(n_fixed_ + tets.new_points.size());
  points_.assign(boundary.points.begin(), boundary.points.end());
  points_.insert(points_.end(), tets.new_points.begin(), tets.new_points.end());
  n_failures_.assign(tets_.size(), 0);
  list_incident();
  if (std::isfinite(limits.size_step)) find_sizes(boundary);
}

double Improver::quality(const Corners& c) const {
  const TetShape shape = tet_shape(points_[c[0]], points_[c[1]], points_[c[2]], points_[c[3]], limits_.obtuse_weight);
  if (size_weights_.empty()) return shape.quality;
  const std::optional<double> on_layer = quality_on_layer(shape, c, layer_faces_, static_cast<std::uint32_t>(n_fixed_), limits_);
  return on_layer ? *on_layer : quality_among(shape, size_weights_[c[0]] * size_weights_[c[1]] * size_weights_[c[2]] * size_weights_[c[3]], limits_);
}

/// Computes for each vertex the mean of the logarithms of the volumes around it. On top of the layer it is averaged with the logarithm of the volume that would
/// fit the last prisms there.
void Improver::find_sizes(const TetraBoundary& boundary) {
  std::vector<double> log_volume(tets_.size());
  parallel_for(context_, tets_.size(), [&](std::size_t t) {
    const Corners& c = tets_[t];
    log_volume[t] = std::log(6.0 * tet_volume(points_[c[0]], points_[c[1]], points_[c[2]], points_[c[3]]));
  });
  find_layer_faces(boundary);
  struct Mean {
    double sum = 0.0;
    int n = 0;
  };
  std::vector<Mean> of_layer(n_fixed_);
  for (const LayerFace& face : layer_faces_)
    for (const std::uint32_t v : face.corners) {
      of_layer[v].sum -= std::log(face.weight);
      ++of_layer[v].n;
    }
  size_weights_.resize(points_.size());
  parallel_for(context_, points_.size(), [&](std::size_t v) {
    double sum = 0.0;
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) sum += log_volume[incident_[i]];
    double mean = sum / std::max(1.0, static_cast<double>(first_[v + 1] - first_[v]));
    if (v < n_fixed_ && of_layer[v].n > 0) mean = 0.5 * (mean + of_layer[v].sum / of_layer[v].n);
    size_weights_[v] = size_weight(mean);
  });
}

void Improver::find_layer_faces(const TetraBoundary& boundary) {
  for (std::size_t t = 0; t < boundary.layer_volumes.size(); ++t) {
    if (!(boundary.layer_volumes[t] > 0.0)) continue;
    LayerFace& face = layer_faces_.emplace_back(boundary.triangles[t], k_prism_over_tet / (6.0 * boundary.layer_volumes[t]));
    std::ranges::sort(face.corners);
  }
  parallel_sort(context_, layer_faces_, std::less<>());
}

/// Returns the layer faces between vertices of a job, in local numbers.
std::vector<LayerFace> Improver::local_layer_faces(const Job& job, std::uint32_t number) const {
  std::vector<LayerFace> faces;
  for (const std::uint32_t v : job.vertices) {
    const auto begin = std::ranges::lower_bound(layer_faces_, v, {}, [](const LayerFace& face) { return face.corners[0]; });
    for (auto face = begin; face != layer_faces_.end() && face->corners[0] == v; ++face)
      if (std::ranges::all_of(face->corners, [&](std::uint32_t u) { return owner_of(u) == number; }))
        faces.push_back({{local_[face->corners[0]], local_[face->corners[1]], local_[face->corners[2]]}, face->weight});
  }
  return faces;  // local numbers ascend with global ones, so the list is sorted
}

void Improver::work_on_all_but(std::span<const std::uint32_t> left) {
  work_on(parallel_collect<std::uint32_t>(
      context_, tets_.size(),
      [&](std::size_t begin, std::size_t end, std::vector<std::uint32_t>& bad) {
        for (std::size_t t = begin; t < end; ++t)
          if (quality(tets_[t]) < limits_.target && !std::ranges::binary_search(left, static_cast<std::uint32_t>(t)))
            bad.push_back(static_cast<std::uint32_t>(t));
      },
      k_listing_chunk));
}

void Improver::work_on_bad_of(std::span<const std::uint32_t> some) {
  n_about_ = some.size();
  std::vector<std::uint32_t> bad;
  for (const std::uint32_t t : some)
    if (quality(tets_[t]) < limits_.target) bad.push_back(t);
  work_on(bad);
}

void Improver::work_on(std::span<const std::uint32_t> bad) {
  double worst = limits_.target;
  for (const std::uint32_t t : bad) {
    bad_.push_back({quality(tets_[t]), t});
    worst = std::min(worst, bad_.back().quality);
  }
  limits_.floor = std::max({limits_.floor, k_floor * limits_.target, worst});
}

bool Improver::is_alive(std::uint32_t tet) const { return tets_[tet][0] != k_no_region; }

void Improver::drop_good() {
  std::erase_if(bad_, [&](Bad& bad) {
    if (!is_alive(bad.tet)) return true;
    bad.quality = quality(tets_[bad.tet]);
    return bad.quality >= limits_.target;
  });
  std::ranges::sort(bad_, {}, &Bad::tet);
  bad_.erase(std::unique(bad_.begin(), bad_.end(), [](const Bad& a, const Bad& b) { return a.tet == b.tet; }), bad_.end());
}

void Improver::list_incident() {
  first_.assign(points_.size() + 1, 0);
  for (const Corners& c : tets_)
    for (const std::uint32_t v : c) ++first_[v + 1];
  for (std::size_t v = 0; v < points_.size(); ++v) first_[v + 1] += first_[v];
  incident_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t t = 0; t < tets_.size(); ++t)
    for (const std::uint32_t v : tets_[t]) incident_[next[v]++] = static_cast<std::uint32_t>(t);
  later_.resize(points_.size());
}

template <class F>
void Improver::for_each_at(std::uint32_t vertex, const F& f) const {
  const auto visit = [&](std::uint32_t t) {
    if (is_alive(t) && std::ranges::find(tets_[t], vertex) != tets_[t].end()) f(t);
  };
  if (vertex + 1 < first_.size())
    for (std::uint32_t i = first_[vertex]; i < first_[vertex + 1]; ++i) visit(incident_[i]);
  for (const std::uint32_t t : later_[vertex]) visit(t);
}

double Improver::amount_of_bad() const {
  double amount = 0.0;
  for (const Bad& bad : bad_) amount += bad.quality < limits_.hard ? k_hard_counts : 1.0;
  return amount;
}

/// Returns true if the cost of the last passes exceeded their benefit. \p left_after and \p bad_after are numbers after each pass: remaining attempts, and
/// remaining bad tetrahedra.
bool Improver::is_dear(std::span<const std::uint64_t> left_after, std::span<const double> bad_after) const {
  const auto is_above = [&](std::size_t n_passes, double tries, std::uint64_t least) {
    const std::size_t n = left_after.size();
    if (n <= n_passes) return false;
    const double repaired = bad_after[n - 1 - n_passes] - bad_after[n - 1];
    const auto effort = static_cast<double>(left_after[n - 1 - n_passes] - left_after[n - 1]);
    context_.debug("improvement, last " + std::to_string(n_passes) + " passes: " + std::to_string(bad_after.back()) + " bad, " + std::to_string(repaired) +
                   " repaired with " + std::to_string(effort) + " tries");
    return effort > std::max(tries * repaired, static_cast<double>(least));
  };
  return is_above(1, k_hopeless_factor * k_costly_repair, k_free_effort + k_free_effort_of_tet * n_about_) || is_above(k_judged_passes, k_costly_repair, 0);
}

int Improver::run(int max_passes) {
  int pass = 0;
  std::uint64_t left = k_least_effort + k_effort_of_tet * tets_.size();
  const std::uint64_t free_until = left - std::min(left, k_free_effort + k_free_effort_of_tet * n_about_);
  std::vector<std::uint64_t> left_after;  // one entry per pass
  std::vector<double> bad_after;
  double n_done = 0.0;  // number of finished jobs
  for (; pass < max_passes; ++pass) {
    context_.check_stop();
    std::vector<Job> jobs = choose_jobs(pass);
    if (jobs.empty()) break;
    context_.progress(n_done / (n_done + k_expected_passes * static_cast<double>(jobs.size())));
    n_done += static_cast<double>(jobs.size());
    if (left == 0) {
      context_.log(LogLevel::warning, "improvement of tetrahedra ends with " + std::to_string(jobs.size()) +
                                          " locations left: strips and fans of slivers need more than " + std::to_string(k_effort_of_tet) +
                                          " tries per tetrahedron");
      break;
    }
    left_after.push_back(left);
    bad_after.push_back(amount_of_bad());
    if (left < free_until && is_dear(left_after, bad_after)) {
      context_.log(LogLevel::debug, "improvement of tetrahedra ends after " + std::to_string(pass) + " passes with " + std::to_string(bad_.size()) +
                                        " bad tetrahedra left: the last passes needed more than " + std::to_string(k_costly_repair) +
                                        " tries for each repaired tetrahedron");
      break;
    }
    const std::uint64_t share = std::max(left / jobs.size(), k_effort_of_job);
    owner_.assign(points_.size(), k_no_region);
    local_.resize(points_.size());
    for (std::uint32_t ring = 0; ring <= rings_of(pass); ++ring)
      parallel_for(
          context_, jobs.size(), [&](std::size_t i) { claim_ring(jobs[i], static_cast<std::uint32_t>(i), ring); }, k_job_chunk);
    parallel_chunks(context_, jobs.size(), k_job_chunk, [&](std::size_t begin, std::size_t end) {
      Region region(limits_);
      for (std::size_t i = begin; i < end; ++i) work(jobs[i], static_cast<std::uint32_t>(i), share, region);
    });
    for (const Job& job : jobs) {
      put_back(job);
      left -= std::min(left, job.effort);
      effort_ += job.effort;
    }
    drop_good();
  }
  return pass;
}

/// Forms groups along Morton's curve. The grid of the curve and the size of the first group differ from pass to pass, so that tetrahedra between two groups are
/// inside one group in another pass.
std::vector<Improver::Job> Improver::choose_jobs(int pass) const {
  Vec3 low = points_[0], high = points_[0];
  for (std::size_t v = 0; v < n_fixed_; ++v)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], points_[v][axis]);
      high[axis] = std::max(high[axis], points_[v][axis]);
    }
  struct Item {
    std::uint64_t code;
    std::uint32_t tet;
    bool operator<(const Item& other) const { return code != other.code ? code < other.code : tet < other.tet; }
  };
  std::vector<Item> items;
  const double shift = 0.381966 * pass - std::floor(0.381966 * pass);  // golden section: no two passes have the same shift
  for (const Bad& bad : bad_) {
    const Corners& c = tets_[bad.tet];
    const bool is_at_boundary = std::min({c[0], c[1], c[2], c[3]}) < n_fixed_;
    const int most = std::min(limits_.max_failures, max_failures({points_[c[0]], points_[c[1]], points_[c[2]], points_[c[3]]}, is_at_boundary));
    if (n_failures_[bad.tet] > 0 && n_failures_[bad.tet] >= most) continue;
    std::uint64_t code = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double x = 0.0;
      for (const std::uint32_t v : tets_[bad.tet]) x += 0.25 * (points_[v][axis] - low[axis]);
      code |= spread_bits(static_cast<std::uint64_t>((x / (high[axis] - low[axis]) + shift) * 0x1p20)) << axis;
    }
    items.push_back({code, bad.tet});
  }
  std::sort(items.begin(), items.end());
  std::vector<Job> jobs;
  for (std::size_t begin = 0, end = 0; begin < items.size(); begin = end) {
    end = std::min(items.size(), begin == 0 && pass % 2 == 1 ? k_group / 2 : begin + k_group);
    Job& job = jobs.emplace_back();
    for (std::size_t i = begin; i < end; ++i) job.bad.push_back(items[i].tet);
  }
  return jobs;
}

/// Claims the tetrahedra and vertices around the vertices that the job owns. The smaller ring around a bad tetrahedron has priority, then the lower job number.
/// The owners therefore do not depend on the order of the claims.
void Improver::claim_ring(Job& job, std::uint32_t number, std::uint32_t ring) {
  const std::uint32_t rank = ring << k_ring_shift | number;
  const auto claim = [&](std::uint32_t v) {
    const std::atomic_ref<std::uint32_t> owner(owner_[v]);
    std::uint32_t now = owner.load(std::memory_order_relaxed);
    while (rank < now)
      if (owner.compare_exchange_weak(now, rank, std::memory_order_relaxed)) {
        job.vertices.push_back(v);
        return;
      }
  };
  if (ring == 0) {
    for (const std::uint32_t t : job.bad)
      for (const std::uint32_t v : tets_[t]) claim(v);
    return;
  }
  std::erase_if(job.vertices, [&](std::uint32_t v) { return owner_of(v) != number; });
  const std::size_t begin = ring == 1 ? 0 : job.n_inner;
  job.n_inner = job.vertices.size();
  for (std::size_t i = begin; i < job.n_inner; ++i)
    for_each_at(job.vertices[i], [&](std::uint32_t t) {
      for (const std::uint32_t v : tets_[t]) claim(v);
    });
}

void Improver::work(Job& job, std::uint32_t number, std::uint64_t most_effort, Region& region) {
  std::erase_if(job.vertices, [&](std::uint32_t v) { return owner_of(v) != number; });
  std::sort(job.vertices.begin(), job.vertices.end());
  std::vector<Vec3> points(job.vertices.size());
  std::vector<double> weights;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = points_[job.vertices[i]];
    local_[job.vertices[i]] = static_cast<std::uint32_t>(i);
    if (!size_weights_.empty()) weights.push_back(size_weights_[job.vertices[i]]);
  }
  std::vector<VertexRole> roles;
  for (const std::uint32_t v : job.vertices) {
    bool is_whole = true;
    for_each_at(v, [&](std::uint32_t t) {
      const Corners& c = tets_[t];
      const bool is_ours = std::ranges::all_of(c, [&](std::uint32_t u) { return owner_of(u) == number; });
      is_whole &= is_ours;
      if (is_ours && v == std::min({c[0], c[1], c[2], c[3]})) job.tets.push_back(t);
    });
    if (v < n_fixed_) roles.push_back(is_whole ? VertexRole::boundary : VertexRole::kept_boundary);
    else roles.push_back(is_whole ? VertexRole::free : VertexRole::kept);
  }
  sort_unique(job.tets);
  std::vector<Corners> corners(job.tets.size());
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) corners[i][k] = local_[tets_[job.tets[i]][k]];
  for (const std::uint32_t t : job.bad)
    if (const auto location = std::ranges::lower_bound(job.tets, t); location != job.tets.end() && *location == t)
      job.worked.push_back(static_cast<std::uint32_t>(location - job.tets.begin()));

  region.assign(points, roles, corners, {weights, local_layer_faces(job, number)});
  for (const std::uint32_t t : job.worked) job.n_failures.push_back(n_failures_[job.tets[t]]);
  job.has_changed = region.improve(job.worked, job.n_failures, most_effort);
  job.effort = region.effort();
  for (std::size_t i = 0; i < job.worked.size(); ++i) job.n_failures[i] = region.tets()[job.worked[i]].n_failures;
  if (!job.has_changed) return;
  job.points.assign(region.points().begin(), region.points().end());
  if (!size_weights_.empty()) job.size_weights.assign(region.size_weights().begin(), region.size_weights().end());
  for (std::size_t i = 0; i < region.tets().size(); ++i) {
    const Region::Tet& tet = region.tets()[i];
    if (i < job.tets.size() && !tet.is_alive) job.removed.push_back(job.tets[i]);
    if (i >= job.tets.size() && tet.is_alive) job.added.push_back(tet.corners);
  }
}

void Improver::put_back(const Job& job) {
  for (std::size_t i = 0; i < job.worked.size(); ++i) n_failures_[job.tets[job.worked[i]]] = job.n_failures[i];
  if (!job.has_changed) return;
  const auto n_old = static_cast<std::uint32_t>(job.vertices.size());
  const auto shift = static_cast<std::uint32_t>(points_.size());
  for (std::size_t i = 0; i < n_old; ++i) points_[job.vertices[i]] = job.points[i];
  points_.insert(points_.end(), job.points.begin() + n_old, job.points.end());
  if (!size_weights_.empty()) size_weights_.insert(size_weights_.end(), job.size_weights.begin() + n_old, job.size_weights.end());
  later_.resize(points_.size());
  for (std::size_t i = 0; i < std::max(job.added.size(), job.removed.size()); ++i) {
    std::uint32_t slot = 0;
    if (i < job.removed.size()) {
      slot = job.removed[i];
    } else {
      slot = static_cast<std::uint32_t>(tets_.size());
      tets_.emplace_back();
      n_failures_.push_back(0);
    }
    if (i >= job.added.size()) {
      tets_[slot][0] = k_no_region;
      continue;
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t v = job.added[i][k];
      tets_[slot][k] = v < n_old ? job.vertices[v] : shift + (v - n_old);
      later_[tets_[slot][k]].push_back(slot);
    }
    n_failures_[slot] = 0;
    bad_.push_back({0.0, slot});
  }
}

void Improver::finish(TetraResult& result) {
  std::erase_if(tets_, [](const Corners& c) { return c[0] == k_no_region; });
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

}  // namespace sterna::volmesh
