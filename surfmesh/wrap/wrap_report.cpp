#include "surfmesh/wrap/wrap_report.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geom/base/disjoint_sets.h"
#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "geom/mesh/topology.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_fair_angle = 0.2618;  ///< rad, 15 degrees
constexpr double k_no_angle = 3.2;       ///< rad, above every angle
/// Winding number of the input above which a location is inside: above the value of one half on its surface.
constexpr double k_inside = 0.55;
/// Relative to the edge: distance in front of the wrap at which leaks are detected.
constexpr double k_leak_probe = 0.25;
/// Relative to the edge squared: leaks with a smaller area are folds of the surface.
constexpr double k_leak_area = 20.0;

struct TriangleFinding {
  double distance = 0.0;  ///< m, distance of the farthest sample
  Vec3 sample;
  bool is_over_border = false;  ///< the nearest location to that sample is on a border of the input
  bool is_leak = false;
};

struct InputFinding {
  double distance = 0.0;  ///< m, distance of the farthest sample that is not inside
  bool is_inside = false;
};

std::string locations(std::int64_t n) { return n == 1 ? "1 place" : std::to_string(n) + " places"; }

/// Returns the flagged triangles in edge-connected groups, ordered by their first triangles.
std::vector<std::vector<std::uint32_t>> groups_of(const std::vector<char>& flag, const Topology& topology) {
  std::vector<std::vector<std::uint32_t>> groups;
  std::vector<char> is_done(flag.size(), 0);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t s = 0; s < flag.size(); ++s) {
    if (!flag[s] || is_done[s]) continue;
    groups.emplace_back();
    is_done[s] = 1;
    stack.push_back(s);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      groups.back().push_back(t);
      for (std::uint32_t k = 0; k < 3; ++k) {
        const auto o = static_cast<std::uint32_t>(triangle_of(topology.twin(HalfedgeId(3 * t + k))).index());
        if (!flag[o] || is_done[o]) continue;
        is_done[o] = 1;
        stack.push_back(o);
      }
    }
    std::sort(groups.back().begin(), groups.back().end());
  }
  return groups;
}

void draw_closures(const TriMesh& mesh, const WrapInput& input, const std::vector<char>& is_closure, const std::vector<char>& is_leak, WrapDrawing& drawing) {
  const std::size_t axis = input.half_axis == "x" ? 0 : input.half_axis == "y" ? 1 : 2;
  std::map<VertexId, std::uint32_t> number;
  for (const TriangleId t : mesh.triangles.ids()) {
    if (!is_closure[t.index()] && !is_leak[t.index()]) continue;
    const auto c = corners(mesh, t);
    const Vec3 middle = (c[0] + c[1] + c[2]) / 3.0;
    if (!input.half_axis.empty() && (middle[axis] > input.half_at) != input.is_half_above) continue;
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId v = mesh.triangles[t][k];
      const auto [found, is_new] = number.try_emplace(v, static_cast<std::uint32_t>(drawing.points.size()));
      if (is_new) drawing.points.push_back(mesh.points[v]);
      triangle[k] = found->second;
    }
    drawing.triangles.push_back(triangle);
  }
}

/// A wrap with its measurements. compare_with_input() and list_closures() make them, the other steps read them.
struct MeasuredWrap {
  const FittedWrap& wrap;
  const InputSurface& surface;
  const WrapSizes& sizes;
  TriMesh mesh;
  Topology topology;
  std::vector<TriangleFinding> found = {};                       ///< findings for each triangle
  std::vector<char> is_far = {}, is_closure = {}, is_leak = {};  ///< flags of each triangle; far: beyond the tolerance
};

/// Returns the corners, the middles of the sides and the middle of a triangle, where distances are measured.
std::array<Vec3, 7> samples_of(const std::array<Vec3, 3>& c) {
  return {(c[0] + c[1] + c[2]) / 3.0, 0.5 * (c[0] + c[1]), 0.5 * (c[1] + c[2]), 0.5 * (c[2] + c[0]), c[0], c[1], c[2]};
}

