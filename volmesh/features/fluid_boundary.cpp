#include "volmesh/features/fluid_boundary.h"

#include <algorithm>
#include <string>

#include "geom/math/measures.h"
#include "volmesh/adjacent/bare_planes.h"
#include "volmesh/domain/open_borders.h"
#include "volmesh/envelope/patch_layers.h"

namespace sterna::volmesh {
namespace {

/// Gives the layer of the walls to inflow and outflow patches beyond outer edges of walls (such as a nozzle at the end of its nacelle), unless a rule sets
/// layers = 0 for them. No layer can end at such edges. Cells around layer boundary vertices without a layer made the flow of an airliner diverge
/// (docs/measurements/solvers.md).
void continue_beyond_open_borders(const TriMesh& boundary, const MeshCase& options, const RunContext& context, Column<PatchId, std::uint8_t>& has_layer) {
  for (const PatchId p : flow_patches_beyond_open_borders(boundary, has_layer, context)) {
    const Patch& patch = boundary.patches[p];
    const EnvelopeOptions requested = request_of({patch.name, PatchKind::wall}, options.envelope, options.patches);
    if (!carries_layers(requested) || (is_automatic(requested.first_height) && !options.first_heights)) continue;
    has_layer[p] = 1;
    context.info("the layer of the walls continues over the " + std::string(to_string(patch.kind)) + " patch \"" + patch.name +
                 "\", which begins at an outer edge of a wall, where no layer can end; patches = { [\"" + patch.name +
                 "\"] = { layers = 0 } } ends the layer with zero height at that edge");
  }
}

}  // namespace

Column<PatchId, std::uint8_t> patches_with_layers(const TriMesh& boundary, const MeshCase& options, const RunContext& context) {
  const Column<PatchId, EnvelopeOptions> layers = layers_of_patches(boundary.patches, options.envelope, options.patches);
  Column<PatchId, std::uint8_t> has_layer(boundary.patches.size(), 0);
  // Files of triangles contain no patch kinds, so all their patches are walls, except periodic sides.
  const auto is_periodic = [&](const std::string& name) {
    return std::ranges::any_of(options.periodic, [&](const PeriodicNames& pair) { return pair.first == name || pair.second == name; });
  };
  for (const PatchId p : layers.ids()) has_layer[p] = carries_layers(layers[p]) && !is_periodic(boundary.patches[p].name) ? 1 : 0;
  continue_beyond_open_borders(boundary, options, context, has_layer);
  return has_layer;
}

FluidBoundary completed_boundary(const TriMesh& given, const MeshCase& options, const RunContext& context) {
  FluidBoundary whole{.n_given = given.n_triangles()};
  whole.mesh = complete_boundary(given, {options.farfield, options.farfield_surface, options.periodic}, context, &whole.planes);
  apply_patch_kinds(whole.mesh, options.patches);
  whole.has_layer = patches_with_layers(whole.mesh, options, context);
  mesh_bare_planes(whole.planes, given.n_triangles(), whole.has_layer, {options.ends, end_sizes(options)}, whole.mesh, context);
  return whole;
}

double least_first_height(const MeshCase& options) {
  double least = options.envelope.first_height;
  for (const Rule& rule : options.patches)
    if (const double own = value_or(rule, "first_height", k_automatic); !is_automatic(own)) least = is_automatic(least) ? own : std::min(least, own);
  return least;
}

bool opens_ridges(const MeshCase& options) {
  return options.ridges.is_on() ||
         std::ranges::any_of(options.patches, [](const Rule& rule) { return value_or(rule, "open_ridges", std::string()) == "always"; });
}

std::function<double(const Point&)> end_sizes(Borrowed<const MeshCase> borrowed) {
  const MeshCase& options = borrowed;
  const bool has_max = !is_automatic(options.size.size_max);
  if (options.sources.empty() && !has_max) return {};
  return [&options, has_max](const Point& p) {
    const double slope = options.size.size_growth - 1.0;
    double h = has_max ? options.size.size_max : 1e300;
    for (const SizeSource& source : options.sources) {
      h = std::min(h, size_of(source, p, slope));
      for (std::size_t i = 0; i < source.points.size(); ++i) h = std::min(h, source.sizes[i] + slope * distance(source.points[i], p));
    }
    return h;
  };
}

}  // namespace sterna::volmesh
