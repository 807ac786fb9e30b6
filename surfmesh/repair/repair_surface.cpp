// This is the driver. The steps pass on a soup with shared vertices (RepairState); stitch_surface verifies the result.
#include "surfmesh/repair/repair_surface.h"

#include <algorithm>
#include <set>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "geom/mesh/topology.h"
#include "surfmesh/repair/repair_state.h"
#include "surfmesh/stitch/clean_facets.h"
#include "surfmesh/stitch/orient.h"
#include "surfmesh/stitch/patches.h"
#include "surfmesh/stitch/weld.h"

namespace sterna::surfmesh {
namespace {

constexpr int k_hull_tries = 3;
constexpr std::int64_t k_most_again = 200;  ///< a second attempt is made if there are at most this many crossings

/// Returns true for errors that the repair handles. Other errors are returned to the caller.
bool is_reparable(ErrorCode code) {
  return code == ErrorCode::open_surface || code == ErrorCode::non_manifold_surface || code == ErrorCode::self_intersection ||
         code == ErrorCode::not_orientable;
}

struct Input {
  std::vector<Vec3> points;  ///< m
  std::vector<Facet> facets;
};

/// Records the facets of `before` that are missing in `after`.
void note_dropped(RepairState& state, const WorkingSurface& before, const WorkingSurface& after) {
  std::set<std::array<std::uint32_t, 2>> left;
  for (const FacetOrigin& origin : after.origin) left.insert({origin.soup, origin.facet});
  RepairState drawn;
  drawn.points = state.points;
  for (std::size_t t = 0; t < before.n_facets(); ++t)
    if (!left.count({before.origin[t].soup, before.origin[t].facet})) state.add(before.facets[t], {before.patch[t], FacetMark::given, true});
  const std::vector<char> all(state.facets.size(), 1);
  state.note_parts(RepairKind::dropped, all, state.edges());
  state.facets.clear();
  state.info.clear();
}

RepairState first_state(const std::vector<SurfaceSoup>& soups, const StitchOptions& stitching, Input& input, const RunContext& context) {
  RepairState state;
  StitchReport& report = state.report.stitch;
  WorkingSurface surface = weld_exact(soups, stitching, report);
  for (Vec3& p : surface.points) p = surface.metres(p);
  surface.to_metres = 1.0;
  state.points = surface.points;
  state.length = surface.box().longest_side();
  state.report.length = state.length;
  drop_degenerate_facets(surface, report);
  input = {surface.points, surface.facets};
  const WorkingSurface before = surface;
  drop_doubled_facets(surface, report);
  note_dropped(state, before, surface);
  StitchOptions in_metres = stitching;
  in_metres.unit = 1.0;
  if (!is_automatic(stitching.weld_tolerance)) in_metres.weld_tolerance = stitching.weld_tolerance;
  weld_near(surface, in_metres, report, context);
  {
    const EdgeTable edges(surface.facets, surface.points.size());
    const Defects defects = find_defects(surface.facets, surface.points.size(), edges);
    WorkingSurface turned = surface;
    const Orientation orientation = flood_orientation(surface, edges);
    for (std::size_t t = 0; t < turned.n_facets(); ++t)
      if (orientation.is_flipped[t]) std::swap(turned.facets[t][1], turned.facets[t][2]);
    if (defects.crowded.empty() && orientation.conflicts.empty()) {
      flip_flat_facets(turned, report);
      surface = std::move(turned);
    }
  }
  std::vector<FacetInfo> info;
  for (const std::uint32_t patch : surface.patch) info.push_back({patch, FacetMark::given, report.n_welded_near > 0});
  state.points = std::move(surface.points);
  state.facets = std::move(surface.facets);
  state.info = std::move(info);
  // Facets without area fill T-junctions at most. T-junctions are found separately.
  std::vector<char> is_flat(state.facets.size(), 0), is_kept(state.facets.size(), 1);
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    const auto c = state.corners(t);
    is_flat[t] = is_collinear(c[0], c[1], c[2]);
    is_kept[t] = !is_flat[t];
  }
  state.note_parts(RepairKind::dropped, is_flat, state.edges());
  state.keep(is_kept);
  return state;
}

std::size_t count_open_edges(const RepairState& state) {
  const EdgeTable edges = state.edges();
  return static_cast<std::size_t>(std::count_if(edges.edges().begin(), edges.edges().end(), [](const Edge& edge) { return edge.count == 1; }));
}

bool needs_hull(const RepairState& state, const RunContext& context) {
  const EdgeTable edges = state.edges();
  for (const Edge& edge : edges.edges())
    if (edge.count > 2) return true;
  return find_crossings(state.points, state.facets, context, 1).total > 0;
}

/// Cuts crossing facets. If that opens edges or leaves crossings, the crossing planes are equal except for rounding. In that case the vertices are rounded to a
/// grid, and the facets are cut again.
void cut_or_snap(RepairState& state, const RepairOptions& options, const RunContext& context) {
  const auto trouble = [&](const RepairState& of) {
    return static_cast<std::int64_t>(count_open_edges(of)) + find_crossings(of.points, of.facets, context).total;
  };
  RepairState snapped = state;
  cut_crossings(state, options, context.part("cut", 0.0, 0.4));
  const std::int64_t before = trouble(state);
  if (before == 0) return;
  snap_crossings(snapped, context);
  cut_crossings(snapped, options, context.part("cut", 0.4, 0.8));
  if (trouble(snapped) < before) state = std::move(snapped);
}

/// Cuts crossing facets, takes the outer hull and repairs the resulting defects. \return true if there is a hull
bool cut_to_hull(RepairState& state, const RepairOptions& options, const Contacts& contacts, const RunContext& context) {
  const SolidReference first = solid_reference(state, contacts.is_fluid_inside, context);
  for (int round = 0; round < k_hull_tries && needs_hull(state, context); ++round) {
    // If replacement could not repair many crossings, cutting would only produce ever smaller pieces.
    if (round > 0 && find_crossings(state.points, state.facets, context).total > k_most_again) break;
    const SolidReference reference = round == 0 ? first : solid_reference(state, contacts.is_fluid_inside, context);
    cut_or_snap(state, options, context);
    if (count_open_edges(state) > 0) remove_sheets(state, context);
    if (!keep_outer_hull(state, reference, context)) return false;
    drop_small_parts(state, options);
    separate_touching(state, contacts, context);
    collapse_slivers(state, options, context);
    if (replace_crossings(state, options, contacts, context)) break;
  }
  drop_flat_parts(state);
  return true;
}

void check_options(RepairOptions options) {
  for (const Option& option : options_of(options)) set_option(option, option.get());  // set_option throws for values out of range
}

StitchOptions strictly(StitchOptions stitching) {
  stitching.allow_open = false;
  stitching.check_intersections = true;
  return stitching;
}

/// Returns true if crossing facets are cut and a hull is taken.
bool is_cutting(const RepairOptions& options) { return options.hull; }

/// Runs all steps before facets are cut. \return openings that remain
std::size_t close_up(RepairState& state, const RepairOptions& options, const RunContext& context) {
  drop_small_parts(state, options);
  zip_seams(state, options, context.part("zip", 0.0, 0.5));
  remove_sheets(state, context);
  cap_half(state, options);
  const std::size_t n_open = fill_holes(state, options, RepairKind::filled, context.part("fill", 0.5, 1.0));
  weld_rounded(state);
  return n_open;
}

SurfaceSoup soup_of(const RepairState& state, const std::vector<SurfaceSoup>& soups) {
  SurfaceSoup soup;
  soup.points = state.points;
  for (std::uint32_t t = 0; t < state.facets.size(); ++t) {
    if (state.info[t].mark == FacetMark::cap) continue;
    soup.triangles.push_back(state.facets[t]);
    soup.patch.push_back(state.info[t].patch);
  }
  soup.patch_names = clean_patch_names(soups);
  soup.has_names = true;
  for (const SurfaceSoup& of : soups) soup.source += (soup.source.empty() ? "" : ", ") + of.source;
  return soup;
}

std::string sources_of(const std::vector<SurfaceSoup>& soups) {
  std::string text;
  for (const SurfaceSoup& soup : soups) text += (text.empty() ? "" : ", ") + soup.source;
  return text;
}

/// Returns one sentence for each kind of change, with the number of locations, the largest and the first of them.
std::vector<std::string> messages_of(const RepairReport& report) {
  static constexpr std::array<const char*, k_repair_kinds> k_words = {"dropped (no area, copies)",
                                                                      "welded within rounding",
                                                                      "seams zipped",
                                                                      "open boundary of the half model moved into its plane",
                                                                      "holes filled",
                                                                      "cut where facets cross",
                                                                      "sheets without thickness removed",
                                                                      "facets inside the body removed",
                                                                      "small parts removed",
                                                                      "touching vertices separated",
                                                                      "touching parts joined",
                                                                      "short edges collapsed",
                                                                      "crossing facets replaced by a filling",
                                                                      "orientation changed to that of the neighbours"};
  std::vector<std::string> messages;
  for (std::size_t k = 0; k < k_repair_kinds; ++k) {
    std::int64_t n = 0, n_facets = 0;
    const RepairChange* largest = nullptr;
    for (const RepairChange& change : report.changes) {
      if (static_cast<std::size_t>(change.kind) != k) continue;
      ++n;
      n_facets += change.n_facets;
      if (!largest || change.size > largest->size) largest = &change;
    }
    if (n == 0) continue;
    messages.push_back(std::string(k_words[k]) + ": " + count_of(n, "place", "places") + " (" + count_of(n_facets, "facet", "facets") + "), the largest " +
                       short_number(largest->size) + " m at " + format_point(largest->position));
  }
  if (report.half)
    messages.push_back("half model: open at " + report.half->axis + " = " + short_number(report.half->at) + " m, the body extends to " +
                       (report.half->is_above ? "larger " : "smaller ") + report.half->axis);
  return messages;
}

/// \throws Error(open_surface) if a half model is open elsewhere as well
void require_border_in_plane(const TriMesh& mesh, const HalfOpening& half, const RunContext& context) {
  const Topology topology(mesh, context);
  const auto axis = static_cast<std::size_t>(half.axis[0] - 'x');
  ErrorInfo info{.code = ErrorCode::open_surface};
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(static_cast<std::uint64_t>(i));
    if (!topology.is_boundary(h)) continue;
    const Vec3 &a = mesh.points[topology.from(h)], &b = mesh.points[topology.to(h)];
    if (a[axis] == half.at && b[axis] == half.at) continue;
    info.add_location(0.5 * (a + b), "edge with one facet");
    info.geometry.points.insert(info.geometry.points.end(), {a, b});
    const auto last = static_cast<std::uint32_t>(info.geometry.points.size());
    info.geometry.edges.push_back({last - 2, last - 1});
  }
  if (info.n_locations == 0) return;
  info.problem = "the half model is open along " + count_of(info.n_locations, "edge", "edges") + " outside of its plane " + half.axis + " = " +
                 short_number(half.at) + " m";
  throw Error(std::move(info));
}

}  // namespace