/// Measures the distances from the wrap to the input, and finds the triangles in front of the inside.
MeasuredWrap compare_with_input(const FittedWrap& wrap, const InputSurface& surface, const WrapSizes& sizes, const RunContext& context) {
  TriMesh mesh = wrap_mesh(wrap.points, wrap.triangles);
  Topology topology(mesh, context);
  MeasuredWrap measured{.wrap = wrap, .surface = surface, .sizes = sizes, .mesh = std::move(mesh), .topology = std::move(topology)};
  const std::size_t n = measured.mesh.n_triangles();
  measured.found.resize(n);
  parallel_for(
      context, n,
      [&](std::size_t t) {
        const auto c = corners(measured.mesh, TriangleId(std::uint64_t{t}));
        const auto samples = samples_of(c);
        TriangleFinding& found = measured.found[t];
        for (const Vec3& p : samples) {
          const NearestHit hit = surface.nearest(p);
          if (hit.distance <= found.distance) continue;
          found.distance = hit.distance;
          found.sample = p;
          found.is_over_border = surface.is_on_border(hit);
        }
        const Vec3 outside = samples.front() + k_leak_probe * sizes.edge * normalized(area_vector(c[0], c[1], c[2]));
        found.is_leak = surface.facets().winding_number(outside) > k_inside;
      },
      128);
  measured.is_closure.assign(n, 0);
  for (const TriangleFinding& found : measured.found) {
    measured.is_far.push_back(found.distance > sizes.tolerance);
    measured.is_leak.push_back(found.is_leak);
  }
  return measured;
}

/// Returns the closure that a group of triangles beyond the tolerance forms. It is an opening if the nearest location is on a border of the input.
WrapClosure closure_of(const std::vector<std::uint32_t>& group, const MeasuredWrap& measured) {
  WrapClosure closure;
  Box box;
  std::size_t n_over_border = 0;
  for (const std::uint32_t t : group) {
    const auto c = corners(measured.mesh, TriangleId(t));
    for (const Vec3& p : c) box.add(p);
    closure.area += triangle_area(c[0], c[1], c[2]);
    closure.distance = std::max(closure.distance, measured.found[t].distance);
    n_over_border += measured.found[t].is_over_border;
  }
  closure.is_opening = 2 * n_over_border >= group.size();
  closure.position = box.center();
  closure.size = box.longest_side();
  return closure;
}

/// Lists the closures and marks their triangles.
void list_closures(MeasuredWrap& measured, WrapReport& report) {
  for (const auto& group : groups_of(measured.is_far, measured.topology)) {
    const WrapClosure closure = closure_of(group, measured);
    // Only grooves of at least this depth count as closed. In shallower ones the fit is rough, and the triangles count as beyond the tolerance.
    if (!closure.is_opening && closure.distance < 0.5 * measured.sizes.edge) continue;
    for (const std::uint32_t t : group) measured.is_closure[t] = 1;
    ++report.n_closures;
    report.closures.push_back(closure);
  }
  std::stable_sort(report.closures.begin(), report.closures.end(), [](const WrapClosure& a, const WrapClosure& b) { return a.size > b.size; });
  if (report.closures.size() > k_max_closures) report.closures.resize(k_max_closures);
}

/// Reports the largest distances from the wrap to the input, on closures and elsewhere.
void report_distances(const MeasuredWrap& measured, WrapReport& report) {
  for (std::size_t t = 0; t < measured.found.size(); ++t) {
    const TriangleFinding& found = measured.found[t];
    double& farthest = measured.is_closure[t] ? report.to_input_closed : report.to_input;
    if (!measured.is_closure[t]) {
      report.n_beyond_tolerance += measured.is_far[t];
      if (found.distance > farthest) report.farthest = found.sample;
    }
    farthest = std::max(farthest, found.distance);
  }
}

