#include "surfmesh/stitch/weld.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <optional>

#include "geom/base/disjoint_sets.h"
#include "geom/base/error.h"
#include "geom/mesh/bvh.h"
#include "surfmesh/stitch/clean_facets.h"
#include "surfmesh/stitch/edge_table.h"

namespace sterna::surfmesh {
namespace {

/// Automatic tolerance for numbers in double precision, relative to the body length. Programs that mirror, move or print vertices lose some of the 16 digits.
/// (On the test surfaces gaps were up to 1e-13, and the next larger ones above 1e-7.)
constexpr double k_weld_double = 1e-9;
/// Automatic tolerance for files that store single precision, relative to the largest coordinate: two units in the last place, 2^-23 each.
constexpr double k_weld_single = 2.5e-7;
/// Largest tolerance that a user may give, relative to the body length. With a larger one no surface would remain, and the candidate pairs would exceed the
/// memory.
constexpr double k_max_weld = 0.02;

/// Numbers points by value, using open addressing. Points are numbered in the order of their first occurrence, so the numbers depend only on the order of the
/// input.
class PointIndex {
 public:
  explicit PointIndex(std::size_t n) : slots_(std::bit_ceil(2 * n + 2), k_none) {}

  std::uint32_t find_or_add(Vec3 p, std::vector<Vec3>& points) {
    p += Vec3{};  // -0 becomes +0
    std::size_t slot = hash(p) & (slots_.size() - 1);
    while (slots_[slot] != k_none && !(points[slots_[slot]] == p)) slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot] == k_none) {
      if (points.size() >= k_none) throw_id_overflow(points.size());
      slots_[slot] = static_cast<std::uint32_t>(points.size());
      points.push_back(p);
    }
    return slots_[slot];
  }

 private:
  static std::size_t hash(const Vec3& p) {
    std::uint64_t h = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      h = (h ^ std::bit_cast<std::uint64_t>(p[axis])) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    return h;
  }

  std::vector<std::uint32_t> slots_;
};

[[noreturn]] void throw_malformed(const SurfaceSoup& soup, std::size_t facet, const std::string& problem) {
  ErrorInfo info;
  info.code = ErrorCode::file_malformed;
  info.attempted = "joining the facets of " + soup.source;
  info.problem = "facet " + std::to_string(facet + 1) + " " + problem;
  throw Error(std::move(info));
}

/// Returns the automatic tolerance in the file's unit.
double automatic_tolerance(const WorkingSurface& surface) {
  const Box box = surface.box();
  double tolerance = k_weld_double * box.longest_side();
  if (surface.is_single_precision) {
    double largest = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) largest = std::max({largest, std::abs(box.min[axis]), std::abs(box.max[axis])});
    tolerance = std::max(tolerance, k_weld_single * largest);
  }
  return tolerance;
}

/// \throws Error(bad_argument) if the given tolerance is too large for the body
void check_tolerance(const WorkingSurface& surface, double tolerance) {
  const double length = surface.to_metres * surface.box().longest_side();
  if (tolerance <= k_max_weld * length) return;
  ErrorInfo info;
  info.code = ErrorCode::bad_argument;
  info.attempted = "welding the vertices of the surface";
  info.problem = "weld_tolerance is " + short_number(tolerance) + " m, more than " + short_number(100.0 * k_max_weld) + " % of the body length of " +
                 short_number(length) + " m";
  info.hint = "a tolerance below the shortest edge; weld_tolerance is always in metres, independent of the unit of the file";
  throw Error(std::move(info));
}

/// Returns for every point the lowest point of its chain of candidates within the tolerance (the point itself if it has no candidates nearby).
std::vector<std::uint32_t> near_representatives(const WorkingSurface& surface, const std::vector<std::uint32_t>& candidates, double tolerance,
                                                const RunContext& context) {
  std::vector<Box> boxes(candidates.size());
  const double reach = 0.51 * tolerance;  // a little more than half; the exact distance is tested afterwards
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Vec3& p = surface.points[candidates[i]];
    boxes[i] = {p - Vec3{reach, reach, reach}, p + Vec3{reach, reach, reach}};
  }
  DisjointSets welded(surface.points.size());
  for (const auto& [i, j] : BoxTree(boxes, context).overlapping_pairs(context)) {
    if (distance(surface.points[candidates[i]], surface.points[candidates[j]]) > tolerance) continue;
    welded.join(candidates[i], candidates[j]);
  }
  return std::move(welded).roots();
}

/// Returns the used vertices in ascending order; if `defects` are given, only those on boundary edges.
std::vector<std::uint32_t> weld_candidates(const WorkingSurface& surface, const Defects* defects) {
  std::vector<char> is_candidate(surface.points.size(), 0);
  if (defects) {
    for (const Edge& edge : defects->boundary) is_candidate[edge.low] = is_candidate[edge.high] = 1;
  } else {
    for (const Facet& facet : surface.facets)
      for (const std::uint32_t v : facet) is_candidate[v] = 1;
  }
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t v = 0; v < is_candidate.size(); ++v)
    if (is_candidate[v]) candidates.push_back(v);
  return candidates;
}

}  // namespace

