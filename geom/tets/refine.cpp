#include "geom/tets/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>

#include "geom/base/parallel.h"
#include "geom/tets/bulk_insert.h"
#include "geom/tets/thin.h"

namespace sterna::tets {
namespace {

// The lengths below are in units of the target edge length times this factor. With this factor the geometric mean of the edges equals the target length
// (measured in a field of constant size).
constexpr double k_length_factor = 1.07;
/// Length of the edges from a new point to the face in front of which it lies.
constexpr double k_front_edge = 0.85;
/// Circumradius above which a tetrahedron is refined. A regular tetrahedron has 0.61.
constexpr double k_radius_limit = 0.76;
/// Minimum distance between two points of the volume.
constexpr double k_least_distance = 0.7;
/// Minimum distance between a point of the volume and a point of the boundary, where triangles may be narrow.
constexpr double k_corner_distance = 0.6;
/// Minimum height of a point in front of a face.
constexpr double k_least_height = 0.6;
/// Minimum height of a point above a boundary face.
constexpr double k_boundary_height = 0.4;
/// If the circumcentre is farther than the front's point by at most this factor, it is used instead, because a second point would not fit behind the front's
/// point.
constexpr double k_merge = 1.2;
/// Number of proposals along the curve that are thinned out together; conflicts between two such groups are detected at insertion.
constexpr std::size_t k_thinned_together = 1 << 15;
constexpr int k_most_rounds = 1000;
constexpr double k_share_expected = 0.75;  ///< ratio of the final number of tetrahedra to the number for which memory is reserved initially

// States of tetrahedra. From k_waiting on, a state counts rejected proposals.
constexpr std::uint8_t k_unseen = 0, k_right = 1, k_given_up = 2, k_waiting = 3;
constexpr int k_most_proposals = 3;

/// A tetrahedron that could not be split is far if its edge in the volume and its circumradius exceed these multiples of the target length.
constexpr double k_far_edge = 5.0, k_far_radius = 20.0;

struct Sphere {
  Vec3 center;
  double radius = std::numeric_limits<double>::infinity();
};

Sphere circumsphere(const std::array<Vec3, 4>& p) {
  const Vec3 u = p[1] - p[0], v = p[2] - p[0], w = p[3] - p[0];
  const Vec3 vw = cross(v, w);
  const double volume = 2.0 * dot(u, vw);
  if (!(volume > 0.0)) return {};
  const Vec3 offset = (norm2(u) * vw + norm2(v) * cross(w, u) + norm2(w) * cross(u, v)) / volume;
  return {p[0] + offset, norm(offset)};
}

/// A face as seen from its tetrahedron.
struct Base {
  Vec3 normal;  ///< unit, into the tetrahedron
  Vec3 center;  ///< centre of the circle through its corners
  Vec3 middle;  ///< centroid
  double radius = std::numeric_limits<double>::infinity();
};

Base base_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, n = cross(u, v);
  const double n2 = norm2(n);
  Base base{.normal = normalized(n), .middle = (a + b + c) / 3.0};
  if (!(n2 > 0.0)) return base;
  const Vec3 offset = cross(norm2(u) * v - norm2(v) * u, n) / (2.0 * n2);
  base.center = a + offset;
  base.radius = norm(offset);
  return base;
}

class Refiner {
 public:
  Refiner(TetMesh& mesh, std::uint32_t n_corners, const SizeFunction& sizes, double most_bytes, std::size_t expected, const RunContext& context)
      : mesh_(mesh),
        sizes_(sizes),
        most_bytes_(most_bytes),
        context_(context),
        inserter_(mesh, context, n_corners),
        n_corners_(n_corners),
        expected_(expected) {
    inserter_.reserve(expected);
  }

  RefineReport run() {
    bool needs_front = true;
    for (; report_.rounds < k_most_rounds; ++report_.rounds) {
      context_.check_stop();
      if (report_.is_over_limit = bytes() > most_bytes_; report_.is_over_limit) break;
      report_progress();
      judge();
      const std::int64_t n_inserted = round(needs_front);
      if (n_inserted < 0) {  // no tetrahedron had a proposal
        if (!needs_front) break;
        needs_front = false;
        continue;
      }
      needs_front = true;
    }
    report_.n_left = std::ranges::count(inserter_.state(), k_given_up);
    report_.n_far = count_far();
    report_.n_serial = inserter_.n_serial();
    report_.bytes = bytes();
    return report_;
  }

