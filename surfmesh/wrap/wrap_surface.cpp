// This is the driver. wrap_surface() at the end is the list of its steps; they share a WrapWork.
#include "surfmesh/wrap/wrap_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/base/disjoint_sets.h"
#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"
#include "geom/mesh/half.h"
#include "geom/mesh/topology.h"
#include "surfmesh/stitch/patches.h"
#include "surfmesh/wrap/fit_wrap.h"
#include "surfmesh/wrap/wrap_input.h"
#include "surfmesh/wrap/wrap_report.h"

namespace sterna::surfmesh {
namespace {

/// Measured number of triangles of an alpha wrap on a plane, per area over alpha^2.
constexpr double k_triangles_per_area = 2.6;
constexpr double k_automatic_triangles = 60'000.0;
constexpr double k_finest_edge = 1.0 / 400.0, k_coarsest_edge = 1.0 / 50.0;  ///< relative to the body length: limits of the automatic edge length
constexpr double k_automatic_gap = 0.02;                                     ///< relative to the body length: automatic gap
/// A gap of more than this multiple of the edge needs a separate wrap, because a ball of the edge's radius passes through wider openings.
constexpr double k_gap_of_edge = 2.0;
/// Smallest winding number of the input on closures of its openings. It is about a half on a closure, less where there are many openings, and zero in front of
/// grooves.
constexpr double k_closing = 0.15;
/// Distance between samples of potential closures, relative to the edge, and largest number of samples along a side.
constexpr double k_sample_step = 0.7;
constexpr int k_most_samples = 12;
/// Winding number above which a location is inside the input; fraction of the wrap in front of such locations above which the wrap leaks; and limit, relative
/// to the body length, above which an automatic gap is no longer doubled. A smaller fraction of the wrap is caused by folds.
constexpr double k_inside_input = 0.55, k_leaking_share = 0.05, k_widest_gap = 0.08;
/// Offset of a coarser wrap, relative to the radius of its ball. Radius of the ball, relative to the edge, of a preliminary wrap. The preliminary wrap tests if
/// closures suffice before the wrap with the final ball is made.
constexpr double k_coarse_offset = 0.05, k_glance_ball = 4.0;
/// Relative to the area of the input: a wrap with a larger area covers both sides of baffles. The edge length is then chosen by the area of the wrap.
constexpr double k_both_sides = 1.25;
/// s, time for one point of the alpha wrap including all later steps. It is used for the estimate in messages.
constexpr double k_seconds_per_triangle = 1.5e-4;
/// Relative to the tolerance: distances from the plane of a half model at which the cut is tried.
constexpr std::array k_half_shifts{0.0, 0.2, 0.5, 1.0, 2.0};
constexpr std::size_t k_seed_cells = 24;  ///< number of cells along each axis of the grid on which a location within a tunnel is searched
/// Fractions of the progress at the ends of the steps.
constexpr double k_read_end = 0.05, k_close_end = 0.15, k_wrap_end = 0.5, k_fit_end = 0.85, k_measure_end = 0.95;

std::int64_t expected_triangles(double area, double edge) { return std::llround(k_triangles_per_area * area / (edge * edge)); }

/// \param area m^2, area that triangles will cover
WrapSizes choose_sizes(double area, double length, const WrapOptions& options) {
  WrapSizes sizes;
  sizes.edge = !is_automatic(options.edge)
                   ? options.edge
                   : std::clamp(std::sqrt(k_triangles_per_area * area / k_automatic_triangles), k_finest_edge * length, k_coarsest_edge * length);
  sizes.gap = is_automatic(options.gap) ? std::max(k_gap_of_edge * sizes.edge, k_automatic_gap * length) : options.gap;
  sizes.tolerance = is_automatic(options.tolerance) ? 0.1 * sizes.edge : options.tolerance;
  sizes.offset = is_automatic(options.offset) ? 0.05 * sizes.edge : options.offset;
  return sizes;
}

void check_sizes(const WrapInput& input, const WrapSizes& sizes, const WrapOptions& options) {
  const std::string length = short_number(input.length) + " m";
  if (sizes.edge > 0.5 * input.length)
    throw_bad_argument("wrapping", "edge = " + short_number(sizes.edge) + " m is more than half the body length of " + length);
  if (sizes.gap > input.length) throw_bad_argument("wrapping", "gap = " + short_number(sizes.gap) + " m is more than the body length of " + length);
  if (!is_automatic(options.gap) && sizes.gap < sizes.edge)
    throw_bad_argument(
        "wrapping",
        "gap = " + short_number(sizes.gap) + " m is below the edge of " + short_number(sizes.edge) + " m, which already closes all narrower openings", {},
        "edge = " + short_number(sizes.gap) + " or less, or a larger gap");
  if (!(sizes.offset > 0.0) || sizes.offset > sizes.edge)
    throw_bad_argument("wrapping",
                       "offset = " + short_number(sizes.offset) + " m must be above 0 and not above the edge of " + short_number(sizes.edge) + " m");
  if (!(sizes.tolerance > 0.0)) throw_bad_argument("wrapping", "tolerance must be above 0");
  const std::int64_t expected = expected_triangles(input.area, sizes.edge);
  if (expected <= options.max_triangles) return;
  const double least = std::sqrt(k_triangles_per_area * input.area / options.max_triangles);
  throw_bad_argument("wrapping",
                     "edge = " + short_number(sizes.edge) + " m would give about " + short_number(static_cast<double>(expected)) + " triangles (" +
                         short_number(input.area) + " m^2 of input), more than max_triangles = " + std::to_string(options.max_triangles) + ", in about " +
                         short_number(k_seconds_per_triangle * static_cast<double>(expected)) + " s",
                     {}, "edge = " + short_number(least) + " or more, or a larger max_triangles");
}

AlphaWrapInput alpha_input(const WrapInput& input) {
  AlphaWrapInput soup;
  soup.points = input.mesh.points.raw();
  for (const TriangleVertices& t : input.mesh.triangles) soup.triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  return soup;
}

/// Returns the fraction of the wrap's area that is in front of the inside of the input.
double leaking_share(const WrapInput& input, const WrapSurface& wrap, double probe, const RunContext& context) {
  const TriangleTree tree(input.mesh, context);
  const TriMesh mesh = wrap_mesh(wrap.points, wrap.triangles);
  std::vector<double> area(mesh.n_triangles()), inside(mesh.n_triangles(), 0.0);
  parallel_for(
      context, area.size(),
      [&](std::size_t t) {
        const auto c = corners(mesh, TriangleId(std::uint64_t{t}));
        const Vec3 a = area_vector(c[0], c[1], c[2]);
        area[t] = norm(a);
        if (tree.winding_number((c[0] + c[1] + c[2]) / 3.0 + probe * normalized(a)) > k_inside_input) inside[t] = area[t];
      },
      128);
  CompensatedSum all, leaking;
  for (std::size_t t = 0; t < area.size(); ++t) {
    all.add(area[t]);
    leaking.add(inside[t]);
  }
  return all.value() > 0.0 ? leaking.value() / all.value() : 0.0;
}

double area_of(const WrapSurface& wrap) {
  CompensatedSum area;
  for (const auto& t : wrap.triangles) area.add(triangle_area(wrap.points[t[0]], wrap.points[t[1]], wrap.points[t[2]]));
  return area.value();
}

/// A wrap that is made to test if its gap closes the openings of the input.
struct GapTrial {
  double gap = 0.0, alpha = 0.0;  ///< m
  WrapSurface wrap;
  double leaking = 0.0;  ///< result of leaking_share; 0 if only one gap may be tried
};

/// Data shared by the steps of a wrap. begin_wrap() makes it. Every step may report, and
/// wrapped() sets the ball of `soup`; other members change only in steps whose comments say so.
struct WrapWork {
  const WrapOptions& options;
  const RunContext& context;
  WrapReport report;
  WrapInput input;
  WrapSizes sizes;
  AlphaWrapInput soup;       ///< the facets as read, and the location from which a tunnel is wrapped
  std::vector<double> gaps;  ///< m; the gaps that may be tried, ascending: only the requested one, or the automatic one and its doubles