void count_vertices(const MeasuredWrap& measured, WrapReport& report) {
  const FittedWrap& wrap = measured.wrap;
  report.n_on_features = std::count_if(wrap.tie.begin(), wrap.tie.end(), [](LineTie t) { return t != LineTie::none; });
  for (const Vec3& p : wrap.points) report.n_off_input += !measured.surface.nearest(p, measured.sizes.tolerance).triangle.is_valid();
}

/// Returns the leak that a group of triangles in front of the inside forms. Its position is the middle of the group's border.
WrapLeak leak_of(const std::vector<std::uint32_t>& group, const MeasuredWrap& measured) {
  WrapLeak leak;
  Vec3 border;
  std::int64_t n_border = 0;
  for (const std::uint32_t t : group) {
    const auto c = corners(measured.mesh, TriangleId(t));
    leak.area += triangle_area(c[0], c[1], c[2]);
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (measured.is_leak[triangle_of(measured.topology.twin(HalfedgeId(3 * t + k))).index()]) continue;
      border += 0.5 * (c[k] + c[(k + 1) % 3]);
      ++n_border;
    }
  }
  leak.position = n_border > 0 ? border / static_cast<double>(n_border) : corners(measured.mesh, TriangleId(group.front()))[0];
  return leak;
}

void list_leaks(const MeasuredWrap& measured, WrapReport& report) {
  for (const auto& group : groups_of(measured.is_leak, measured.topology))
    if (const WrapLeak leak = leak_of(group, measured); !(leak.area < k_leak_area * measured.sizes.edge * measured.sizes.edge)) report.leaks.push_back(leak);
  std::stable_sort(report.leaks.begin(), report.leaks.end(), [](const WrapLeak& a, const WrapLeak& b) { return a.area > b.area; });
}

/// Reports the largest distance from the input to the wrap, and the facets inside the wrap.
void report_input(const MeasuredWrap& measured, WrapReport& report, const RunContext& context) {
  const TriangleTree tree(measured.mesh, context);
  const WrapSizes& sizes = measured.sizes;
  const TriMesh& input = measured.surface.input().mesh;
  std::vector<InputFinding> inputs(input.n_triangles());
  parallel_for(
      context, inputs.size(),
      [&](std::size_t f) {
        const auto samples = samples_of(corners(input, TriangleId(std::uint64_t{f})));
        for (const Vec3& p : samples) {
          const double distance = tree.nearest(p).distance;
          const bool is_inside = distance > sizes.tolerance && tree.winding_number(p) > (sizes.is_fluid_inside ? -0.5 : 0.5);
          if (p == samples.front()) inputs[f].is_inside = is_inside;
          if (!is_inside) inputs[f].distance = std::max(inputs[f].distance, distance);
        }
      },
      128);
  for (std::size_t f = 0; f < inputs.size(); ++f) {
    report.from_input = std::max(report.from_input, inputs[f].distance);
    if (!inputs[f].is_inside) continue;
    ++report.n_inside;
    const auto c = corners(input, TriangleId(std::uint64_t{f}));
    report.inside_area += triangle_area(c[0], c[1], c[2]);
  }
}

WrapQuality quality_of(const MeasuredWrap& measured) {
  WrapQuality quality{.min_angle = k_no_angle};
  for (const TriangleId t : measured.mesh.triangles.ids()) {
    const auto c = corners(measured.mesh, t);
    const double angle = std::min({corner_angle(c[0], c[1], c[2]), corner_angle(c[1], c[2], c[0]), corner_angle(c[2], c[0], c[1])});
    quality.min_angle = std::min(quality.min_angle, angle);
    if (angle >= k_fair_angle) continue;
    ++quality.n_below_15;
    quality.n_at_features += std::ranges::any_of(measured.wrap.triangles[t.index()], [&](std::uint32_t v) { return measured.wrap.tie[v] != LineTie::none; });
  }
  return quality;
}