 private:
  double bytes() const { return static_cast<double>(mesh_.nodes.size()) * 34.0 + static_cast<double>(mesh_.points.size()) * 24.0; }
  std::array<Vec3, 4> corners(std::size_t t) const {
    const Corners& v = mesh_.nodes[t];
    return {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]], mesh_.points[v[3]]};
  }
  double length_at(const Vec3& p) const { return k_length_factor * sizes_(p); }
  /// Reports the progress by the number of tetrahedra relative to the expected number.
  void report_progress() const {
    const double n = static_cast<double>(mesh_.nodes.size()), all = k_share_expected * static_cast<double>(expected_);
    context_.progress(n < all ? n / all : n / (n + 0.1 * all));
  }
  void judge();
  std::int64_t count_far() const;
  void drop_hopeless(std::vector<Seed>& proposed);
  void count_proposal(std::uint32_t t) {
    std::uint8_t& state = inserter_.state()[t];
    state = state + 1 < k_waiting + k_most_proposals ? static_cast<std::uint8_t>(state + 1) : k_given_up;
  }
  std::int64_t round(bool needs_front);
  std::optional<Seed> propose(std::uint32_t t, bool needs_front) const;
  struct Location {
    Vec3 position;
    double length = 0.0;  ///< target length there
  };
  std::optional<Location> in_front(std::size_t face, const std::array<Vec3, 4>& p, const Sphere& sphere) const;

  TetMesh& mesh_;
  const SizeFunction& sizes_;
  double most_bytes_;
  const RunContext& context_;
  BulkInserter inserter_;
  std::uint32_t n_corners_;
  std::size_t expected_;                   ///< number of tetrahedra for which memory is reserved
  std::vector<std::uint8_t> has_waiting_;  ///< per chunk: some of its tetrahedra may have proposals
  RefineReport report_;
};

/// Determines which of the new tetrahedra are too large.
void Refiner::judge() {
  std::vector<std::uint8_t>&state = inserter_.state(), &is_changed = inserter_.is_changed();
  has_waiting_.resize(is_changed.size(), 0);
  parallel_for(
      context_, is_changed.size(),
      [&](std::size_t chunk) {
        if (is_changed[chunk] == 0) return;
        is_changed[chunk] = 0;
        for (std::size_t t = chunk * k_chunk; t < std::min((chunk + 1) * k_chunk, mesh_.nodes.size()); ++t) {
          if (state[t] != k_unseen || !mesh_.is_alive(static_cast<std::uint32_t>(t))) continue;
          const std::array<Vec3, 4> p = corners(t);
          state[t] = circumsphere(p).radius <= k_radius_limit * length_at(0.25 * (p[0] + p[1] + p[2] + p[3])) ? k_right : k_waiting;
          if (state[t] == k_waiting) has_waiting_[chunk] = 1;
        }
      },
      1);
}

std::int64_t Refiner::count_far() const {
  const auto reaches_far = [&](std::size_t t) {
    const std::array<Vec3, 4> p = corners(t);
    const double length = length_at(0.25 * (p[0] + p[1] + p[2] + p[3]));
    double longest = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (mesh_.nodes[t][i] >= n_corners_ || mesh_.nodes[t][j] >= n_corners_) longest = std::max(longest, distance(p[i], p[j]));
    return longest > k_far_edge * length && circumsphere(p).radius > k_far_radius * length;
  };
  const auto count = [&](std::size_t begin, std::size_t end) {
    std::int64_t n = 0;
    for (std::size_t t = begin; t < end; ++t)
      if (inserter_.state()[t] == k_given_up && mesh_.is_alive(static_cast<std::uint32_t>(t)) && reaches_far(t)) ++n;
    return n;
  };
  return parallel_reduce(context_, mesh_.nodes.size(), std::int64_t{0}, count, std::plus());
}

/// Returns the point in front of a face, between the centre of its circle and that of the sphere.
std::optional<Refiner::Location> Refiner::in_front(std::size_t face, const std::array<Vec3, 4>& p, const Sphere& sphere) const {
  const Base base = base_of(p[k_face[face][0]], p[k_face[face][1]], p[k_face[face][2]]);
  // Approximate position of the new point: above the face at the height of a regular tetrahedron.
  const double length = length_at(base.middle + std::numbers::sqrt2 * base.radius * base.normal), edge = k_front_edge * length;
  if (base.radius > 0.95 * edge) {  // the face is larger than the target length here
    const Vec3 low = base.middle + k_least_height * edge * base.normal;
    return Location{low, length_at(low)};
  }
  const double height = std::max(std::sqrt(edge * edge - base.radius * base.radius), k_least_height * edge);
  const double to_center = dot(sphere.center - base.center, base.normal);
  if (to_center <= k_merge * height) return std::nullopt;
  return Location{base.center + height * base.normal, length};
}

std::optional<Seed> Refiner::propose(std::uint32_t t, bool needs_front) const {
  const std::vector<std::uint8_t>& state = inserter_.state();
  const int n_proposed = state[t] - k_waiting;
  const std::array<Vec3, 4> p = corners(t);
  std::size_t best = 4;
  double best_area = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t n = mesh_.neighbours[t][i];
    if (n != k_none && state[n / 4] >= k_waiting) continue;
    const double area = norm2(cross(p[k_face[i][1]] - p[k_face[i][0]], p[k_face[i][2]] - p[k_face[i][0]]));
    if (best < 4 && area >= best_area) continue;
    best = i;
    best_area = area;
  }
  if (needs_front && best == 4) return std::nullopt;
  const Sphere sphere = circumsphere(p);
  Seed seed{.start = t};
  std::optional<Location> location;
  if (n_proposed == 0 && best < 4) location = in_front(best, p, sphere);
  seed.position = sphere.center;
  if (n_proposed >= 2 || !(sphere.radius < std::numeric_limits<double>::infinity())) seed.position = 0.25 * (p[0] + p[1] + p[2] + p[3]);
  if (location) seed.position = location->position;
  const double length = location ? location->length : length_at(seed.position);
  seed.room = {.to_points = k_least_distance * length, .to_corners = k_corner_distance * length, .to_boundary = k_boundary_height * length};
  return seed;
}