  bool is_half() const { return !input.half_axis.empty(); }
  RunContext while_closing() const { return context.part("close", k_read_end, k_close_end); }
  RunContext while_wrapping() const { return context.part("wrap", k_close_end, k_wrap_end); }
};

/// Returns the leaking fraction above which a gap is considered to leak.
double leaking_limit(double least) { return least < k_leaking_share ? k_leaking_share : least + k_leaking_share; }

/// Returns the smallest gap that does not leak. If all gaps leak, returns the smallest gap that leaks about as little as the best one, because a wider gap is
/// of no use if openings are as wide as the surface itself.
std::size_t least_gap(const std::vector<GapTrial>& trials) {
  double least = trials.front().leaking;
  for (const GapTrial& trial : trials) least = std::min(least, trial.leaking);
  std::size_t chosen = 0;
  while (!(trials[chosen].leaking < leaking_limit(least))) ++chosen;
  return chosen;
}

/// Returns the diagonal (m) of the box of the widest opening, which is a set of connected borders.
double widest_opening(const WrapInput& input) {
  DisjointSets openings(input.mesh.n_vertices());
  for (const TriangleId t : input.mesh.triangles.ids())
    for (std::size_t k = 0; k < 3; ++k)
      if (input.is_border[t.index()][k]) openings.join(input.mesh.triangles[t][k].value(), input.mesh.triangles[t][(k + 1) % 3].value());
  std::vector<Box> boxes(input.mesh.n_vertices());
  for (const VertexId v : input.mesh.points.ids()) boxes[openings.root(v.value())].add(input.mesh.points[v]);
  double widest = 0.0;
  for (const Box& box : boxes)
    if (!box.empty()) widest = std::max(widest, norm(box.max - box.min));
  return widest;
}

void report_gap(const std::vector<GapTrial>& trials, std::size_t chosen, double length, WrapReport& report) {
  if (chosen > 0)
    report.messages.push_back("openings are wider than " + short_number(trials[chosen - 1].gap) + " m: the gap is " + short_number(trials[chosen].gap) + " m");
  if (trials[chosen].leaking < k_leaking_share) return;
  report.messages.push_back("openings are wider than " + short_number(trials.back().gap) + " m (" + short_number(trials.back().gap / length) +
                            " of the length), the widest gap that is tried: the surface behind these openings is wrapped on both sides, with a gap of " +
                            short_number(trials[chosen].gap) + " m");
}

/// Returns a location within the input. Of the locations on a grid it is the one farthest from the surface.
Vec3 find_seed(const WrapInput& input, double alpha, const RunContext& context) {
  const TriangleTree tree(input.mesh, context);
  const Box box = bounding_box(input.mesh);
  const Vec3 size = box.max - box.min;
  std::vector<double> depth(k_seed_cells * k_seed_cells * k_seed_cells, -1.0);
  const auto location = [&](std::size_t i) {
    const std::size_t x = i % k_seed_cells, y = i / k_seed_cells % k_seed_cells, z = i / (k_seed_cells * k_seed_cells);
    const auto share = [](std::size_t k) { return (static_cast<double>(k) + 0.5) / static_cast<double>(k_seed_cells); };
    return Vec3{box.min.x + share(x) * size.x, box.min.y + share(y) * size.y, box.min.z + share(z) * size.z};
  };
  parallel_for(
      context, depth.size(),
      [&](std::size_t i) {
        if (std::abs(tree.winding_number(location(i))) > 0.5) depth[i] = tree.nearest(location(i)).distance;
      },
      64);
  const auto deepest = std::max_element(depth.begin(), depth.end());
  if (*deepest < 2.0 * alpha)
    throw_bad_argument("wrapping", "fluid = \"inside\", but no cavity of the surface is wider than the gap", {}, "fluid = \"outside\", or a smaller gap");
  return location(static_cast<std::size_t>(deepest - depth.begin()));
}

double coarse_offset(const WrapSizes& sizes) { return std::min(k_coarse_offset * 0.5 * sizes.gap, sizes.edge); }

/// Closes the openings that are wider than the edge's ball. It uses facets of a wrap with a ball of half the gap: those off the input that the input nearly
/// encloses.
/// \return a human-readable description; empty: no change
std::string close_openings(const WrapInput& input, const WrapSizes& sizes, const WrapSurface& coarse, double least_winding, AlphaWrapInput& soup,
                           const RunContext& context) {
  const TriMesh mesh = wrap_mesh(coarse.points, coarse.triangles);
  const TriangleTree tree(input.mesh, context);
  std::vector<char> is_closing(mesh.n_triangles(), 0);
  const double alpha = 0.5 * sizes.gap, offset = coarse_offset(sizes);
  parallel_for(
      context, is_closing.size(),
      [&](std::size_t t) {
        const auto c = corners(mesh, TriangleId(std::uint64_t{t}));
        const Vec3 normal = normalized(area_vector(c[0], c[1], c[2]));
        // Samples are dense enough for the narrowest openings through which the finer ball passes.
        const double longest = std::max({distance(c[0], c[1]), distance(c[1], c[2]), distance(c[2], c[0])});
        const int n = std::clamp(static_cast<int>(std::ceil(longest / (k_sample_step * sizes.edge))), 2, k_most_samples);
        for (int i = 0; i <= n && !is_closing[t]; ++i)
          for (int j = 0; i + j <= n && !is_closing[t]; ++j) {
            const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
            const Vec3 p = c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]);
            if (!tree.nearest(p, 2.0 * offset).triangle.is_valid() && tree.winding_number(p - offset * normal) > least_winding) is_closing[t] = 1;
          }
      },
      128);
  const auto first = static_cast<std::uint32_t>(soup.points.size());
  std::int64_t n = 0;
  for (std::size_t t = 0; t < is_closing.size(); ++t) {
    if (!is_closing[t]) continue;
    auto triangle = coarse.triangles[t];
    for (std::uint32_t& v : triangle) v += first;
    soup.triangles.push_back(triangle);
    ++n;
  }
  if (n == 0) return {};
  soup.points.insert(soup.points.end(), coarse.points.begin(), coarse.points.end());
  return "openings between the edge and the gap closed by " + std::to_string(n) + " triangles of a wrap with a ball of " + short_number(alpha) + " m radius";
}

