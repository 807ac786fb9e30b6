#include "volmesh/tetra/preflight.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/math/intersect.h"
#include "geom/mesh/bvh.h"
#include "volmesh/tetra/boundary_check.h"
#include "volmesh/tetra/tetra_baffles.h"

namespace sterna::volmesh {
namespace {

constexpr std::size_t k_triangle_chunk = 512;   ///< triangles per task, which takes about 2 ms
constexpr std::int64_t k_findings_kept = 1000;  ///< largest number of stored findings of each kind
constexpr int k_angle_digits = 3;               ///< number of digits in messages
/// A triangle with a smaller ratio of height to longest edge has no normal that could separate it from other triangles.
constexpr double k_flat_sine = 1e-6;
/// Upper bound of the rounding error of a distance to a plane, relative to the largest coordinate.
constexpr double k_rounding = 1e-12;

struct Shape {
  Vec3 normal;  ///< unit normal; zero for a flat triangle
  double mean_edge = 0.0;
  double flatness = 0.0;  ///< ratio of the smallest height to the longest edge
};

Shape shape_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::array<double, 3> edges = {distance(a, b), distance(b, c), distance(c, a)};
  const double longest = std::max({edges[0], edges[1], edges[2]});
  const Vec3 n = cross(b - a, c - a);
  const double twice_area = norm(n);
  Shape shape;
  shape.mean_edge = (edges[0] + edges[1] + edges[2]) / 3.0;
  shape.flatness = twice_area / longest / longest;
  if (shape.flatness > k_flat_sine) shape.normal = n / twice_area;
  return shape;
}

double point_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double length2 = norm2(d);
  const double t = length2 > 0.0 ? std::clamp(dot(p - a, d) / length2, 0.0, 1.0) : 0.0;
  return distance(p, a + t * d);
}

/// Returns the distance of two segments that have no common point.
double segment_to_segment(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = norm2(u), uv = dot(u, v), vv = norm2(v), uw = dot(u, w), vw = dot(v, w);
  const double det = uu * vv - uv * uv;
  if (det > 0.0) {
    const double s = (uv * vw - vv * uw) / det, t = (uu * vw - uv * uw) / det;
    if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) return norm(w + s * u - t * v);
  }
  return std::min({point_to_segment(a, c, d), point_to_segment(b, c, d), point_to_segment(c, a, b), point_to_segment(d, a, b)});
}

/// Returns the distance of two triangles that have no common point. A flat triangle is represented by its edges.
double triangle_to_triangle(const std::array<Vec3, 3>& p, const Vec3& p_normal, const std::array<Vec3, 3>& q, const Vec3& q_normal) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) least = std::min(least, segment_to_segment(p[i], p[(i + 1) % 3], q[j], q[(j + 1) % 3]));
  }
  const auto above_face = [&](const Vec3& x, const std::array<Vec3, 3>& t, const Vec3& n) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (dot(cross(t[(k + 1) % 3] - t[k], x - t[k]), n) <= 0.0) return;  // the condition is also true for n = 0
    }
    least = std::min(least, std::abs(dot(x - t[0], n)));
  };
  for (std::size_t k = 0; k < 3; ++k) {
    above_face(p[k], q, q_normal);
    above_face(q[k], p, p_normal);
  }
  return least;
}

class Findings {
 public:
  void add(Trouble trouble, std::uint32_t a, std::uint32_t b, double value) {
    const auto kind = static_cast<std::size_t>(trouble);
    if (++report_.counts[kind] <= k_findings_kept) report_.findings.push_back({trouble, {a, b}, value});
  }
  PreflightReport take() { return std::move(report_); }

 private:
  PreflightReport report_;
};

PreflightReport joined(PreflightReport a, const PreflightReport& b) {
  std::array<std::int64_t, 5> n_seen = a.counts;
  for (const PreflightFinding& finding : b.findings) {
    if (++n_seen[static_cast<std::size_t>(finding.trouble)] <= k_findings_kept) a.findings.push_back(finding);
  }
  for (std::size_t i = 0; i < a.counts.size(); ++i) a.counts[i] += b.counts[i];
  return a;
}