std::string_view to_string(RepairKind kind) {
  static constexpr std::array<std::string_view, k_repair_kinds> k_names = {"dropped", "welded",        "zipped",         "into_plane",   "filled",
                                                                           "cut",     "removed_sheet", "removed_inside", "removed_part", "separated",
                                                                           "joined",  "collapsed",     "replaced",       "turned"};
  return k_names[static_cast<std::size_t>(kind)];
}

std::int64_t RepairReport::count(RepairKind kind) const {
  return std::count_if(changes.begin(), changes.end(), [kind](const RepairChange& change) { return change.kind == kind; });
}

RepairResult repair_surface(const std::vector<SurfaceSoup>& soups, const StitchOptions& stitching, const RepairOptions& options, const RunContext& context) {
  check_options(options);
  try {
    StitchResult clean = stitch_surface(soups, strictly(stitching), context.part("stitch", 0.0, 0.1));
    RepairResult result{std::move(clean.mesh), {}};
    result.report.length = body_length(result.mesh);
    result.report.stitch = std::move(clean.report);
    return result;
  } catch (const Error& error) {
    if (!is_reparable(error.code())) throw;
    context.info("repair: " + error.info().problem);
  }

  Input input;
  RepairState state = first_state(soups, stitching, input, context);
  if (state.facets.empty()) throw_bad_argument("repairing " + sources_of(soups), "no facet has an area");
  const std::size_t n_open = close_up(state, options, context.part("close", 0.1, 0.4));
  bool is_leaking = false;
  if (n_open == 0 && is_cutting(options) && needs_hull(state, context)) {
    is_leaking = !cut_to_hull(state, options, {stitching.fluid == "inside", clean_patch_names(soups)}, context.part("hull", 0.4, 0.9));
  }
  make_consistent(state);
  if (!is_leaking && count_open_edges(state) == 0) collapse_slivers(state, options, context);

  RepairResult result;
  try {
    StitchOptions proving;
    proving.weld_tolerance = 0.0;
    proving.split_angle = stitching.split_angle;
    proving.fluid = stitching.fluid;
    proving.allow_open = state.report.half.has_value();
    StitchResult proved = stitch_surface({soup_of(state, soups)}, proving, context.part("prove", 0.9, 0.95));
    if (state.report.half) require_border_in_plane(proved.mesh, *state.report.half, context);
    result.mesh = std::move(proved.mesh);
    proved.report.warnings.insert(proved.report.warnings.begin(), state.report.stitch.warnings.begin(), state.report.stitch.warnings.end());
    state.report.stitch = std::move(proved.report);
  } catch (const Error& error) {
    if (!is_reparable(error.code()) && error.code() != ErrorCode::empty_surface) throw;
    ErrorInfo info = error.info();
    info.attempted = "repairing " + sources_of(soups);
    info.problem = "after repair, " + info.problem +
                   (is_leaking ? "; the surface is not watertight (the exterior connects to the interior), so no outer hull exists" : "");
    std::string done;
    for (const std::string& message : messages_of(state.report)) done += (done.empty() ? "changes made before: " : "; ") + message;
    info.hint = "use wrap, which makes a closed surface around any approximate body, or raise the limits of repair (gap, hole, flat_hole, hole_edges). " + done;
    throw Error(std::move(info));
  }
  {
    std::vector<char> is_kept(state.facets.size());
    for (std::size_t t = 0; t < is_kept.size(); ++t) is_kept[t] = state.info[t].mark != FacetMark::cap;
    state.keep(is_kept);
  }
  measure_changes(state, input.points, input.facets, context);
  state.report.messages = messages_of(state.report);
  clean_patch_names(soups, &state.report.messages);
  state.report.messages.push_back("retained facets moved by at most " + short_number(state.report.moved) + " m, the new surface is at most " +
                                  short_number(state.report.from_result) + " m from the input surface, and the input surface at most " +
                                  short_number(state.report.from_input) + " m from the new surface (removed parts)");
  for (const std::string& message : state.report.messages) context.info("repair: " + message);
  if (state.report.moved > options.largest_move * state.length) {
    ErrorInfo info;
    info.code = ErrorCode::mesh_invalid;
    info.attempted = "repairing " + sources_of(soups);
    info.problem = "the retained surface would move by " + short_number(state.report.moved) + " m, more than " +
                   short_number(options.largest_move * state.length) + " m (largest_move = " + short_number(options.largest_move) + " body lengths)";
    info.hint = "lower gap, or raise largest_move";
    throw Error(std::move(info));
  }
  result.report = std::move(state.report);
  context.progress(1.0);
  return result;
}