/// Returns the given half, with its open boundary in the plane. If the wrap touches itself or the plane along the cut, the cut is made slightly farther inside,
/// and the half is shifted back.
TriMesh cut_half(const TriMesh& mesh, const WrapInput& input, const WrapSizes& sizes, WrapReport& report, const RunContext& context) {
  const std::size_t axis = input.half_axis == "x" ? 0 : input.half_axis == "y" ? 1 : 2;
  std::optional<Error> first;
  for (const double shift : k_half_shifts)
    for (const double snap : {0.3, 0.0}) {
      context.check_stop();
      const double by = shift * sizes.tolerance * (input.is_half_above ? 1.0 : -1.0);
      try {
        TriMesh half = half_of(
            mesh,
            {.axis = input.half_axis, .at = input.half_at + by, .keep = input.is_half_above ? "+" : "-", .tolerance = 0.1 * sizes.tolerance, .snap = snap},
            context);
        if (shift > 0.0)
          for (Vec3& p : half.points) p[axis] = p[axis] == input.half_at + by ? input.half_at : p[axis] - by;
        prove_wrap(half, report, context);
        if (shift > 0.0)
          report.messages.push_back("cut " + short_number(std::abs(by)) + " m beside the plane and shifted back, because the wrap touches itself in the plane");
        return half;
      } catch (const Error& error) {
        if (error.code() == ErrorCode::cancelled) throw;
        if (!first) first = error;
      }
    }
  throw *first;
}

