// Finds sliver triangles (needles and caps), which are triangles with a small angle. This does not depend on their neighbours.
#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "volmesh/inspect/survey.h"

namespace sterna::volmesh {
namespace {

/// Returns the smallest angle, which is opposite the shortest edge.
double smallest_angle(const std::array<Point, 3>& p) {
  const std::array<double, 3> opposite = {norm2(p[2] - p[1]), norm2(p[0] - p[2]), norm2(p[1] - p[0])};
  const std::size_t k = opposite[0] <= opposite[1] ? (opposite[0] <= opposite[2] ? 0 : 2) : (opposite[1] <= opposite[2] ? 1 : 2);
  return corner_angle(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
}

}  // namespace

void survey_slivers(const Survey& survey) {
  const double limit = survey.request.limits.min_angle;
  std::vector<float> angles(survey.mesh.n_triangles());
  const auto slivers = find_suspects<TriangleId>(survey.context, survey.mesh.n_triangles(), [&](TriangleId t, auto& list) {
    const double angle = smallest_angle(corners(survey.mesh, t));
    angles[t.index()] = static_cast<float>(angle / k_degree);
    if (!(angle >= limit)) list.push_back({t, -angle});  // this is also true for coordinates that are not finite
  });
  survey.add_field("smallest_angle", "smallest angle of the triangle", "deg", false, std::move(angles));
  if (slivers.empty()) return;
  Finding finding{.kind = FindingKind::needle, .severity = Severity::warn, .limit = limit / k_degree, .unit = "deg"};
  finding.value = -worst(slivers, 1).front().badness / k_degree;
  finding.text = count_of(static_cast<std::int64_t>(slivers.size()), "triangle has", "triangles have") + " an angle below " +
                 number_text(finding.limit, k_text_digits) + " deg, the smallest " + number_text(finding.value, k_text_digits) +
                 " deg: cells there have a low quality, and the layer becomes low";
  finding.advice =
      "re-mesh the surface (`sterna remesh`, or surface_mesh of the CAD model), or weld the ends of the short edges: weld_tolerance slightly above their "
      "length";
  survey.add(std::move(finding), slivers, [&](const Suspect<TriangleId>& s) {
    return FindingLocation{survey.middle(s.id), survey.patch_of(s.id), -s.badness / k_degree, "triangle " + std::to_string(s.id.value())};
  });
}

}  // namespace sterna::volmesh