WorkingSurface weld_exact(const std::vector<SurfaceSoup>& soups, const StitchOptions& options, StitchReport& report) {
  WorkingSurface surface;
  surface.to_metres = options.unit;
  std::size_t n_points = 0;
  std::size_t n_facets = 0;
  surface.first_patch.push_back(0);
  for (const SurfaceSoup& soup : soups) {
    n_points += soup.points.size();
    n_facets += soup.triangles.size();
    surface.first_patch.push_back(surface.first_patch.back() + static_cast<std::uint32_t>(soup.patch_names.size()));
    surface.sources.push_back(soup.source);
    surface.is_single_precision |= soup.single_precision;
  }
  report.n_triangles_read = static_cast<std::int64_t>(n_facets);
  report.n_vertices_read = static_cast<std::int64_t>(n_points);
  surface.facets.reserve(n_facets);
  surface.patch.reserve(n_facets);
  surface.origin.reserve(n_facets);

  PointIndex index(n_points);
  for (std::uint32_t s = 0; s < soups.size(); ++s) {
    const SurfaceSoup& soup = soups[s];
    std::vector<std::uint32_t> soup2surface(soup.points.size(), k_none);
    for (std::uint32_t t = 0; t < soup.triangles.size(); ++t) {
      Facet facet{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = soup.triangles[t][k];
        if (v >= soup.points.size()) throw_malformed(soup, t, "refers to vertex " + std::to_string(v) + " of " + std::to_string(soup.points.size()));
        if (soup2surface[v] == k_none) {
          if (!is_finite(soup.points[v])) throw_malformed(soup, t, "has a coordinate that is not a finite number");
          soup2surface[v] = index.find_or_add(soup.points[v], surface.points);
        }
        facet[k] = soup2surface[v];
      }
      if (soup.patch[t] >= soup.patch_names.size())
        throw_malformed(soup, t, "belongs to patch " + std::to_string(soup.patch[t]) + " of " + std::to_string(soup.patch_names.size()));
      surface.facets.push_back(facet);
      surface.patch.push_back(surface.first_patch[s] + soup.patch[t]);
      surface.origin.push_back({s, t});
    }
    report.n_unused_vertices += std::count(soup2surface.begin(), soup2surface.end(), k_none);
  }
  report.n_welded_exact = report.n_vertices_read - report.n_unused_vertices - static_cast<std::int64_t>(surface.points.size());
  return surface;
}

double weld_tolerance_in_use(const WorkingSurface& surface, const StitchOptions& options) {
  return is_automatic(options.weld_tolerance) ? surface.to_metres * automatic_tolerance(surface) : options.weld_tolerance;
}

void weld_near(WorkingSurface& surface, const StitchOptions& options, StitchReport& report, const RunContext& context) {
  const bool automatic = is_automatic(options.weld_tolerance);
  const double tolerance = weld_tolerance_in_use(surface, options) / surface.to_metres;
  if (!(tolerance > 0.0) || surface.facets.empty()) return;
  if (!automatic) check_tolerance(surface, options.weld_tolerance);
  std::optional<Defects> before;
  if (automatic) {
    before = find_defects(surface.facets, surface.points.size(), EdgeTable(surface.facets, surface.points.size()));
    if (before->boundary.empty()) return;
  }
  const auto candidates = weld_candidates(surface, before ? &*before : nullptr);
  const auto representative = near_representatives(surface, candidates, tolerance, context);
  std::int64_t n_welded = 0;
  for (std::uint32_t v = 0; v < representative.size(); ++v) n_welded += representative[v] != v;
  if (n_welded == 0) return;

  WorkingSurface welded = surface;
  for (Facet& facet : welded.facets)
    for (std::uint32_t& v : facet) v = representative[v];
  StitchReport trial = report;
  drop_degenerate_facets(welded, trial);
  drop_doubled_facets(welded, trial);
  if (before) {
    const Defects after = find_defects(welded.facets, welded.points.size(), EdgeTable(welded.facets, welded.points.size()));
    if (after.boundary.size() >= before->boundary.size() || after.crowded.size() > before->crowded.size() || after.pinched.size() > before->pinched.size()) {
      report.messages.push_back("did not weld " + count_of(n_welded, "vertex", "vertices") + " of the boundary within " +
                                short_number(tolerance * surface.to_metres) + " m of others: welding them would close no gap or create other defects");
      return;
    }
  }
  surface = std::move(welded);
  report = std::move(trial);
  report.n_welded_near += n_welded;
  report.messages.push_back("welded " + count_of(n_welded, "vertex", "vertices") + (automatic ? " of the boundary" : "") + " to others within " +
                            short_number(tolerance * surface.to_metres) + " m");
}

void separate_parts(WorkingSurface& surface) {
  const EdgeTable edges(surface.facets, surface.points.size());
  const Parts parts = connected_parts(surface.n_facets(), edges);
  if (parts.count < 2) return;
  std::vector<std::uint32_t> owner(surface.points.size(), k_none);
  struct Copy {
    std::uint32_t vertex, part, facet, corner;
    auto key() const { return std::array{vertex, part, facet, corner}; }
  };
  std::vector<Copy> copies;
  for (std::uint32_t t = 0; t < surface.n_facets(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t v = surface.facets[t][k];
      if (owner[v] == k_none) owner[v] = parts.part[t];
      if (owner[v] != parts.part[t]) copies.push_back({v, parts.part[t], t, k});
    }
  }
  std::sort(copies.begin(), copies.end(), [](const Copy& a, const Copy& b) { return a.key() < b.key(); });
  for (std::size_t i = 0; i < copies.size(); ++i) {
    if (i == 0 || copies[i].vertex != copies[i - 1].vertex || copies[i].part != copies[i - 1].part) {
      const Vec3 p = surface.points[copies[i].vertex];
      surface.points.push_back(p);
    }
    surface.facets[copies[i].facet][copies[i].corner] = static_cast<std::uint32_t>(surface.points.size() - 1);
  }
}

}  // namespace sterna::surfmesh