TriMesh finished_mesh(const FittedWrap& fitted, const TriMesh& input) {
  TriMesh mesh = wrap_mesh(fitted.points, fitted.triangles);
  std::vector<char> is_used(input.patches.size(), 0);
  for (const std::uint32_t p : fitted.patch) is_used[p] = 1;
  std::vector<PatchId> number(input.patches.size());
  for (const PatchId p : input.patches.ids())
    if (is_used[p.index()]) number[p.index()] = mesh.patches.push_back(input.patches[p]);
  for (const std::uint32_t p : fitted.patch) mesh.triangle_patch.push_back(number[p]);
  return mesh;
}

/// Copies the sizes to the report, except the gap, which later steps choose.
void report_sizes(double area, WrapWork& work) {
  work.report.edge = work.sizes.edge;
  work.report.tolerance = work.sizes.tolerance;
  work.report.offset = work.sizes.offset;
  work.report.expected_triangles = expected_triangles(area, work.sizes.edge);
}

/// Reads the input, mirrors a half model, chooses the sizes and reports them.
WrapWork begin_wrap(const std::vector<SurfaceSoup>& soups, const WrapOptions& options, const RunContext& context) {
  WrapWork work{.options = options, .context = context};
  work.input = read_wrap_input(soups, options, work.report, context);
  work.sizes = choose_sizes(work.input.area, work.input.length, options);
  check_sizes(work.input, work.sizes, options);
  work.sizes.is_fluid_inside = options.fluid == "inside";
  if (options.half == "automatic" && !work.sizes.is_fluid_inside) mirror_half(work.input, work.sizes.gap, work.report, context);
  if (work.is_half()) find_lines(work.input, options.features);
  report_sizes(work.input.area, work);
  work.report.gap = work.sizes.gap;
  work.report.n_feature_edges = static_cast<std::int64_t>(work.input.lines.size());
  context.info("wrap: edge " + short_number(work.sizes.edge) + " m, gap " + short_number(work.sizes.gap) + " m, tolerance " +
               short_number(work.sizes.tolerance) + " m; about " + std::to_string(work.report.expected_triangles) + " triangles expected");
  context.progress(k_read_end);
  work.soup = alpha_input(work.input);
  if (work.sizes.is_fluid_inside) work.soup.seeds = {find_seed(work.input, work.sizes.edge, context)};
  work.gaps = {work.sizes.gap};
  if (is_automatic(options.gap) && !work.sizes.is_fluid_inside)
    while (work.gaps.back() <= k_widest_gap * work.input.length) work.gaps.push_back(2.0 * work.gaps.back());
  return work;
}