/// Tests pairs of triangles.
class Inspector {
 public:
  Inspector(const TetraBoundary& boundary, const PreflightLimits& limits, const RunContext& context)
      : boundary_(boundary), limits_(limits), shapes_(boundary.triangles.size()) {
    parallel_for(context, shapes_.size(), [&](std::size_t t) {
      const auto [a, b, c] = corners(static_cast<std::uint32_t>(t));
      shapes_[t] = shape_of(a, b, c);
    });
    for (const Vec3& p : boundary.points) largest_coordinate_ = std::max({largest_coordinate_, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  }

  /// Returns the triangle's box, widened by the largest distance that counts as a gap.
  Box box_of(std::uint32_t t) const {
    Box box;
    for (const Vec3& p : corners(t)) box.add(p);
    const double wide = limits_.gap * shapes_[t].mean_edge;
    box.min -= Vec3{wide, wide, wide};
    box.max += Vec3{wide, wide, wide};
    return box;
  }

  void inspect(std::uint32_t t, Findings& findings) const {
    if (shapes_[t].flatness < limits_.sliver) findings.add(Trouble::sliver, t, t, shapes_[t].flatness);
  }

  void inspect(std::uint32_t a, std::uint32_t b, Findings& findings) const {
    switch (n_shared(a, b)) {
      case 0: return inspect_strangers(a, b, findings);
      case 1:
        if (crosses(a, b)) findings.add(Trouble::crossing, a, b, 0.0);
        return;
      case 2: return inspect_neighbours(a, b, findings);
      default: findings.add(Trouble::duplicate, a, b, 0.0);
    }
  }

 private:
  std::array<Vec3, 3> corners(std::uint32_t t) const {
    const auto& v = boundary_.triangles[t];
    return {boundary_.points[v[0]], boundary_.points[v[1]], boundary_.points[v[2]]};
  }
  int n_shared(std::uint32_t a, std::uint32_t b) const {
    int n = 0;
    for (const std::uint32_t v : boundary_.triangles[a]) n += std::ranges::count(boundary_.triangles[b], v) > 0;
    return n;
  }
  bool crosses(std::uint32_t a, std::uint32_t b) const {
    return limits_.searches_crossings && triangles_cross(boundary_.points, boundary_.triangles[a], boundary_.triangles[b]);
  }
  /// Returns true if q lies entirely on one side of p's plane, farther from it than `margin`.
  static bool is_apart(const std::array<Vec3, 3>& p, const Vec3& normal, const std::array<Vec3, 3>& q, double margin) {
    const double d0 = dot(q[0] - p[0], normal), d1 = dot(q[1] - p[0], normal), d2 = dot(q[2] - p[0], normal);
    return std::min({d0, d1, d2}) > margin || std::max({d0, d1, d2}) < -margin;  // this is never true for a flat p, because its normal is zero
  }

  void inspect_strangers(std::uint32_t a, std::uint32_t b, Findings& findings) const {
    const double mean_edge = std::min(shapes_[a].mean_edge, shapes_[b].mean_edge);
    const double limit = limits_.gap * mean_edge;
    const double margin = limit + k_rounding * largest_coordinate_;
    const auto p = corners(a), q = corners(b);
    if (is_apart(p, shapes_[a].normal, q, margin) || is_apart(q, shapes_[b].normal, p, margin)) return;
    if (crosses(a, b)) return findings.add(Trouble::crossing, a, b, 0.0);
    const double distance = triangle_to_triangle(p, shapes_[a].normal, q, shapes_[b].normal);
    if (distance < limit) findings.add(Trouble::gap, a, b, distance / mean_edge);
  }

  void inspect_neighbours(std::uint32_t a, std::uint32_t b, Findings& findings) const {
    if (crosses(a, b)) return findings.add(Trouble::crossing, a, b, 0.0);
    const Vec3 &n = shapes_[a].normal, &m = shapes_[b].normal;
    if (norm2(n) == 0.0 || norm2(m) == 0.0) return;
    // For consistently oriented triangles the angle is pi if they are flat, and 0 if they lie back to back.
    const double angle = std::atan2(norm(cross(n, m)), -dot(n, m));
    if (angle < limits_.fold_angle) findings.add(Trouble::folded, a, b, angle);
  }

  const TetraBoundary& boundary_;
  const PreflightLimits& limits_;
  std::vector<Shape> shapes_;
  double largest_coordinate_ = 0.0;
};

std::string text_of(const PreflightFinding& finding) {
  const std::string other = std::to_string(finding.triangles[1]);
  switch (finding.trouble) {
    case Trouble::crossing: return "crosses " + other;
    case Trouble::duplicate: return "is the same as " + other;
    case Trouble::folded: return "is folded onto " + other + ", angle " + number_text(finding.value * 180.0 / std::numbers::pi, k_angle_digits) + " deg";
    case Trouble::sliver: return "is a sliver, height over longest edge " + number_text(finding.value, k_angle_digits);
    case Trouble::gap: return "is close to " + other + ", distance over edge " + number_text(finding.value, k_angle_digits);
  }
  return {};
}

}  // namespace

std::string_view to_string(Trouble trouble) {
  constexpr std::array<std::string_view, 5> texts = {"pairs of triangles that cross", "pairs of triangles with the same vertices",
                                                     "pairs of neighbours folded onto each other", "slivers", "pairs of triangles close to each other"};
  return texts[static_cast<std::size_t>(trouble)];
}

PreflightReport preflight(const TetraBoundary& boundary, const PreflightLimits& limits, const RunContext& context) {
  if (boundary.traits.has_baffles) {
    const JoinedBoundary joined = join_baffles(boundary, context);
    PreflightReport report = preflight({.points = joined.points, .triangles = joined.facets, .hole_points = {}}, limits, context);
    for (PreflightFinding& finding : report.findings)
      for (std::uint32_t& t : finding.triangles) t = joined.facet2triangle[t];
    return report;
  }
  const Inspector inspector(boundary, limits, context);
  std::vector<Box> boxes(boundary.triangles.size());
  parallel_for(context, boxes.size(), [&](std::size_t t) { boxes[t] = inspector.box_of(static_cast<std::uint32_t>(t)); });
  const BoxTree tree(boxes, context);
  PreflightReport report = parallel_reduce(
      context, boxes.size(), PreflightReport{},
      [&](std::size_t begin, std::size_t end) {
        Findings findings;
        std::vector<std::uint32_t> partners;
        for (std::size_t t = begin; t < end; ++t) {
          const auto a = static_cast<std::uint32_t>(t);
          inspector.inspect(a, findings);
          partners.clear();
          tree.for_each_overlap(boxes[t], [&](std::uint32_t b) {
            if (b > a) partners.push_back(b);
            return true;
          });
          std::ranges::sort(partners);
          for (const std::uint32_t b : partners) inspector.inspect(a, b, findings);
        }
        return findings.take();
      },
      joined, k_triangle_chunk);
  report.clear = ClearProof(limits.searches_crossings && report.count(Trouble::crossing) == 0 && report.count(Trouble::duplicate) == 0);
  return report;
}

void add_suspects(const PreflightReport& report, const TetraBoundary& boundary, ErrorInfo& error) {
  if (!error.locations.empty()) return;
  for (const Trouble trouble : {Trouble::folded, Trouble::gap, Trouble::sliver}) {
    error.n_locations += report.count(trouble);
    std::vector<PreflightFinding> worst;
    std::ranges::copy_if(report.findings, std::back_inserter(worst), [&](const PreflightFinding& f) { return f.trouble == trouble; });
    std::ranges::stable_sort(worst, std::less(), &PreflightFinding::value);
    for (const PreflightFinding& finding : worst) {
      if (error.locations.size() < k_max_locations)
        error.locations.push_back(location_of_triangle(boundary, finding.triangles[0], text_of(finding) + " (difficult for tetrahedra engines)"));
      for (const std::uint32_t t : finding.triangles) add_triangle(error.geometry, boundary, t);
    }
  }
}

void judge(const PreflightReport& report, const TetraBoundary& boundary, const RunContext& context) {
  for (const Trouble trouble : {Trouble::folded, Trouble::sliver, Trouble::gap}) {
    if (report.count(trouble) == 0) continue;
    const auto first = std::ranges::find(report.findings, trouble, &PreflightFinding::trouble);
    const ErrorLocation location = location_of_triangle(boundary, first->triangles[0], text_of(*first));
    context.warn("boundary of the tetrahedra: " + std::to_string(report.count(trouble)) + " " + std::string(to_string(trouble)) + ", the first at " +
                 format_point(location.position) + ": " + location.what);
  }
  const std::int64_t n_fatal = report.count(Trouble::crossing) + report.count(Trouble::duplicate);
  if (n_fatal == 0) return;
  ErrorInfo error{.code = ErrorCode::self_intersection,
                  .attempted = "checking the boundary of the tetrahedra",
                  .n_locations = n_fatal,
                  .hint = "repair the crossing triangles"};
  for (const Trouble trouble : {Trouble::crossing, Trouble::duplicate}) {
    if (report.count(trouble) > 0)
      error.problem += (error.problem.empty() ? "" : ", ") + std::to_string(report.count(trouble)) + " " + std::string(to_string(trouble));
  }
  for (const PreflightFinding& finding : report.findings) {
    if (finding.trouble != Trouble::crossing && finding.trouble != Trouble::duplicate) continue;
    if (error.locations.size() < k_max_locations) error.locations.push_back(location_of_triangle(boundary, finding.triangles[0], text_of(finding)));
    for (const std::uint32_t t : finding.triangles) add_triangle(error.geometry, boundary, t);
  }
  throw Error(std::move(error));
}

}  // namespace sterna::volmesh
