// Each round has these steps: the reference; sizes; local operations on the given triangles until edges have their target length; the exact test for crossings.
// Where triangles cross, another round re-meshes those regions with flat and finer triangles. Later rounds keep the given triangles there.
#include "surfmesh/remesh/remesh_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "geom/base/machine_memory.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "surfmesh/remesh/line_rows.h"
#include "surfmesh/remesh/nose_lines.h"
#include "surfmesh/remesh/remesh_demand.h"
#include "surfmesh/remesh/remesh_report.h"
#include "surfmesh/remesh/remesh_sizes.h"
#include "surfmesh/remesh/remesher.h"
#include "surfmesh/remesh/row_sizes.h"

namespace sterna::surfmesh {
namespace {

constexpr std::string_view k_attempted = "remeshing a surface";

// Relative to the target length: shorter edges are collapsed, longer ones are halved (Botsch & Kobbelt: 4/5 and 4/3).
constexpr double k_short = 0.72, k_long = 1.38;
constexpr int k_passes = 5;
/// Strips between lines are searched after this pass.
constexpr int k_strip_pass = 1;
constexpr int k_last_smoothings = 6;
/// Triangles with a mean ratio below these values are improved at the end, one value after another. A mean ratio of 0.75 corresponds to a smallest angle of
/// about 30 degrees.
constexpr std::array<double, 7> k_improve = {0.5, 0.65, 0.7, 0.75, 0.75, 0.75, 0.75};
/// In that phase no move may bring a triangle that was better below this value.
constexpr double k_last_floor = 0.7;
/// Lower limit of sizes from narrow strips, relative to min_edge.
constexpr double k_least_in_strips = 0.2;
/// Number of rounds in which crossings are treated with flatter and finer triangles. In later rounds the given triangles are kept.
constexpr int k_fine_rounds = 4;
constexpr int k_most_rounds = 8;
/// Refinement must reduce the number of crossings to at most this fraction. Otherwise it does not help, because the surfaces are nearer to each other than any
/// edge length.
constexpr double k_fewer = 0.5;
constexpr double k_finer = 0.5;
/// Largest number of crossing pairs per triangle. With more pairs, further rounds would only add triangles.
constexpr std::int64_t k_most_crossings = 1;
/// Largest ratio of triangles made to triangles predicted.
constexpr double k_foretold_share = 1.5;
/// While edges are halved the ratio may temporarily be this large. Afterwards the limit above is tested.
constexpr double k_halving_share = 3.0;
/// Fraction of the free memory that may be used, and bytes per triangle that halving needs, including vertices and lists.
constexpr double k_memory_share = 0.5, k_bytes_of_triangle = 200.0;
constexpr std::string_view k_fewer_triangles_hint = "a larger max_edge, min_edge or curvature_angle; smooth = false if the input triangles are very thin";
constexpr double k_half_turn = std::numbers::pi;
constexpr int k_angle_digits = 3, k_length_digits = 3;

/// Problems found in the previous rounds.
struct Trouble {
  Column<TriangleId, std::uint8_t> flat, kept;
  std::vector<std::pair<TriangleId, double>> sizes;
};

void require_few(double n, double factor, const char* what, const RemeshOptions& options) {
  if (n <= factor * static_cast<double>(options.sizes.max_triangles)) return;
  throw Error({.code = ErrorCode::overflow,
               .attempted = std::string(k_attempted),
               .problem = what + std::to_string(static_cast<std::int64_t>(n)) + " triangles, max_triangles is " + std::to_string(options.sizes.max_triangles),
               .hint = std::string(k_fewer_triangles_hint)});
}

void split_long(Remesher& remesher, const RemeshOptions& options) {
  const double allowed = k_halving_share * static_cast<double>(std::max<std::int64_t>(options.sizes.max_triangles, remesher.n_triangles()));
  const double held = k_memory_share * available_memory() / k_bytes_of_triangle;
  const auto most = static_cast<std::int64_t>(std::min(allowed, std::max(held, static_cast<double>(remesher.n_triangles()) + 1.0)));
  remesher.split_long(k_long, most);
  const std::int64_t n = remesher.n_triangles();
  if (n < most) return;
  ErrorInfo info{.code = ErrorCode::overflow,
                 .attempted = std::string(k_attempted),
                 .problem = "halving long edges did not end at " + std::to_string(n) + " triangles, " +
                            (held < allowed ? "more triangles would exceed the free memory of this machine"
                                            : "max_triangles is " + std::to_string(options.sizes.max_triangles)),
                 .hint = std::string(k_fewer_triangles_hint)};
  if (const auto [location, length] = remesher.shortest_to_halve(k_long); length > 0.0)
    info.add_location(location, "edge of " + number_text(length, k_length_digits) + " m, longer than the requested length there");
  throw Error(std::move(info));
}

void narrow_strips(const Remesher& remesher, const RemeshOptions& options, RemeshSizes& sizes) {
  for (const Remesher::Strip& strip : remesher.strips()) {
    const double size = std::max(options.sizes.narrow / options.sizes.refinement * strip.width, k_least_in_strips * sizes.min_edge(strip.triangle));
    if (size < sizes(strip.point, strip.triangle)) sizes.lower(strip.triangle, strip.point, size);
  }
  sizes.carry();
}

/// Grows rows, and sets sizes that increase from the outer ends of the rows.
void grow_rows(Remesher& remesher, const Reference& reference, const RowLines& rows, const RemeshOptions& options, RemeshSizes& sizes,
               const RunContext& context) {
  if (rows.lines.empty()) return;
  remesher.grow_rows(rows.lines);
  if (const std::vector<RowReach> reaches = remesher.nose_reaches(); !reaches.empty()) {
    // Where rows did not reach as far as predicted, the curvature determines sizes again.
    sizes.cover(covered_by_noses(reference, reaches, context), context);
    sizes.request_at(remesher.row_ends(), context);
    narrow_strips(remesher, options, sizes);
  } else {
    sizes.request_at(remesher.row_ends(), context);
  }
  remesher.refresh_sizes();
  remesher.collapse_short(k_short, false);
  remesher.flip_edges();
  split_long(remesher, options);
  remesher.regularise();
  remesher.smooth(2);
}

void run_passes(Remesher& remesher, const Reference& reference, const RemeshOptions& options, const RowLines& rows, RemeshSizes& sizes,
                const RunContext& context) {
  for (int pass = 0; pass < k_passes; ++pass) {
    // The first pass removes most edges. It is repeated, because the neighbours of a collapsed edge cannot be collapsed in the same pass.
    for (int again = 0; remesher.collapse_short(k_short, true) > 0 && again < (pass == 0 ? 8 : 1); ++again) {
    }
    remesher.flip_edges();
    split_long(remesher, options);
    if (pass == 0 || pass == 2) remesher.renumber();
    if (remesher.regularise() > 0) remesher.regularise();
    remesher.smooth(2);
    if (pass == k_strip_pass) {
      narrow_strips(remesher, options, sizes);
      require_few(sizes.n_expected(), 1.0, "the sizes in narrow regions require ", options);
      remesher.refresh_sizes();
    }
    require_few(static_cast<double>(remesher.n_triangles()), k_foretold_share, "lines and narrow regions led to ", options);
    context.progress(0.8 * (pass + 1) / k_passes);
  }
  grow_rows(remesher, reference, rows, options, sizes, context);
  for (int i = 0; i < k_last_smoothings; ++i) {
    if (i % 2 == 0) remesher.regularise();
    remesher.smooth(1);
  }
  remesher.flip_edges();
  remesher.smooth(1);
  for (const double quality : k_improve) {
    if (remesher.improve(quality) == 0) break;
    remesher.flip_edges();
    remesher.smooth(1, k_last_floor);
  }
}

void require_clear(const TriMesh& wall, const RunContext& context) {
  if (wall.n_triangles() == 0)
    throw Error({.code = ErrorCode::empty_surface, .attempted = std::string(k_attempted), .problem = "the surface has no triangles"});
  const CrossingPairs pairs = find_crossings(wall, context);
  if (pairs.total == 0) return;
  ErrorInfo info{.code = ErrorCode::self_intersection,
                 .attempted = std::string(k_attempted),
                 .problem = std::to_string(pairs.total) + " pairs of triangles of the input surface cross or touch",
                 .hint = "remesh requires a surface without self-intersections: repair{} removes crossings"};
  for (const auto& [i, j] : pairs.pairs) {
    const auto [a, b, c] = corners(wall, TriangleId(i));
    info.add_location((a + b + c) / 3.0, "triangle " + std::to_string(i) + " with " + std::to_string(j));
    if (info.geometry.triangles.size() + 2 > k_max_geometry) continue;
    for (const std::uint32_t t : {i, j}) {
      const auto n = static_cast<std::uint32_t>(info.geometry.points.size());
      for (const Point& p : corners(wall, TriangleId(t))) info.geometry.points.push_back(p);
      info.geometry.triangles.push_back({n, n + 1, n + 2});
    }
  }
  throw Error(std::move(info));
}

std::string percent_text(double share) { return number_text(100.0 * share, k_angle_digits) + " %"; }

void require_improvement(const SliverCount& slivers, double n_triangles, const char* what, const RemeshDemand& demand) {
  const double share = static_cast<double>(slivers.n) / std::max(1.0, n_triangles);
  if (share <= demand.most_slivers && slivers.least_angle >= demand.least_angle) return;
  ErrorInfo info{.code = ErrorCode::geometry_failed,
                 .attempted = std::string(k_attempted),
                 .problem = std::string(what) + " " + std::to_string(slivers.n) + " sliver triangles, " + percent_text(share) +
                            " of the triangles, smallest angle " + number_text(slivers.least_angle / k_degree, k_angle_digits) +
                            " degrees; the limits are at most " + percent_text(demand.most_slivers) + " and at least " +
                            number_text(demand.least_angle / k_degree, k_angle_digits) + " degrees",
                 .hint = "remesh without this limit, or use wrap{}"};
  info.add_location(slivers.location, "the thinnest triangle");
  throw Error(std::move(info));
}

/// Counts sliver triangles on edges between two corners of lines. Such edges stay, and the triangles on them are as long as the surrounding sizes.
SliverCount forced_slivers(const Reference& reference, const RemeshSizes& sizes) {
  const TriMesh& mesh = *reference.mesh;
  SliverCount forced{.n = 0, .least_angle = k_half_turn};
  for (const TriangleId t : mesh.triangles.ids()) {
    for (int k = 0; k < 3; ++k) {
      const HalfedgeId h = halfedge(t, k);
      const VertexId a = reference.topology.from(h), b = reference.topology.to(h);
      if (reference.line[h] == k_no_line || reference.is_corner[a] == 0 || reference.is_corner[b] == 0) continue;
      const Point &p = mesh.points[a], &q = mesh.points[b];
      const double angle = std::atan2(distance(p, q), k_short * sizes(0.5 * (p + q), t));
      if (angle < k_sliver_angle) ++forced.n;
      if (angle >= forced.least_angle) continue;
      forced.least_angle = angle;
      forced.location = 0.5 * (p + q);
    }
  }
  return forced;
}

/// Returns the fraction of the area of given triangles that are turned away from their own smooth surface, because of bends at edges.
double turned_share(const Reference& r, double angle) {
  const double cosine = std::cos(angle);
  double turned = 0.0, all = 0.0;
  for (const TriangleId t : r.mesh->triangles.ids()) {
    const auto [a, b, c] = corners(*r.mesh, t);
    const double area = triangle_area(a, b, c);
    all += area;
    for (int k = 0; k < 3; ++k) {
      if (dot(r.triangle_normals[t], r.normals[halfedge(t, k)]) >= cosine) continue;
      turned += area;
      break;
    }
  }
  return all > 0.0 ? turned / all : 0.0;
}

}  // namespace

void require_likeness(const RemeshReport& report, const RemeshDemand& demand) {
  const SurfaceDistance& further = report.to_input.max >= report.from_input.max ? report.to_input : report.from_input;
  const double of_edge = std::max(report.to_input.of_edge, report.from_input.of_edge);
  std::string problem;
  if (further.max > demand.largest_distance * report.length)
    problem = "the new triangles are up to " + number_text(further.max, k_angle_digits) + " m from the input triangles, the limit is " +
              number_text(demand.largest_distance * report.length, k_angle_digits) + " m, " + number_text(demand.largest_distance, k_angle_digits) +
              " of the length";
  else if (of_edge > demand.largest_distance_of_edge)
    problem = "the new triangles are up to " + number_text(of_edge, k_angle_digits) + " of their edges from the input triangles, the limit is " +
              number_text(demand.largest_distance_of_edge, k_angle_digits);
  else if (report.turned > report.turned_before + demand.more_turned)
    problem = percent_text(report.turned) + " of the area is turned by more than " + number_text(k_turned_angle / k_degree, k_angle_digits) +
              " degrees from the smooth surface, " + percent_text(report.turned_before) + " of the input triangles";
  else return;
  ErrorInfo info{.code = ErrorCode::geometry_failed,
                 .attempted = std::string(k_attempted),
                 .problem = std::move(problem),
                 .hint = "remesh with a smaller max_edge, min_edge or curvature_angle, or use wrap{}"};
  info.add_location(further.location, "the largest distance");
  throw Error(std::move(info));
}

RemeshResult remesh_surface(const TriMesh& wall, const RemeshOptions& options, std::span<const Rule> patches, const SpaceSizes& requested,
                            const RunContext& context) {
  return remesh_surface(wall, options, patches, requested, RemeshDemand{}, context);
}

RemeshResult remesh_surface(const TriMesh& given, const RemeshOptions& options, std::span<const Rule> patches, const SpaceSizes& requested,
                            const RemeshDemand& demand, const RunContext& context) {
  const StageTimer timer(context, "remesh");
  require_clear(given, context);
  ReferenceOptions reference_options{options.feature_angle, least_edge(given, options, patches, context), options.smooth, {}};
  const std::optional<NoseCut> cut = cut_noses_if_requested(given, reference_options, options, patches, context);
  const TriMesh& wall = cut ? cut->mesh : given;
  if (cut) reference_options.noses = cut->edges;
  Trouble trouble;
  RemeshResult result;
  RemeshReport& report = result.report;
  bool is_fine = true;
  std::int64_t n_crossing = std::numeric_limits<std::int64_t>::max();
  for (int round = 1;; ++round) {
    const Reference reference(wall, reference_options, trouble.kept, trouble.flat, context);
    const RowLines rows = find_row_lines(reference, SurfaceLimitTable(wall, reference.topology, options, patches), options, patches);
    RemeshSizes sizes(reference, options, patches, requested, context);
    if (const std::vector<RowReach> reaches = foreseen_reaches(reference, rows); !reaches.empty())
      sizes.cover(covered_by_noses(reference, reaches, context), context);
    sizes.request_at(size_points_of_rows(reference, rows), context);
    for (const auto& [t, size] : trouble.sizes) {
      const auto [a, b, c] = corners(wall, t);
      sizes.lower(t, (a + b + c) / 3.0, size);
    }
    if (!trouble.sizes.empty()) sizes.carry();
    const double n_expected = sizes.n_expected();
    if (round == 1) require_improvement(forced_slivers(reference, sizes), n_expected, "corners of lines, which are kept, force", demand);
    require_few(n_expected, 1.0, "the sizes require about ", options);
    Remesher remesher(reference, sizes, context);
    run_passes(remesher, reference, options, rows, sizes, context.part("round", 0.0, 0.8));
    result.mesh = remesher.result();
    report.n_rounds = round;
    report.least_size = sizes.least();
    report.max_edge = sizes.largest();
    report.n_lines = static_cast<std::int64_t>(reference.lines.size());
    report.n_corners = std::count(reference.is_corner.begin(), reference.is_corner.end(), 1);
    require_improvement(count_slivers(result.mesh), static_cast<double>(result.mesh.n_triangles()), "the new triangles have", demand);
    const CrossingPairs pairs = find_crossings(result.mesh, context);
    if (pairs.total == 0) {
      report.slivers = remesher.slivers(k_sliver_angle);
      report.turned_before = turned_share(reference, k_turned_angle);
      report.turned = remesher.turned_share(k_turned_angle);
      report.rows = remesher.row_report();
      report.rows.notes = rows.notes;
      break;
    }
    if (round == k_most_rounds)
      throw Error({.code = ErrorCode::internal,
                   .attempted = std::string(k_attempted),
                   .problem = std::to_string(pairs.total) + " pairs of triangles cross after " + std::to_string(round) + " rounds"});
    if (pairs.total > k_most_crossings * static_cast<std::int64_t>(result.mesh.n_triangles())) {
      ErrorInfo info{.code = ErrorCode::self_intersection,
                     .attempted = std::string(k_attempted),
                     .problem = std::to_string(pairs.total) + " pairs of " + std::to_string(result.mesh.n_triangles()) +
                                " new triangles cross: sheets of the input surface are much closer to each other than its edge length",
                     .hint = "smooth = false, a smaller max_edge, or wrap{} instead"};
      for (const auto& [i, j] : pairs.pairs) info.add_location(corners(result.mesh, TriangleId(i))[0], "crosses triangle " + std::to_string(j));
      throw Error(std::move(info));
    }
    if (trouble.flat.empty()) {
      trouble.flat.assign(wall.n_triangles(), 0);
      trouble.kept.assign(wall.n_triangles(), 0);
    }
    // Kept triangles can force other triangles to cross. If all given triangles are kept, there is no self-intersection.
    if (round + 1 == k_most_rounds) trouble.kept.assign(wall.n_triangles(), 1);
    if (is_fine && (round > k_fine_rounds || static_cast<double>(pairs.total) > k_fewer * static_cast<double>(n_crossing))) {
      is_fine = false;
      trouble.sizes.clear();
    }
    n_crossing = pairs.total;
    const auto found = remesher.reference_triangles_of(pairs.pairs, round);
    for (const TriangleId t : found) {
      if (is_fine) {
        trouble.flat[t] = 1;
        const auto [a, b, c] = corners(wall, t);
        trouble.sizes.emplace_back(t, k_finer * sizes((a + b + c) / 3.0, t));
      } else {
        trouble.kept[t] = 1;
      }
    }
    context.info("remesh: " + std::to_string(pairs.total) + " pairs of triangles cross, the first at " +
                 format_point(corners(result.mesh, TriangleId(pairs.pairs.front()[0]))[0]) + "; these regions are remeshed again, " +
                 (is_fine ? "finer" : "with the input triangles"));
  }
  report.n_triangles_before = static_cast<std::int64_t>(given.n_triangles());
  report.n_kept = std::count(trouble.kept.begin(), trouble.kept.end(), 1);
  report.n_slivers = static_cast<std::int64_t>(report.slivers.size());
  if (report.slivers.size() > k_max_locations) report.slivers.resize(k_max_locations);
  measure_angles(result.mesh, report);
  report.to_input = surface_distance(result.mesh, given, true, context);
  report.from_input = surface_distance(given, result.mesh, false, context);
  require_likeness(report, demand);
  context.progress(1.0);
  return result;
}

}  // namespace sterna::surfmesh