/// Returns the wrap of a soup by a ball of radius `alpha`, with normals into the fluid.
WrapSurface wrapped(AlphaWrapInput& soup, double alpha, double offset, const WrapWork& work, const RunContext& context) {
  soup.alpha = alpha;
  soup.offset = offset;
  soup.max_points = 2 * static_cast<std::int64_t>(work.options.max_triangles);
  soup.expected_points = expected_triangles(work.input.area, alpha) / 2;
  WrapSurface wrap = alpha_wrap(soup, context);
  if (work.sizes.is_fluid_inside)
    for (auto& t : wrap.triangles) std::swap(t[1], t[2]);
  if (wrap.triangles.empty())
    throw Error({.code = ErrorCode::geometry_failed,
                 .attempted = "wrapping",
                 .problem = "alpha = " + short_number(alpha) + " m yields an empty wrap",
                 .hint = "a smaller edge or gap"});
  return wrap;
}

/// Orients the parts of the input by the trial's wrap.
void turn_by(const GapTrial& trial, WrapWork& work) {
  const double offset = trial.alpha > work.sizes.edge ? coarse_offset(work.sizes) : work.sizes.offset;
  turn_parts(work.input, wrap_mesh(trial.wrap.points, trial.wrap.triangles), 2.0 * offset + work.sizes.tolerance, work.context);
}