RepairForecast foresee_repair(const std::vector<SurfaceSoup>& soups, const StitchOptions& stitching, const RepairOptions& options, const RunContext& context) {
  check_options(options);
  RepairForecast forecast;
  try {
    stitch_surface(soups, strictly(stitching), context.part("stitch", 0.0, 0.3));
    return forecast;
  } catch (const Error& error) {
    if (!is_reparable(error.code())) throw;
    forecast.is_needed = true;
    forecast.problem = error.info().problem;
    for (const ErrorLocation& location : error.info().locations) forecast.locations.push_back(location.position);
  }
  Input input;
  RepairState state = first_state(soups, stitching, input, context);
  if (state.facets.empty()) throw_bad_argument("repairing " + sources_of(soups), "no facet has an area");
  forecast.length = state.length;
  forecast.n_facets = static_cast<std::int64_t>(state.facets.size());
  for (std::size_t t = 0; t < state.facets.size(); ++t) {
    const auto [a, b, c] = state.corners(t);
    forecast.area += triangle_area(a, b, c);
  }
  forecast.n_open = static_cast<std::int64_t>(close_up(state, options, context.part("close", 0.3, 0.8)));
  forecast.n_changes = static_cast<std::int64_t>(state.report.changes.size());
  forecast.n_seams = state.report.count(RepairKind::zipped);
  forecast.n_sheets = state.report.count(RepairKind::removed_sheet);
  forecast.n_holes = state.report.count(RepairKind::filled);
  for (const RepairChange& change : state.report.changes)
    if (change.kind == RepairKind::filled) forecast.n_fillings += change.n_facets;
  forecast.half = state.report.half;
  for (const std::vector<std::uint32_t>& loop : find_loops(state)) {
    Box box;
    for (const std::uint32_t v : loop) box.add(state.points[v]);
    if (const double width = norm(box.max - box.min); forecast.n_open > 0 && width > forecast.widest_open) {
      forecast.widest_open = width;
      forecast.widest_location = box.center();
    }
  }
  const EdgeTable edges = state.edges();
  forecast.n_crowded = std::ranges::count_if(edges.edges(), [](const Edge& edge) { return edge.count > 2; });
  forecast.n_crossings = find_crossings(state.points, state.facets, context.part("crossings", 0.8, 1.0)).total;
  forecast.is_enough = forecast.n_open == 0 && (is_cutting(options) || (forecast.n_crossings == 0 && forecast.n_crowded == 0));
  return forecast;
}

}  // namespace sterna::surfmesh
