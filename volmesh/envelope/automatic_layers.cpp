#include "volmesh/envelope/automatic_layers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/base/print_text.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "volmesh/envelope/layer_base.h"
#include "volmesh/envelope/patch_layers.h"

namespace sterna::volmesh {
namespace {

constexpr double k_target_last = 0.5;          ///< height of the last cell, as a fraction of the height of a regular tetrahedron on the triangle
constexpr double k_area_share = 0.9;           ///< fraction of the wall area on which this height must be reached
constexpr int k_most_automatic_layers = 1000;  ///< upper limit of the option layers
constexpr int k_too_many = k_most_automatic_layers + 1;

struct TargetLayers {
  int layers = 0;
  double area = 0.0;
};

/// Returns the number of cells of first height h0 that grow by g to at least `last`; k_too_many if k_most_automatic_layers do not reach `last`.
int layers_to_height(double h0, double growth, double last) {
  if (last <= h0) return 1;
  const double layers = growth > 1.0 ? 1.0 + std::ceil(std::log(last / h0) / std::log(growth)) : std::numeric_limits<double>::infinity();
  return layers <= k_most_automatic_layers ? static_cast<int>(layers) : k_too_many;
}

/// Returns the smallest number of layers that is sufficient on k_area_share of the area.
int enough(std::vector<TargetLayers>& target) {
  std::ranges::sort(target, {}, [](const TargetLayers& w) { return std::pair(w.layers, w.area); });
  double all = 0.0, below = 0.0;
  for (const TargetLayers& w : target) all += w.area;
  for (const TargetLayers& w : target)
    if (below += w.area; below >= k_area_share * all) return w.layers;
  return target.back().layers;
}

}  // namespace

int automatic_layers(const TriMesh& surface, const MeshCase& options, const RunContext& context) {
  Column<PatchId, EnvelopeOptions> requested;
  Column<PatchId, std::uint8_t> is_open;             // the number of layers follows from the triangles of the patch
  Column<PatchId, const FirstHeights*> by_location;  // null: the patch has one first height
  for (const Patch& patch : surface.patches) {
    const EnvelopeOptions& layers = requested[requested.push_back(request_of(with_kind(patch, options.patches), options.envelope, options.patches))];
    const bool has_own_height = rule_for(patch.name, options.patches, "total_height") != nullptr;
    is_open.push_back(is_automatic(layers.layers) && !has_own_height && !is_automatic(layers.first_height) ? 1 : 0);
    by_location.push_back(rule_for(patch.name, options.patches, "first_height") ? nullptr : options.first_heights.get());
  }
  std::vector<TargetLayers> of_triangle(surface.n_triangles());
  parallel_for(context, surface.n_triangles(), [&](std::size_t i) {
    const TriangleId t(i);
    const PatchId id = surface.triangle_patch[t];
    const EnvelopeOptions& patch = requested[id];
    if (is_open[id] == 0) return;
    const std::array<Point, 3> p = corners(surface, t);
    const double area = 0.5 * norm(cross(p[1] - p[0], p[2] - p[0])), edge = (distance(p[0], p[1]) + distance(p[1], p[2]) + distance(p[2], p[0])) / 3.0;
    double h0 = patch.first_height;
    if (const FirstHeights* heights = by_location[id]) h0 = std::max({heights->at(p[0]), heights->at(p[1]), heights->at(p[2])});
    of_triangle[i] = {layers_to_height(h0, patch.max_growth, k_target_last * k_regular_height * layer_edge_of(std::sqrt(k_equilateral * area), edge)), area};
  });
  std::map<std::pair<double, double>, std::vector<TargetLayers>> groups;  // groups of walls, keyed by first height and growth
  for (const TriangleId t : surface.triangles.ids())
    if (const PatchId id = surface.triangle_patch[t]; is_open[id] != 0)
      groups[{requested[id].first_height, requested[id].max_growth}].push_back(of_triangle[t.index()]);
  int layers = 0;
  for (auto& [request, target] : groups) {
    const auto [first_height, growth] = request;
    layers = std::max(layers, enough(target));
    if (layers == k_too_many)
      throw_bad_argument("choosing the number of layers",
                         print_text("%d layers of first height %.6g m that grow by %.6g do not reach half of the height of a regular tetrahedron on the wall",
                                    k_most_automatic_layers, first_height, growth),
                         {}, "raise max_growth, or give layers");
  }
  if (layers > 0) return layers;
  bool has_walls = false;
  for (const PatchId id : requested.ids()) {
    layers = std::max(layers, requested[id].layers);
    has_walls = has_walls || rule_for(surface.patches[id].name, options.patches, "layers");
  }
  return has_walls ? layers : 1;
}

MeshCase with_automatic_layers(const TriMesh& surface, MeshCase options, const RunContext& context) {
  EnvelopeOptions& e = options.envelope;
  if (!is_automatic(e.layers)) return options;
  e.layers = automatic_layers(surface, options, context);
  if (e.layers > 0)
    context.info(print_text("%d layers that grow by %.4g: the last cell is at least half as tall as a regular tetrahedron on nine tenths of the walls' area",
                            e.layers, e.max_growth));
  return options;
}

}  // namespace sterna::volmesh