/// Wraps with a gap, and orients the parts of the input by that wrap. \p is_measured the leaking fraction is needed. Sets work.sizes.gap.
GapTrial try_gap(double gap, bool is_measured, WrapWork& work) {
  work.sizes.gap = gap;
  const bool is_coarse = !work.sizes.is_fluid_inside && gap > k_gap_of_edge * work.sizes.edge;
  GapTrial trial{.gap = gap, .alpha = is_coarse ? 0.5 * gap : work.sizes.edge};
  trial.wrap = wrapped(work.soup, trial.alpha, is_coarse ? coarse_offset(work.sizes) : work.sizes.offset, work,
                       is_coarse ? work.while_closing() : work.while_wrapping());
  turn_by(trial, work);
  if (is_measured) trial.leaking = leaking_share(work.input, trial.wrap, 0.25 * trial.alpha, work.context);
  return trial;
}

/// Returns the trials, ascending by their gaps. A wrap costs four times as much as the wrap for the next wider gap. If there are openings wider than the first
/// gap, gaps are therefore tried from the widest one down until one leaks. Otherwise they are tried from the first one upwards while they leak.
/// Sets work.sizes.gap, and orients the parts of the input by the last trial.
std::vector<GapTrial> make_trials(WrapWork& work) {
  const bool is_measured = work.gaps.size() > 1;
  std::vector<GapTrial> trials;
  if (is_measured && widest_opening(work.input) > work.gaps.front()) {
    double least = std::numeric_limits<double>::infinity();
    for (auto gap = work.gaps.rbegin(); gap != work.gaps.rend(); ++gap) {
      const double leaking = trials.emplace_back(try_gap(*gap, is_measured, work)).leaking;
      if (leaking >= leaking_limit(least)) break;
      least = std::min(least, leaking);
    }
    std::reverse(trials.begin(), trials.end());
  } else {
    for (const double gap : work.gaps)
      if (trials.emplace_back(try_gap(gap, is_measured, work)).leaking < k_leaking_share) break;
  }
  return trials;
}

/// Returns the trial of the smallest gap that closes the openings. Sets work.sizes.gap, and orients the parts of the input by this trial.
GapTrial choose_trial(std::vector<GapTrial> trials, WrapWork& work) {
  const std::size_t chosen = least_gap(trials);
  work.sizes.gap = trials[chosen].gap;
  if (trials.size() > 1) turn_by(trials[chosen], work);
  if (work.gaps.size() > 1) report_gap(trials, chosen, work.input.length, work.report);
  return std::move(trials[chosen]);
}

/// Chooses work.sizes again, by the area of the trial's wrap, if that wrap covers both sides of baffles.
void size_by_area(const GapTrial& trial, WrapWork& work) {
  const double area = area_of(trial.wrap);
  if (!is_automatic(work.options.edge) || area <= k_both_sides * work.input.area) return;
  const WrapSizes before = work.sizes;
  work.sizes = choose_sizes(area, work.input.length, work.options);
  work.sizes.gap = std::max(before.gap, k_gap_of_edge * work.sizes.edge);
  work.sizes.is_fluid_inside = before.is_fluid_inside;
  report_sizes(area, work);
  work.report.messages.push_back("the wrap, including both sides of sheets and closed openings, has " + short_number(area) + " m^2, the input " +
                                 short_number(work.input.area) + " m^2: the edge is set to " + short_number(work.sizes.edge) + " m");
}

