// This is the driver. Exact welding and cleaning come first, with the numbers as stored in the file, so that equal or collinear points are found exactly. Then
// come the combinatorial checks, orientation, scaling to metres, and the exact intersection test on the coordinates that will be meshed.
#include "surfmesh/stitch/stitch_surface.h"

#include "geom/base/error.h"
#include "geom/mesh/find_crossings.h"
#include "surfmesh/stitch/clean_facets.h"
#include "surfmesh/stitch/defect_errors.h"
#include "surfmesh/stitch/edge_table.h"
#include "surfmesh/stitch/orient.h"
#include "surfmesh/stitch/patches.h"
#include "surfmesh/stitch/weld.h"

namespace sterna::surfmesh {
namespace {

void report_welding(StitchReport& report) {
  if (report.n_unused_vertices > 0) report.messages.push_back("dropped " + count_of(report.n_unused_vertices, "unused vertex", "unused vertices"));
  const bool is_loose = report.n_vertices_read == 3 * report.n_triangles_read;  // as in STL files: every triangle has its own corners
  if (report.n_welded_exact > 0 && !is_loose)
    report.messages.push_back("welded " + count_of(report.n_welded_exact, "vertex", "vertices") + " to others with the same coordinates");
}

/// Logs the messages from number n_logged on. It is called before each step that may throw, so that the log shows the repairs before the error.
void log_messages(const StitchReport& report, std::size_t& n_logged, const RunContext& context) {
  for (; n_logged < report.messages.size(); ++n_logged) context.info("surface: " + report.messages[n_logged]);
}

void scale_to_metres(WorkingSurface& surface) {
  for (Vec3& p : surface.points) p = surface.metres(p);
  surface.to_metres = 1.0;
}

/// Tests for crossings. Flat facets have already been flipped in file units, but the conversion to metres can round other facets to flat ones.
void prove_free_of_crossings(WorkingSurface& surface, const StitchOptions& options, StitchReport& report, const RunContext& context) {
  const std::vector<std::uint32_t> flat = flip_flat_facets(surface, report);
  if (!options.check_intersections && flat.empty()) return;
  CrossingPairs crossings;
  if (flat.empty()) {
    crossings = find_crossings(surface.points, surface.facets, context);
  } else {
    // The exact test requires facets with an area. Other facets are left out, and the pairs found are then numbered as in the surface.
    std::vector<Facet> facets;
    std::vector<std::uint32_t> facets2surface;
    std::size_t next_flat = 0;
    for (std::uint32_t t = 0; t < surface.n_facets(); ++t) {
      if (next_flat < flat.size() && flat[next_flat] == t) {
        ++next_flat;
        continue;
      }
      facets.push_back(surface.facets[t]);
      facets2surface.push_back(t);
    }
    if (options.check_intersections) crossings = find_crossings(surface.points, facets, context);
    for (auto& [a, b] : crossings.pairs) {
      a = facets2surface[a];
      b = facets2surface[b];
    }
  }
  if (crossings.total > 0 || !flat.empty()) throw_self_intersection(surface, crossings, flat);
}

}  // namespace

StitchResult stitch_surface(const std::vector<SurfaceSoup>& soups, const StitchOptions& options, const RunContext& context) {
  StitchReport report;
  std::size_t n_logged = 0;
  WorkingSurface surface = weld_exact(soups, options, report);
  report_welding(report);
  drop_degenerate_facets(surface, report);
  drop_doubled_facets(surface, report);
  weld_near(surface, options, report, context);
  log_messages(report, n_logged, context);
  if (surface.facets.empty()) throw_empty(surface, report);
  separate_parts(surface);
  context.progress(0.3);

  {
    EdgeTable edges(surface.facets, surface.points.size());
    if (drop_parts_without_thickness(surface, edges, report)) edges = EdgeTable(surface.facets, surface.points.size());
    const Defects defects = find_defects(surface.facets, surface.points.size(), edges);
    const Orientation orientation = flood_orientation(surface, edges);
    throw_on_defects(surface, edges, defects, orientation, options, context);
    report.is_closed = defects.boundary.empty();
    orient_outward(surface, edges, orientation, options.fluid == "inside", clean_patch_names(soups), report, context);
  }
  flip_flat_facets(surface, report);
  scale_to_metres(surface);
  log_messages(report, n_logged, context);
  context.progress(0.5);
  prove_free_of_crossings(surface, options, report, context);
  context.progress(0.9);

  StitchResult result;
  result.mesh = make_mesh(surface, clean_patch_names(soups, &report.messages));
  if (!is_automatic(options.split_angle)) split_patches(result.mesh, options.split_angle, context);
  if (!report.is_closed) report.messages.push_back("the surface has an open boundary, which is allowed");
  log_messages(report, n_logged, context);
  context.debug("surface: " + count_of(static_cast<std::int64_t>(result.mesh.n_triangles()), "triangle", "triangles") + ", " +
                count_of(static_cast<std::int64_t>(result.mesh.n_vertices()), "vertex", "vertices") + ", " +
                count_of(report.n_components, "component", "components") + ", " +
                count_of(static_cast<std::int64_t>(result.mesh.patches.size()), "patch", "patches") + ", body length " +
                short_number(body_length(result.mesh)) + " m (unit of the file: " + short_number(options.unit) + " m)");
  result.report = std::move(report);
  context.progress(1.0);
  return result;
}

}  // namespace sterna::surfmesh
