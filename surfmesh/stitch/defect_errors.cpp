#include "surfmesh/stitch/defect_errors.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>

#include "geom/base/disjoint_sets.h"
#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "surfmesh/stitch/weld.h"

namespace sterna::surfmesh {
namespace {

/// Remedy that users should try first (docs/dirty_surfaces.md).
const std::string k_repair_hint = "`sterna repair`, or --auto (auto = true of read_surface), repairs the surface; `sterna inspect` shows the steps";
/// Largest number of boundary edges for which the hint compares all pairs of edges. This takes 0.1 s at this number and grows with its square.
constexpr std::size_t k_max_matching = 5000;
/// Two boundary edges match if their ends are nearer to each other than this fraction of the shortest boundary edge. A tolerance that closes such a gap
/// collapses no boundary edge.
constexpr double k_near_match = 0.5;

std::string list_sources(const WorkingSurface& surface) {
  constexpr std::size_t k_shown = 3;
  std::string text;
  for (std::size_t i = 0; i < surface.sources.size() && i < k_shown; ++i) text += (i ? ", " : "") + surface.sources[i];
  if (surface.sources.size() > k_shown) text += " and " + std::to_string(surface.sources.size() - k_shown) + " more";
  return text.empty() ? "the surface" : text;
}

ErrorInfo start_error(ErrorCode code, const WorkingSurface& surface) {
  ErrorInfo info;
  info.code = code;
  info.attempted = "joining " + list_sources(surface) + " to one surface";
  return info;
}

/// Returns a name such as "facet 12", or with several files "facet 12 of wing.stl". Facets are counted from 1 as in STL viewers.
std::string facet_name(const WorkingSurface& surface, std::uint32_t facet) {
  const FacetOrigin& origin = surface.origin[facet];
  std::string name = "facet " + std::to_string(origin.facet + 1);
  if (surface.sources.size() > 1) name += " of " + std::filesystem::path(surface.sources[origin.soup]).filename().string();
  return name;
}

Vec3 center(const WorkingSurface& surface, std::uint32_t facet) {
  const auto c = surface.corners(facet);
  return surface.metres((c[0] + c[1] + c[2]) / 3.0);
}

Vec3 middle(const WorkingSurface& surface, const Edge& edge) { return surface.metres(0.5 * (surface.points[edge.low] + surface.points[edge.high])); }

std::uint32_t add_point(const WorkingSurface& surface, const Vec3& p, TroubleGeometry& geometry) {
  geometry.points.push_back(surface.metres(p));
  return static_cast<std::uint32_t>(geometry.points.size() - 1);
}

void add_edge(const WorkingSurface& surface, const Edge& edge, TroubleGeometry& geometry) {
  if (geometry.edges.size() >= k_max_geometry) return;
  const std::uint32_t a = add_point(surface, surface.points[edge.low], geometry), b = add_point(surface, surface.points[edge.high], geometry);
  geometry.edges.push_back({a, b});
}

void add_facet(const WorkingSurface& surface, std::uint32_t facet, TroubleGeometry& geometry) {
  if (geometry.triangles.size() >= k_max_geometry) return;
  std::array<std::uint32_t, 3> triangle{};
  for (std::size_t k = 0; k < 3; ++k) triangle[k] = add_point(surface, surface.points[surface.facets[facet][k]], geometry);
  geometry.triangles.push_back(triangle);
}

double length(const WorkingSurface& surface, const Edge& edge) { return surface.to_metres * distance(surface.points[edge.low], surface.points[edge.high]); }

/// Counts the connected chains of boundary edges, which are the holes. Two holes that touch count as one.
std::int64_t count_holes(const std::vector<Edge>& boundary, std::size_t n_points) {
  DisjointSets chains(n_points);
  std::int64_t n = 0;
  for (const Edge& edge : boundary) chains.join(edge.low, edge.high);
  std::vector<char> seen(n_points, 0);
  for (const Edge& edge : boundary) {
    const std::uint32_t root = chains.root(edge.low);
    n += !seen[root];
    seen[root] = 1;
  }
  return n;
}

/// Largest gap in metres over the boundary edges that have a partner nearby, and the number of such edges.
struct GapMatch {
  std::int64_t n_matched = 0;
  double largest_gap = 0.0;
};

GapMatch match_boundary(const WorkingSurface& surface, const std::vector<Edge>& boundary, double shortest, const RunContext& context) {
  if (boundary.size() > k_max_matching) return {};
  const double limit = k_near_match * shortest / surface.to_metres;
  std::vector<double> gap(boundary.size(), std::numeric_limits<double>::infinity());
  parallel_for(
      context, boundary.size(),
      [&](std::size_t i) {
        const Vec3 a = surface.points[boundary[i].low], b = surface.points[boundary[i].high];
        for (std::size_t j = 0; j < boundary.size(); ++j) {
          if (i == j) continue;
          const Vec3 c = surface.points[boundary[j].low], d = surface.points[boundary[j].high];
          const double apart = std::min(std::max(distance(a, c), distance(b, d)), std::max(distance(a, d), distance(b, c)));
          if (apart < limit) gap[i] = std::min(gap[i], apart);
        }
      },
      64);
  GapMatch match;
  for (const double g : gap) {
    if (!std::isfinite(g)) continue;
    ++match.n_matched;
    match.largest_gap = std::max(match.largest_gap, surface.to_metres * g);
  }
  return match;
}

std::string in_addition(const std::vector<std::string>& others) {
  if (others.empty()) return {};
  std::string text = "; in addition ";
  for (std::size_t i = 0; i < others.size(); ++i) text += (i == 0 ? "" : i + 1 == others.size() ? " and " : ", ") + others[i];
  return text;
}

/// Returns the counts of all defects except the reported one.
std::vector<std::string> other_defects(const Defects& defects, const Orientation& orientation, bool boundary, bool pinched, bool conflicts) {
  std::vector<std::string> others;
  if (boundary && !defects.boundary.empty()) others.push_back(count_of(static_cast<std::int64_t>(defects.boundary.size()), "boundary edge", "boundary edges"));
  if (pinched && !defects.pinched.empty())
    others.push_back(count_of(static_cast<std::int64_t>(defects.pinched.size()), "vertex with several fans of facets", "vertices with several fans of facets"));
  if (conflicts && !orientation.conflicts.empty())
    others.push_back(count_of(static_cast<std::int64_t>(orientation.conflicts.size()), "component without a consistent orientation",
                              "components without a consistent orientation"));
  return others;
}

void add_pinched(const WorkingSurface& surface, const Defects& defects, ErrorInfo& info) {
  std::vector<char> is_pinched(surface.points.size(), 0);
  for (const std::uint32_t v : defects.pinched) {
    is_pinched[v] = 1;
    if (info.locations.size() < k_max_locations) info.locations.push_back({surface.metres(surface.points[v]), "vertex where several fans of facets meet"});
    if (info.geometry.vertices.size() < k_max_geometry) info.geometry.vertices.push_back(add_point(surface, surface.points[v], info.geometry));
  }
  for (std::uint32_t t = 0; t < surface.n_facets(); ++t)
    if (is_pinched[surface.facets[t][0]] || is_pinched[surface.facets[t][1]] || is_pinched[surface.facets[t][2]]) add_facet(surface, t, info.geometry);
}

[[noreturn]] void throw_crowded(const WorkingSurface& surface, const EdgeTable& edges, const Defects& defects, const Orientation& orientation) {
  ErrorInfo info = start_error(ErrorCode::non_manifold_surface, surface);
  info.problem = count_of(static_cast<std::int64_t>(defects.crowded.size()), "edge has", "edges have") + " more than two facets";
  if (!defects.pinched.empty())
    info.problem += " and " + count_of(static_cast<std::int64_t>(defects.pinched.size()), "vertex joins", "vertices join") + " several fans of facets";
  info.problem += in_addition(other_defects(defects, orientation, true, false, true));
  info.n_locations = static_cast<std::int64_t>(defects.crowded.size() + defects.pinched.size());
  for (const Edge& edge : defects.crowded) {
    if (info.locations.size() < k_max_locations) {
      std::string what = "edge of " + std::to_string(edge.count) + " facets, among them";
      for (std::size_t i = 0; i < std::min<std::size_t>(edge.count, 3); ++i) what += (i ? ", " : " ") + facet_name(surface, edges.at(edge)[i] / 3);
      info.locations.push_back({middle(surface, edge), std::move(what)});
    }
    add_edge(surface, edge, info.geometry);
    for (const std::uint32_t h : edges.at(edge)) add_facet(surface, h / 3, info.geometry);
  }
  add_pinched(surface, defects, info);
  info.hint =
      k_repair_hint + ". Or remove internal walls and fins in the program that made the file, or join touching bodies with a boolean union in that program";
  throw Error(std::move(info));
}

[[noreturn]] void throw_open(const WorkingSurface& surface, const EdgeTable& edges, const Defects& defects, const Orientation& orientation,
                             const StitchOptions& options, const RunContext& context) {
  ErrorInfo info = start_error(ErrorCode::open_surface, surface);
  const auto n = static_cast<std::int64_t>(defects.boundary.size());
  info.problem = "the surface is open along " + count_of(n, "edge", "edges") + " around " +
                 count_of(count_holes(defects.boundary, surface.points.size()), "hole", "holes") +
                 in_addition(other_defects(defects, orientation, false, true, true));
  info.n_locations = n;
  for (const Edge& edge : defects.boundary) {
    if (info.locations.size() < k_max_locations)
      info.locations.push_back(
          {middle(surface, edge), "edge with one facet, " + short_number(length(surface, edge)) + " m long, " + facet_name(surface, edges.at(edge)[0] / 3)});
    add_edge(surface, edge, info.geometry);
  }
  const double shortest = std::accumulate(defects.boundary.begin(), defects.boundary.end(), std::numeric_limits<double>::infinity(),
                                          [&](double l, const Edge& edge) { return std::min(l, length(surface, edge)); });
  const GapMatch match = match_boundary(surface, defects.boundary, shortest, context);
  if (match.n_matched > 0 && match.largest_gap > weld_tolerance_in_use(surface, options)) {
    const bool is_all = match.n_matched == n;
    info.hint = "weld_tolerance = " + short_number(1.01 * match.largest_gap) + " (m): " + (is_all ? "all" : std::to_string(match.n_matched)) +
                " of these edges have a partner within " + short_number(match.largest_gap) + " m (shortest of them: " + short_number(shortest) + " m)" +
                (is_all ? "" : "; " + k_repair_hint + ", also for the other holes");
  } else {
    info.hint = k_repair_hint + ". Or fill the holes in the program that made the file, or add the file with the missing part";
  }
  throw Error(std::move(info));
}

[[noreturn]] void throw_pinched(const WorkingSurface& surface, const Defects& defects, const Orientation& orientation) {
  ErrorInfo info = start_error(ErrorCode::non_manifold_surface, surface);
  info.problem = count_of(static_cast<std::int64_t>(defects.pinched.size()), "vertex joins", "vertices join") + " several fans of facets" +
                 in_addition(other_defects(defects, orientation, false, false, true));
  info.n_locations = static_cast<std::int64_t>(defects.pinched.size());
  add_pinched(surface, defects, info);
  info.hint = k_repair_hint + ". Or move the parts of the surface that touch at a point apart";
  throw Error(std::move(info));
}

[[noreturn]] void throw_not_orientable(const WorkingSurface& surface, const EdgeTable& edges, const Orientation& orientation) {
  ErrorInfo info = start_error(ErrorCode::not_orientable, surface);
  const auto n = static_cast<std::int64_t>(orientation.conflicts.size());
  info.problem = count_of(n, "component is", "components are") + " one-sided like a Moebius strip: no orientation of the facets is consistent";
  info.n_locations = n;
  for (const Edge& edge : orientation.conflicts) {
    const std::uint32_t facet = edges.at(edge)[0] / 3;
    if (info.locations.size() < k_max_locations)
      info.locations.push_back({middle(surface, edge), "edge between opposite orientations, " + facet_name(surface, facet)});
    add_edge(surface, edge, info.geometry);
    for (const std::uint32_t h : edges.at(edge)) add_facet(surface, h / 3, info.geometry);
  }
  info.hint = k_repair_hint + ". Or look for facets that join the two sides of a thin part";
  throw Error(std::move(info));
}

}  // namespace

void throw_on_defects(const WorkingSurface& surface, const EdgeTable& edges, const Defects& defects, const Orientation& orientation,
                      const StitchOptions& options, const RunContext& context) {
  if (!defects.crowded.empty()) throw_crowded(surface, edges, defects, orientation);
  if (!defects.boundary.empty() && !options.allow_open) throw_open(surface, edges, defects, orientation, options, context);
  if (!defects.pinched.empty()) throw_pinched(surface, defects, orientation);
  if (!orientation.conflicts.empty()) throw_not_orientable(surface, edges, orientation);
}

void throw_self_intersection(const WorkingSurface& surface, const CrossingPairs& crossings, const std::vector<std::uint32_t>& flat) {
  ErrorInfo info = start_error(ErrorCode::self_intersection, surface);
  const Parts parts = connected_parts(surface.n_facets(), EdgeTable(surface.facets, surface.points.size()));
  std::int64_t n_between = 0;
  for (const auto& [a, b] : crossings.pairs) n_between += parts.part[a] != parts.part[b];
  std::vector<std::string> problems;
  if (crossings.total > 0) {
    std::string text = count_of(crossings.total, "pair", "pairs") + " of facets cross or touch";
    if (n_between > 0)
      text += n_between == crossings.total ? ", all between different bodies" : ", " + std::to_string(n_between) + " of them between different bodies";
    problems.push_back(std::move(text));
  }
  if (!flat.empty())
    problems.push_back(count_of(static_cast<std::int64_t>(flat.size()), "facet has", "facets have") +
                       " no area and cannot be removed without changing the surface");
  info.problem = problems.front() + (problems.size() > 1 ? "; " + problems.back() : "");
  info.n_locations = crossings.total + static_cast<std::int64_t>(flat.size());
  const auto area = [&](std::uint32_t t) {
    const auto c = surface.corners(t);
    return norm2(cross(c[1] - c[0], c[2] - c[0]));
  };
  std::vector<char> is_shown(surface.n_facets(), 0), is_location(surface.n_facets(), 0);
  for (const auto& [a, b] : crossings.pairs) {
    // The smaller facet indicates the location better. Each facet is listed once, so that one large facet does not fill the list.
    const std::uint32_t smaller = area(a) <= area(b) ? a : b;
    if (info.locations.size() < k_max_locations && !is_location[smaller] && !is_location[a]) {
      info.locations.push_back({center(surface, smaller), facet_name(surface, a) + " and " + facet_name(surface, b)});
      is_location[smaller] = is_location[a] = 1;
    }
    for (const std::uint32_t t : {a, b}) {
      if (!is_shown[t]) add_facet(surface, t, info.geometry);
      is_shown[t] = 1;
    }
  }
  for (const std::uint32_t t : flat) {
    if (info.locations.size() < k_max_locations) info.locations.push_back({center(surface, t), facet_name(surface, t) + " has no area"});
    if (!is_shown[t]) add_facet(surface, t, info.geometry);
  }
  info.hint = n_between > 0 ? "unite the bodies with `sterna union` (union{...} in a script), or move them apart; " + k_repair_hint
                            : k_repair_hint + ". Or repair these facets in the program that made the file";
  throw Error(std::move(info));
}

void throw_empty(const WorkingSurface& surface, const StitchReport& report) {
  ErrorInfo info = start_error(ErrorCode::empty_surface, surface);
  info.problem = report.n_triangles_read == 0
                     ? "the file holds no facet"
                     : "no facet is left: all " + std::to_string(report.n_triangles_read) + " are degenerate or parts of sheets without thickness";
  info.hint = "check that the file holds a surface";
  throw Error(std::move(info));
}

}  // namespace sterna::surfmesh