/// Removes proposals that are too near to a corner of their own tetrahedron, which is given up if it has no other proposal.
void Refiner::drop_hopeless(std::vector<Seed>& proposed) {
  std::vector<std::uint8_t> is_hopeless(proposed.size());
  parallel_for(context_, proposed.size(), [&](std::size_t i) {
    const Seed& seed = proposed[i];
    is_hopeless[i] = std::ranges::any_of(mesh_.nodes[seed.start], [&](std::uint32_t v) {
      const double least = v < n_corners_ ? seed.room.to_corners : seed.room.to_points;
      return norm2(mesh_.points[v] - seed.position) < least * least;
    });
  });
  std::size_t n_kept = 0;
  for (std::size_t i = 0; i < proposed.size(); ++i) {
    if (is_hopeless[i]) count_proposal(proposed[i].start);
    else proposed[n_kept++] = proposed[i];
  }
  proposed.resize(n_kept);
}

/// Runs one round. \return -1: no tetrahedron had a proposal
std::int64_t Refiner::round(bool needs_front) {
  std::vector<std::uint8_t>& state = inserter_.state();
  std::vector<Seed> proposed = parallel_collect<Seed>(
      context_, has_waiting_.size(),
      [&](std::size_t chunk, std::size_t, std::vector<Seed>& list) {
        if (has_waiting_[chunk] == 0) return;
        has_waiting_[chunk] = 0;
        for (std::size_t t = chunk * k_chunk; t < std::min((chunk + 1) * k_chunk, mesh_.nodes.size()); ++t) {
          if (state[t] < k_waiting || !mesh_.is_alive(static_cast<std::uint32_t>(t))) continue;
          has_waiting_[chunk] = 1;
          if (const std::optional<Seed> seed = propose(static_cast<std::uint32_t>(t), needs_front)) list.push_back(*seed);
        }
      },
      1);
  if (proposed.empty()) return -1;
  drop_hopeless(proposed);
  const std::vector<std::uint32_t> order = inserter_.order_along_curve(proposed, context_);
  const std::vector<Seed> seeds = parallel_collect<Seed>(
      context_, order.size(),
      [&](std::size_t begin, std::size_t end, std::vector<Seed>& list) {
        for (const std::uint32_t i : thinned(proposed, std::span(order).subspan(begin, end - begin))) list.push_back(proposed[i]);
      },
      k_thinned_together);
  // Count the proposals before the insertion. A tetrahedron that still exists afterwards has a rejected proposal. Proposals that lost against a point of this
  // round do not count.
  std::vector<std::uint8_t> before;
  for (const Seed& seed : seeds) {
    before.push_back(state[seed.start]);
    count_proposal(seed.start);
  }
  const std::vector<Insertion> results = inserter_.insert_in_order(seeds, context_);
  for (std::size_t i = 0; i < seeds.size(); ++i)
    if (results[i] == Insertion::beaten && state[seeds[i].start] != k_unseen) state[seeds[i].start] = before[i];
  const std::int64_t n_inserted = std::ranges::count(results, Insertion::done);
  report_.n_candidates += static_cast<std::int64_t>(seeds.size());
  report_.n_inserted += n_inserted;
  if (context_.threads() > 0) {
    std::array<std::int64_t, 7> counts{};
    for (const Insertion r : results) ++counts[static_cast<std::size_t>(r)];
    context_.debug("refinement round " + std::to_string(report_.rounds) + ": " + std::to_string(seeds.size()) + " candidates, " + std::to_string(n_inserted) +
                   " inserted, " + std::to_string(counts[1]) + " outside, " + std::to_string(counts[2]) + " too near, " + std::to_string(counts[3]) +
                   " beaten, " + std::to_string(counts[4]) + " too low, " + std::to_string(counts[5]) + " without cavity, " +
                   std::to_string(inserter_.n_serial()) + " serial so far");
  }
  return n_inserted;
}

}  // namespace

RefineReport refine(TetMesh& mesh, std::uint32_t n_kept_points, const SizeFunction& sizes, const RunContext& context, double most_bytes, std::size_t expected) {
  mesh.points.reserve(mesh.points.size() + expected / 5);
  const RefineReport report = Refiner(mesh, n_kept_points, sizes, most_bytes, expected, context).run();
  compact(mesh, n_kept_points);
  return report;
}

}  // namespace sterna::tets
