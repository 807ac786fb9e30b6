// Checks the visibility of all facets of a vertex from one growth direction, by the smallest cap that contains their normals.
#include <cmath>

#include "geom/base/number_text.h"
#include "volmesh/inspect/survey.h"

namespace sterna::volmesh {
namespace {

/// Cosines below this value are rounding errors: there is no direction from which all facets are visible. The value is that of the envelope's initial step.
constexpr double k_visible = 1e-9;

void add_vertices(const Survey& survey, const LayerBase& base, const WallMap& map, Finding finding, const std::vector<Suspect<VertexId>>& suspects) {
  finding.count = static_cast<std::int64_t>(suspects.size());
  double area = 0.0, all = 0.0;
  std::vector<TriangleId> where;
  for (const auto& s : suspects) {
    area += base.vertex_area[s.id];
    for (const HalfedgeId h : base.topology.outgoing(s.id)) where.push_back(map.triangle(triangle_of(h)));
  }
  for (const double a : base.vertex_area) all += a;
  finding.share = area / all;
  for (const auto& s : worst(suspects, survey.n_locations()))
    finding.locations.push_back({base.wall.points[s.id], survey.patch_of(map.triangle(triangle_of(base.topology.outgoing(s.id).front()))), s.badness / k_degree,
                                 "vertex " + std::to_string(s.id.value()) + ", best growth direction " + number_text(s.badness / k_degree, k_text_digits) +
                                     " deg from a facet normal"});
  add_finding(survey.report, std::move(finding), where);
}

}  // namespace

void survey_visibility(const Survey& survey, const LayerBase& base, const WallMap& map) {
  const double limit = survey.request.limits.visibility_angle;
  std::vector<double> degrees(base.wall.n_vertices());
  std::vector<Suspect<VertexId>> hidden, hard;
  for (const VertexId v : base.visibility.ids()) {
    const double angle = std::acos(std::clamp(base.visibility[v], -1.0, 1.0));
    degrees[v.index()] = angle / k_degree;
    if (base.topology.outgoing(v).empty()) continue;
    if (base.visibility[v] <= k_visible) hidden.push_back({v, angle});
    else if (angle > limit) hard.push_back({v, angle});
  }
  survey.add_field("visibility_angle", "largest angle between the best growth direction and a facet normal", "deg", true, map.field(degrees));
  if (!hidden.empty()) {
    Finding finding{
        .kind = FindingKind::hidden, .severity = Severity::warn, .value = worst(hidden, 1).front().badness / k_degree, .limit = 90.0, .unit = "deg"};
    finding.text = "at " + count_of(static_cast<std::int64_t>(hidden.size()), "vertex", "vertices") + " no growth direction points out of all facets (" +
                   number_text(finding.value, k_text_digits) + " deg at the worst): no layer grows there, and only a low layer around it";
    finding.advice = "blunt or round the corner in the CAD model; if a few facets point against their neighbours, re-mesh the surface there";
    add_vertices(survey, base, map, std::move(finding), hidden);
  }
  if (!hard.empty()) {
    Finding finding{.kind = FindingKind::visibility,
                    .severity = Severity::warn,
                    .value = worst(hard, 1).front().badness / k_degree,
                    .limit = limit / k_degree,
                    .unit = "deg"};
    finding.text = "at " + count_of(static_cast<std::int64_t>(hard.size()), "vertex", "vertices") +
                   " the best growth direction is off a facet normal by more than " + number_text(finding.limit, k_text_digits) + " deg (" +
                   number_text(finding.value, k_text_digits) + " deg at the worst): the layer is skewed and becomes thin there";
    finding.advice =
        "make sharp edges blunt (a trailing edge a few first heights thick), or refine along the edge so that the turn is spread over several facets";
    if (base.ridges == nullptr)
      finding.advice +=
          "; or use several growth lines on each vertex there (open_ridges = \"always\", --open-ridges always), or layers that continue behind trailing edges "
          "(wakes = \"auto\", --wake-sheet auto): see docs/ridges.md and docs/wake_sheets.md";
    add_vertices(survey, base, map, std::move(finding), hard);
  }
}

}  // namespace sterna::volmesh