/// Returns the wrap with the final ball after closing the openings through which only the trial's larger ball does not pass.
WrapSurface wrap_without_openings(const GapTrial& trial, WrapWork& work) {
  const WrapSizes& sizes = work.sizes;
  const double most = std::max(k_leaking_share, trial.leaking + k_leaking_share);
  const double glance = k_glance_ball * sizes.edge;
  const auto leaks = [&](const WrapSurface& wrap, double ball) { return !(leaking_share(work.input, wrap, 0.25 * ball, work.context) < most); };
  const auto finish = [&](WrapSurface wrap, std::string closed) {
    if (!closed.empty()) work.report.messages.push_back(std::move(closed));
    return wrap;
  };
  // First only the facets that the input nearly encloses are used, so that grooves keep their depth. Openings that remain and are wider than the preliminary
  // ball are detected with a sixteenth of the points of the final wrap.
  AlphaWrapInput soup = alpha_input(work.input);
  std::string closed = close_openings(work.input, sizes, trial.wrap, k_closing, soup, work.context);
  if (glance >= trial.alpha || !leaks(wrapped(soup, glance, k_coarse_offset * glance, work, work.while_closing()), glance)) {
    WrapSurface wrap = wrapped(soup, sizes.edge, sizes.offset, work, work.while_wrapping());
    if (!leaks(wrap, sizes.edge)) return finish(std::move(wrap), std::move(closed));
  }
  // The leaking fraction is larger than with a ball of half the gap, so all facets closed by that ball are used.
  soup = alpha_input(work.input);
  closed = close_openings(work.input, sizes, trial.wrap, -k_unbounded, soup, work.context);
  return finish(wrapped(soup, sizes.edge, sizes.offset, work, work.while_wrapping()), std::move(closed));
}

/// Returns the wrap with a ball of the edge's size. Completes the report of the sizes.
WrapSurface final_wrap(GapTrial trial, WrapWork& work) {
  work.report.gap = work.sizes.gap;
  if (trial.alpha > work.sizes.edge) return wrap_without_openings(trial, work);
  if (work.sizes.edge > trial.alpha) return wrapped(work.soup, work.sizes.edge, work.sizes.offset, work, work.while_wrapping());
  return std::move(trial.wrap);
}

/// Assigns the patches, cuts out the half, and checks the result.
TriMesh proved_mesh(const FittedWrap& fitted, WrapWork& work) {
  TriMesh mesh = finished_mesh(fitted, work.input.mesh);
  if (work.is_half()) mesh = cut_half(mesh, work.input, work.sizes, work.report, work.context);
  if (!is_automatic(work.options.split_angle)) split_patches(mesh, work.options.split_angle, work.context);
  if (!work.is_half()) prove_wrap(mesh, work.report, work.context.part("prove", k_measure_end, 1.0));
  return mesh;
}

void report_result(const TriMesh& mesh, WrapWork& work) {
  work.report.n_components = connected_components(mesh, Topology(mesh, work.context)).count;
  work.report.n_triangles = static_cast<std::int64_t>(mesh.n_triangles());
  work.report.n_vertices = static_cast<std::int64_t>(mesh.n_vertices());
  for (const std::string& message : work.report.messages) work.context.info("wrap: " + message);
  work.context.progress(1.0);
}

}  // namespace

WrapEstimate estimate_wrap(double area, double length, const WrapOptions& options) {
  const WrapSizes sizes = choose_sizes(area, length, options);
  double widest = sizes.gap;
  while (is_automatic(options.gap) && widest <= k_widest_gap * length) widest *= 2.0;
  return {.edge = sizes.edge, .widest_gap = widest, .n_triangles = expected_triangles(area, sizes.edge)};
}

WrapResult wrap_surface(const std::vector<SurfaceSoup>& soups, const WrapOptions& options, const RunContext& context) {
  WrapWork work = begin_wrap(soups, options, context);
  GapTrial trial = choose_trial(make_trials(work), work);
  size_by_area(trial, work);
  const WrapSurface wrap = final_wrap(std::move(trial), work);
  const InputSurface surface(work.input, context);
  const FittedWrap fitted = fit_wrap(wrap, surface, work.sizes, options.features, context.part("fit", k_wrap_end, k_fit_end));
  measure_wrap(fitted, surface, work.sizes, work.report, context.part("measure", k_fit_end, k_measure_end));
  TriMesh mesh = proved_mesh(fitted, work);
  report_result(mesh, work);
  return {std::move(mesh), std::move(work.report)};
}

}  // namespace sterna::surfmesh
