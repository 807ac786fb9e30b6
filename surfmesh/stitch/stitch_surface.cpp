// Stitching: join soups -> weld -> drop what bounds nothing -> judge (in this order: crowded edges, boundary, fans, orientation, crossings) -> orient
// outward -> name patches. The first defect in that order is the error; the others are mentioned in its text.
#include "surfmesh/stitch/stitch_surface.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "geom/base/error.h"
#include "geom/math/intersect.h"
#include "surfmesh/stitch/edges.h"
#include "surfmesh/stitch/orient.h"
#include "surfmesh/stitch/patches.h"
#include "surfmesh/stitch/weld.h"

namespace sterna::surfmesh {
namespace {

/// Near welding when an exactly welded surface is open: shares of the body length. Double precision text keeps 1e-9; 32-bit floats and the 6 to 7 digits
/// of usual text files keep 1e-7 of the largest coordinate, doubled for the two ends of a gap.
constexpr double k_weld_share_double = 1e-9;
constexpr double k_weld_share_single = 2e-7;
constexpr std::size_t k_max_places = 10;
constexpr std::size_t k_max_drawn = 20000;

double longest_side(const std::vector<Vec3>& points) {
  Box box;
  for (const Vec3& p : points) box.add(p);
  return box.longest_side();
}

std::string joined_sources(const std::vector<SurfaceSoup>& soups) {
  std::string text;
  for (const SurfaceSoup& soup : soups) text += (text.empty() ? "" : ", ") + soup.source;
  return text;
}

struct JoinedNames {
  std::vector<std::string> name;
  bool is_single_precision = false;
};

/// One point list, one triangle list; patches of the same clean name are the same patch.
IndexedSurface join(const std::vector<SurfaceSoup>& soups, double unit, JoinedNames& names) {
  IndexedSurface surface;
  for (const SurfaceSoup& soup : soups) {
    const auto shift = static_cast<std::uint32_t>(surface.points.size());
    for (const Vec3& p : soup.points) surface.points.push_back(unit * p);
    std::string stem = std::filesystem::path(soup.source).filename().string();
    stem = clean_patch_name(stem.substr(0, stem.find('.')), "wall");
    std::vector<std::uint32_t> soup2all;
    for (const std::string& raw : soup.patch_names) {
      const std::string name = clean_patch_name(raw, soups.size() > 1 ? stem : "wall");
      const auto found = std::find(names.name.begin(), names.name.end(), name);
      soup2all.push_back(static_cast<std::uint32_t>(found - names.name.begin()));
      if (found == names.name.end()) names.name.push_back(name);
    }
    for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
      const auto& t = soup.triangles[i];
      surface.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
      surface.patch.push_back(soup2all[soup.patch[i]]);
    }
    names.is_single_precision = names.is_single_precision || soup.single_precision;
  }
  return surface;
}

ErrorInfo start_error(ErrorCode code, const std::string& sources, std::string problem, std::int64_t n_places, std::string hint) {
  return {.code = code, .attempted = "stitching " + sources, .problem = std::move(problem), .n_places = n_places, .hint = std::move(hint)};
}

void draw_edges(const IndexedSurface& surface, const std::vector<EdgeUse>& uses, ErrorInfo& info) {
  for (std::size_t i = 0; i < std::min(uses.size(), k_max_drawn); ++i) {
    const auto next = static_cast<std::uint32_t>(info.geometry.points.size());
    info.geometry.points.push_back(surface.points[uses[i].a]);
    info.geometry.points.push_back(surface.points[uses[i].b]);
    info.geometry.edges.push_back({next, next + 1});
    if (i < k_max_places)
      info.places.push_back({0.5 * (surface.points[uses[i].a] + surface.points[uses[i].b]),
                             "edge of length " + std::to_string(distance(surface.points[uses[i].a], surface.points[uses[i].b])) + " m"});
  }
}

void draw_triangle(const IndexedSurface& surface, std::uint32_t t, TroubleGeometry& geometry) {
  const auto next = static_cast<std::uint32_t>(geometry.points.size());
  for (const std::uint32_t v : surface.triangles[t]) geometry.points.push_back(surface.points[v]);
  geometry.triangles.push_back({next, next + 1, next + 2});
}

/// Throws for the first defect in the documented order.
void judge_edges(const IndexedSurface& surface, const EdgeDefects& defects, bool allow_open, const std::string& sources) {
  const auto n_boundary = static_cast<std::int64_t>(defects.boundary.size());
  const auto n_crowded = static_cast<std::int64_t>(defects.crowded.size());
  if (n_crowded > 0) {
    ErrorInfo info = start_error(ErrorCode::non_manifold_surface, sources,
                                 std::to_string(n_crowded) + " edges have more than two triangles" +
                                     (n_boundary > 0 ? "; besides, " + std::to_string(n_boundary) + " edges have only one" : ""),
                                 n_crowded, "remove inner walls and doubled sheets in the program that made the surface");
    draw_edges(surface, defects.crowded, info);
    throw Error(std::move(info));
  }
  if (n_boundary > 0 && !allow_open) {
    ErrorInfo info = start_error(ErrorCode::open_surface, sources, std::to_string(n_boundary) + " edges have only one triangle: the surface is open", n_boundary,
                                 "close the holes; if it is only cracks, weld_tolerance = 1e-4*mm or the like closes them");
    draw_edges(surface, defects.boundary, info);
    throw Error(std::move(info));
  }
}

void judge_fans(const IndexedSurface& surface, const EdgeTable& edges, const std::string& sources) {
  const std::vector<std::uint32_t> bad = vertices_with_several_fans(surface, edges);
  if (bad.empty()) return;
  ErrorInfo info = start_error(ErrorCode::non_manifold_surface, sources, std::to_string(bad.size()) + " vertices belong to more than one fan of triangles: the surface touches itself there",
                               static_cast<std::int64_t>(bad.size()), "separate the parts that touch, or join them properly");
  for (const std::uint32_t v : bad) {
    info.geometry.vertices.push_back(static_cast<std::uint32_t>(info.geometry.points.size()));
    info.geometry.points.push_back(surface.points[v]);
    if (info.places.size() < k_max_places) info.places.push_back({surface.points[v], "vertex"});
  }
  throw Error(std::move(info));
}

void judge_orientation(const IndexedSurface& surface, const Orientation& orientation, const std::string& sources) {
  if (orientation.conflicts.empty()) return;
  ErrorInfo info = start_error(ErrorCode::not_orientable, sources, "no orientation is consistent (like a Moebius band)", static_cast<std::int64_t>(orientation.conflicts.size()),
                               "look for a twisted strip or a wrongly welded seam");
  draw_edges(surface, orientation.conflicts, info);
  throw Error(std::move(info));
}

void judge_crossings(const IndexedSurface& surface, const std::string& sources, const RunContext& context) {
  const CrossingPairs crossings = find_crossings(surface.points, surface.triangles, context);
  if (crossings.total == 0) return;
  ErrorInfo info = start_error(ErrorCode::self_intersection, sources, std::to_string(crossings.total) + " pairs of triangles intersect", crossings.total,
                               "unite overlapping parts with a boolean operation before meshing");
  for (std::size_t i = 0; i < std::min(crossings.pairs.size(), k_max_drawn); ++i) {
    const auto& pair = crossings.pairs[i];
    if (i < k_max_places) {
      const auto& t = surface.triangles[pair[0]];
      info.places.push_back({(surface.points[t[0]] + surface.points[t[1]] + surface.points[t[2]]) / 3.0,
                             "triangles " + std::to_string(pair[0]) + " and " + std::to_string(pair[1])});
    }
    for (const std::uint32_t t : pair) draw_triangle(surface, t, info.geometry);
  }
  throw Error(std::move(info));
}

/// Closes cracks: boundary vertices nearer than the tolerance become one, if that makes no edge crowded. Returns the welded number.
std::int64_t weld_cracks(IndexedSurface& surface, double tolerance, const RunContext& context) {
  const EdgeDefects before = find_defects(EdgeTable(surface, context));
  if (before.boundary.empty()) return 0;
  std::vector<std::uint8_t> is_boundary(surface.points.size(), 0);
  for (const EdgeUse& use : before.boundary) is_boundary[use.a] = is_boundary[use.b] = 1;
  IndexedSurface welded = surface;
  const std::int64_t n = weld_near(welded, tolerance, &is_boundary);
  if (n == 0) return 0;
  drop_collapsed(welded);
  const EdgeDefects after = find_defects(EdgeTable(welded, context));
  if (after.crowded.size() > before.crowded.size() || after.boundary.size() >= before.boundary.size()) return 0;
  surface = std::move(welded);
  return n;
}

void name_patches(const IndexedSurface& surface, const std::vector<std::string>& names, const std::vector<std::uint32_t>& parent, TriMesh& mesh) {
  std::vector<int> n_parts(names.size(), 0), part(names.size(), 0);
  for (const std::uint32_t p : parent) ++n_parts[p];
  std::set<std::string> taken;
  for (const std::uint32_t p : parent) {
    std::string name = n_parts[p] == 1 ? names[p] : names[p] + "_" + std::to_string(++part[p]);
    while (!taken.insert(name).second) name += "_";
    mesh.patches.push_back({name, PatchKind::wall});
  }
  mesh.triangle_patch.reserve(surface.patch.size());
  for (const std::uint32_t p : surface.patch) mesh.triangle_patch.push_back(PatchId(p));
}

/// Drops patch numbers that no triangle uses, keeping their order.
std::vector<std::uint32_t> used_patches(IndexedSurface& surface, std::size_t n_names) {
  std::vector<std::uint32_t> number(n_names, 0xffffffffu), parent;
  for (const std::uint32_t p : surface.patch) number[p] = 0;
  for (std::uint32_t p = 0; p < n_names; ++p) {
    if (number[p] == 0xffffffffu) continue;
    number[p] = static_cast<std::uint32_t>(parent.size());
    parent.push_back(p);
  }
  for (std::uint32_t& p : surface.patch) p = number[p];
  return parent;
}

}  // namespace

