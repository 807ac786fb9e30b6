// Finds pairs of triangles that intersect or touch, by the exact test.
#include "geom/math/measures.h"
#include "geom/mesh/find_crossings.h"
#include "volmesh/inspect/survey.h"

namespace sterna::volmesh {
namespace {

/// Largest number of pairs that are stored for the picture.
constexpr std::size_t k_kept_pairs = 200000;

}  // namespace

bool survey_crossings(const Survey& survey) {
  const TriMesh& mesh = survey.mesh;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(mesh.n_triangles());
  for (const TriangleVertices& t : mesh.triangles) triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  const CrossingPairs crossings = find_crossings(mesh.points.raw(), triangles, survey.context, k_kept_pairs);
  if (crossings.total == 0) return true;
  Finding finding{.kind = FindingKind::crossing, .severity = Severity::error, .count = crossings.total};
  std::vector<TriangleId> where;
  std::vector<std::uint8_t> is_location(mesh.n_triangles(), 0);
  for (const auto& [a, b] : crossings.pairs) {
    const TriangleId first(a), second(b);
    where.push_back(first);
    where.push_back(second);
    if (finding.locations.size() >= survey.n_locations()) continue;
    // The smaller triangle gives the more precise location. Each location is listed once, so that the list is not filled by one large triangle.
    const auto area = [&](TriangleId t) {
      return triangle_area(mesh.points[mesh.triangles[t][0]], mesh.points[mesh.triangles[t][1]], mesh.points[mesh.triangles[t][2]]);
    };
    const TriangleId smaller = area(first) <= area(second) ? first : second;
    if (is_location[smaller.index()] || is_location[first.index()]) continue;
    is_location[smaller.index()] = is_location[first.index()] = 1;
    finding.locations.push_back(
        {survey.middle(smaller), survey.patch_of(smaller), 0.0,
         "triangles " + std::to_string(a) + " (" + survey.patch_of(first) + ") and " + std::to_string(b) + " (" + survey.patch_of(second) + ")"});
  }
  finding.text = count_of(crossings.total, "pair of triangles crosses or touches", "pairs of triangles cross or touch");
  finding.advice = "unite overlapping bodies with `sterna union` (union{...} in a script); `sterna repair` repairs crossings of all kinds";
  add_finding(survey.report, std::move(finding), where);
  return false;
}

}  // namespace sterna::volmesh
