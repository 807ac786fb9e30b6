#include "volmesh/case/thin_layers.h"

#include <algorithm>
#include <cmath>

#include "geom/math/constants.h"
#include "geom/mesh/gates.h"

namespace sterna::volmesh {
namespace {

constexpr double k_reported = 0.1;  ///< fraction of the wall area above which a report is made
constexpr double k_reach = 0.9;     ///< fraction of the wall area that the recommended number of layers must reach

bool is_one_request(const MeshCase& options) {
  const EnvelopeOptions& e = options.envelope;
  return e.layers > 0 && options.patches.empty() && !options.first_heights && options.family.refinement == 1.0 && is_automatic(e.total_height) &&
         is_automatic(e.max_thickness) && !is_automatic(e.first_height) && e.max_growth > 1.0;
}

/// Smallest height of the last cell that fits the tetrahedra, and the area of its triangle.
struct LastHeight {
  double height, area;
};

}  // namespace

std::optional<ThinLayers> thin_layers(const TriMesh& surface, const MeshCase& options) {
  if (!is_one_request(options)) return std::nullopt;
  const EnvelopeOptions& e = options.envelope;
  const double last = e.first_height * std::pow(e.max_growth, e.layers - 1), jump = info_of(Measure::interface_height).limits.usual;
  std::vector<LastHeight> target;
  double area = 0.0, thin = 0.0;
  for (const TriangleId t : surface.triangles.ids()) {
    if (surface.patches[surface.triangle_patch[t]].kind != PatchKind::wall) continue;
    const std::array<Point, 3> p = corners(surface, t);
    const double edge = (distance(p[0], p[1]) + distance(p[1], p[2]) + distance(p[2], p[0])) / 3.0;
    target.push_back({k_regular_height * edge / jump, 0.5 * norm(cross(p[1] - p[0], p[2] - p[0]))});
    area += target.back().area;
    if (last < target.back().height) thin += target.back().area;
  }
  if (!(thin > k_reported * area)) return std::nullopt;
  std::ranges::sort(target, {}, [](const LastHeight& w) { return std::pair(w.height, w.area); });
  double below = 0.0, height = 0.0;
  for (std::size_t i = 0; i < target.size() && below < k_reach * area; ++i) {
    below += target[i].area;
    height = target[i].height;
  }
  return ThinLayers{.share = thin / area, .enough = 1 + static_cast<int>(std::ceil(std::log(height / e.first_height) / std::log(e.max_growth)))};
}

}  // namespace sterna::volmesh