StitchResult stitch_surface(const std::vector<SurfaceSoup>& soups, const StitchOptions& options, const RunContext& context) {
  const StageTimer timer(context, "stitch");
  const std::string sources = joined_sources(soups);
  StitchResult result;
  StitchReport& report = result.report;
  const auto say = [&](std::int64_t n, const std::string& what) {
    if (n == 0) return;
    report.messages.push_back(sources + ": " + std::to_string(n) + " " + what);
    context.info(report.messages.back());
  };

  JoinedNames names;
  IndexedSurface surface = join(soups, options.unit, names);
  report.n_triangles_read = static_cast<std::int64_t>(surface.triangles.size());
  report.n_vertices_read = static_cast<std::int64_t>(surface.points.size());
  if (surface.triangles.empty()) throw Error(start_error(ErrorCode::empty_surface, sources, "no triangles", 1, "is this a surface file?"));

  report.n_unused_vertices = drop_unused(surface);
  report.n_welded_exact = weld_exact(surface, context);
  if (!is_automatic(options.weld_tolerance)) report.n_welded_near = weld_near(surface, options.weld_tolerance, nullptr);
  report.n_degenerate_removed = drop_collapsed(surface);
  report.n_duplicate_removed = drop_duplicates(surface);
  if (is_automatic(options.weld_tolerance)) {
    const double tolerance = (names.is_single_precision ? k_weld_share_single : k_weld_share_double) * longest_side(surface.points);
    report.n_welded_near = weld_cracks(surface, tolerance, context);
  }
  report.n_degenerate_removed += flip_zero_area(surface);
  drop_unused(surface);
  say(report.n_welded_near, "near vertices welded");
  say(report.n_degenerate_removed, "degenerate facets removed");
  say(report.n_duplicate_removed, "duplicate facets removed");
  say(report.n_unused_vertices, "unused vertices dropped");
  if (surface.triangles.empty()) throw Error(start_error(ErrorCode::empty_surface, sources, "all triangles are degenerate", 1, "check the unit and the file"));

  const EdgeTable edges(surface, context);
  const EdgeDefects defects = find_defects(edges);
  judge_edges(surface, defects, options.allow_open, sources);
  judge_fans(surface, edges, sources);
  Orientation orientation = orient_consistently(surface, edges);
  judge_orientation(surface, orientation, sources);
  if (options.check_intersections) judge_crossings(surface, sources, context);

  report.is_closed = defects.boundary.empty();
  if (report.is_closed) say(orient_outward(surface, orientation, context), "triangles of shells inside the solid of another body dropped: no fluid reaches them");
  else orient_open_outward(surface, orientation);
  drop_unused(surface);
  report.n_components = orientation.n_components;
  report.n_flipped = std::count(orientation.is_flipped.begin(), orientation.is_flipped.end(), 1);
  say(report.n_flipped, "triangles turned so that normals point out of the body");

  std::vector<std::uint32_t> parent;
  if (is_automatic(options.split_angle)) parent = used_patches(surface, names.name.size());
  else split_by_angle(surface, EdgeTable(surface, context), options.split_angle, parent);
  TriMesh& mesh = result.mesh;
  name_patches(surface, names.name, parent, mesh);
  mesh.triangles.reserve(surface.triangles.size());
  for (const auto& t : surface.triangles) mesh.triangles.push_back({VertexId(t[0]), VertexId(t[1]), VertexId(t[2])});
  mesh.points = Column<VertexId, Point>(std::move(surface.points));
  return result;
}

}  // namespace sterna::surfmesh