void write_messages(const WrapSizes& sizes, WrapReport& report) {
  const auto number = wrap_number;
  if (report.n_closures > 0) {
    const WrapClosure& largest = report.closures.front();
    report.messages.push_back("closed " + locations(report.n_closures) + ", the largest " + (largest.is_opening ? "an opening" : "a groove") + " of " +
                              number(largest.size) + " m at " + format_point(largest.position));
  }
  if (report.n_inside > 0)
    report.messages.push_back("dropped " + std::to_string(report.n_inside) + " facets (" + number(report.inside_area) +
                              " m^2) inside the wrap, farther from it than the tolerance");
  for (const WrapLeak& leak : report.leaks)
    report.messages.push_back("leak: the wrap enters the inside near " + format_point(leak.position) + " and covers " + number(leak.area) +
                              " m^2 there; an opening is wider than the gap of " + number(sizes.gap) + " m");
  report.messages.push_back("wrap to input at most " + number(report.to_input) + " m outside closed openings, " + number(report.to_input_closed) +
                            " m in closed openings; input to wrap at most " + number(report.from_input) + " m");
  if (report.n_beyond_tolerance > 0)
    report.messages.push_back(std::to_string(report.n_beyond_tolerance) + " triangles are farther from the input than the tolerance of " +
                              number(sizes.tolerance) + " m, the farthest at " + format_point(report.farthest));
}

}  // namespace

void measure_wrap(const FittedWrap& wrap, const InputSurface& surface, const WrapSizes& sizes, WrapReport& report, const RunContext& context) {
  MeasuredWrap measured = compare_with_input(wrap, surface, sizes, context);
  list_closures(measured, report);
  report_distances(measured, report);
  count_vertices(measured, report);
  list_leaks(measured, report);
  draw_closures(measured.mesh, surface.input(), measured.is_closure, measured.is_leak, report.drawing);
  report_input(measured, report, context);
  report.quality = quality_of(measured);
  write_messages(sizes, report);
}

void prove_wrap(const TriMesh& mesh, const WrapReport& report, const RunContext& context) {
  const Topology topology(mesh, context);
  if (topology.n_boundary_halfedges() > 0) {
    ErrorInfo info{.code = ErrorCode::open_surface, .attempted = "wrapping", .problem = "the wrap is open"};
    const std::size_t axis = report.half_axis == "x" ? 0 : report.half_axis == "y" ? 1 : 2;
    for (std::uint32_t h = 0; h < topology.n_halfedges(); ++h) {
      if (!topology.is_boundary(HalfedgeId(h))) continue;
      const Vec3 &a = mesh.points[topology.from(HalfedgeId(h))], &b = mesh.points[topology.to(HalfedgeId(h))];
      if (!report.half_axis.empty() && a[axis] == report.half_at && b[axis] == report.half_at) continue;
      info.add_location(0.5 * (a + b), "edge with one triangle");
    }
    if (!info.locations.empty()) throw Error(std::move(info));
  }
  const CrossingPairs crossings = find_crossings(mesh, context, k_max_geometry);
  if (crossings.total == 0) return;
  ErrorInfo info{.code = ErrorCode::self_intersection,
                 .attempted = "wrapping",
                 .problem = "the wrap crosses itself in " + locations(crossings.total),
                 .hint = "a smaller edge, or a larger offset"};
  for (const auto& pair : crossings.pairs) {
    const auto c = corners(mesh, TriangleId(pair[0]));
    info.add_location((c[0] + c[1] + c[2]) / 3.0, "two triangles cross");
    for (const std::uint32_t t : pair) {
      const auto n = static_cast<std::uint32_t>(info.geometry.points.size());
      for (const Vec3& p : corners(mesh, TriangleId(t))) info.geometry.points.push_back(p);
      info.geometry.triangles.push_back({n, n + 1, n + 2});
    }
  }
  info.n_locations = crossings.total;
  throw Error(std::move(info));
}

}  // namespace sterna::surfmesh
