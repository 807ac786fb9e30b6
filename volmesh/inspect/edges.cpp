// Finds pairs of neighbouring triangles that are folded onto each other, that differ very much in size, that share an edge that is too short, or whose edge
// bends too much for a smooth surface.
#include <cmath>

#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "volmesh/inspect/survey.h"

namespace sterna::volmesh {
namespace {

double mean_edge(const TriMesh& mesh, TriangleId t) {
  const auto [a, b, c] = corners(mesh, t);
  return (distance(a, b) + distance(b, c) + distance(c, a)) / 3.0;
}

/// Returns the unit normals of all triangles. They are computed once, because each edge needs the normals of both sides.
Column<TriangleId, Vec3> unit_normals(const TriMesh& mesh, const RunContext& context) {
  Column<TriangleId, Vec3> normals(mesh.n_triangles());
  parallel_for(context, normals.size(), [&](std::size_t i) {
    const TriangleId t(static_cast<std::uint64_t>(i));
    const auto [a, b, c] = corners(mesh, t);
    normals[t] = normalized(area_vector(a, b, c));
  });
  return normals;
}

Point middle_of(const TriMesh& mesh, const Topology& topology, HalfedgeId h) { return 0.5 * (mesh.points[topology.from(h)] + mesh.points[topology.to(h)]); }

std::string edge_text(HalfedgeId h, const Topology& topology) {
  const HalfedgeId twin = topology.twin(h);
  const std::string first = std::to_string(triangle_of(h).value());
  return twin.is_valid() ? "edge of triangles " + first + " and " + std::to_string(triangle_of(twin).value()) : "edge of triangle " + first;
}

/// Returns true for the half-edge of each edge that has the lower number.
bool is_first(const Topology& topology, HalfedgeId h) { return topology.is_boundary(h) || h < topology.twin(h); }

bool is_concave(const TriMesh& mesh, const Topology& topology, HalfedgeId h, const Vec3& n, const Vec3& m) {
  return dot(cross(n, m), mesh.points[topology.to(h)] - mesh.points[topology.from(h)]) < 0.0;
}

struct EdgeSuspects {
  std::vector<Suspect<HalfedgeId>> folded, jumps, shorts, coarse;
};

void add_edges(const Survey& survey, const Topology& topology, Finding finding, const std::vector<Suspect<HalfedgeId>>& suspects, double scale) {
  finding.count = static_cast<std::int64_t>(suspects.size());
  std::vector<TriangleId> where;
  for (const auto& s : suspects) {
    where.push_back(triangle_of(s.id));
    if (!topology.is_boundary(s.id)) where.push_back(triangle_of(topology.twin(s.id)));
  }
  for (const auto& s : worst(suspects, survey.n_locations()))
    finding.locations.push_back({middle_of(survey.mesh, topology, s.id), survey.patch_of(triangle_of(s.id)), scale * s.badness, edge_text(s.id, topology)});
  add_finding(survey.report, std::move(finding), where);
}

EdgeSuspects find_edges(const Survey& survey, const Topology& topology, const Column<TriangleId, Vec3>& normals, double feature_angle) {
  const TriMesh& mesh = survey.mesh;
  const InspectOptions& limits = survey.request.limits;
  const double shortest = limits.short_edge * survey.report.length;
  const double fold_cosine = -std::cos(limits.fold_angle);
  const double coarse_cosine = std::cos(limits.coarse_angle), feature_cosine = std::cos(feature_angle);
  Column<TriangleId, double> size(mesh.n_triangles());
  parallel_for(survey.context, size.size(),
               [&](std::size_t i) { size[TriangleId(static_cast<std::uint64_t>(i))] = mean_edge(mesh, TriangleId(static_cast<std::uint64_t>(i))); });
  return parallel_reduce(
      survey.context, topology.n_halfedges(), EdgeSuspects{},
      [&](std::size_t begin, std::size_t end) {
        EdgeSuspects part;
        for (std::size_t i = begin; i < end; ++i) {
          const HalfedgeId h(static_cast<std::uint64_t>(i));
          if (!is_first(topology, h)) continue;
          const double length = distance(mesh.points[topology.from(h)], mesh.points[topology.to(h)]);
          if (length < shortest) part.shorts.push_back({h, -length});
          if (topology.is_boundary(h)) continue;
          const TriangleId t = triangle_of(h), u = triangle_of(topology.twin(h));
          const Vec3 &n = normals[t], &m = normals[u];
          // The angle between the facets is pi if they are flat, and 0 if they lie back to back.
          if (dot(n, m) < fold_cosine) part.folded.push_back({h, angle_between(n, m) - std::numbers::pi});
          if (dot(n, m) < coarse_cosine && dot(n, m) > feature_cosine) part.coarse.push_back({h, angle_between(n, m)});
          const double first = size[t], second = size[u];
          const double jump = std::max(first, second) / std::min(first, second);
          if (jump > limits.size_jump) part.jumps.push_back({h, jump});
        }
        return part;
      },
      [](EdgeSuspects a, EdgeSuspects b) {
        return EdgeSuspects{joined_lists(std::move(a.folded), std::move(b.folded)), joined_lists(std::move(a.jumps), std::move(b.jumps)),
                            joined_lists(std::move(a.shorts), std::move(b.shorts)), joined_lists(std::move(a.coarse), std::move(b.coarse))};
      });
}

void add_folds(const Survey& survey, const Topology& topology, const Column<TriangleId, Vec3>& normals, const std::vector<Suspect<HalfedgeId>>& folded) {
  Finding finding{.kind = FindingKind::fold,
                  .severity = Severity::warn,
                  .value = -worst(folded, 1).front().badness / k_degree,
                  .limit = survey.request.limits.fold_angle / k_degree,
                  .unit = "deg"};
  const auto n_concave = std::ranges::count_if(
      folded, [&](const auto& s) { return is_concave(survey.mesh, topology, s.id, normals[triangle_of(s.id)], normals[triangle_of(topology.twin(s.id))]); });
  finding.text = count_of(static_cast<std::int64_t>(folded.size()), "pair of neighbours is", "pairs of neighbours are") +
                 " folded onto each other, with less than " + number_text(finding.limit, k_text_digits) + " deg between them (" + std::to_string(n_concave) +
                 " of them with fluid in between): no layer fits there, and tetrahedra engines fail";
  finding.advice = n_concave > 0 ? "open the gap in the CAD model, or fill the gap"
                                 : "make the edge blunt in the CAD model: a trailing edge should be at least a few first heights thick";
  add_edges(survey, topology, std::move(finding), folded, -1.0 / k_degree);
}

void add_jumps(const Survey& survey, const Topology& topology, const std::vector<Suspect<HalfedgeId>>& jumps) {
  Finding finding{
      .kind = FindingKind::size_jump, .severity = Severity::warn, .value = worst(jumps, 1).front().badness, .limit = survey.request.limits.size_jump};
  finding.text = count_of(static_cast<std::int64_t>(jumps.size()), "edge separates", "edges separate") + " triangles of very different size, up to " +
                 number_text(finding.value, k_text_digits) + " times: the last layer and the tetrahedra above it cannot match both";
  finding.advice = "re-mesh the surface with growth = 1.2 to 1.5 from triangle to triangle";
  add_edges(survey, topology, std::move(finding), jumps, 1.0);
}

void add_shorts(const Survey& survey, const Topology& topology, const std::vector<Suspect<HalfedgeId>>& shorts) {
  const double share = survey.request.limits.short_edge;
  Finding finding{.kind = FindingKind::short_edge,
                  .severity = Severity::warn,
                  .value = -worst(shorts, 1).front().badness,
                  .limit = share * survey.report.length,
                  .unit = "m"};
  finding.text = count_of(static_cast<std::int64_t>(shorts.size()), "edge is", "edges are") + " shorter than " + number_text(share, k_text_digits) +
                 " body lengths, the shortest " + in_metres(finding.value, k_text_digits) + ": two points that were probably meant to be one";
  finding.advice = "weld_tolerance = " + number_text(1.5 * finding.limit, k_advice_digits) + " when reading the file joins the ends of these edges";
  add_edges(survey, topology, std::move(finding), shorts, -1.0);
}

void add_coarse(const Survey& survey, const Topology& topology, double feature_angle, const std::vector<Suspect<HalfedgeId>>& coarse) {
  Finding finding{.kind = FindingKind::coarse,
                  .severity = Severity::note,
                  .value = worst(coarse, 1).front().badness / k_degree,
                  .limit = survey.request.limits.coarse_angle / k_degree,
                  .unit = "deg"};
  finding.text = count_of(static_cast<std::int64_t>(coarse.size()), "edge of the smooth surface bends", "edges of the smooth surface bend") + " by more than " +
                 number_text(finding.limit, k_text_digits) + " deg, up to " + number_text(finding.value, k_text_digits) + " deg (edges count as sharp above " +
                 number_text(feature_angle / k_degree, k_text_digits) + " deg): curvature is not resolved";
  finding.advice = "re-mesh the surface with curvature_angle = 12*deg; or, if these edges are meant to be sharp, feature_angle = " +
                   number_text(std::floor(finding.limit), k_advice_digits) + "*deg";
  add_edges(survey, topology, std::move(finding), coarse, 1.0 / k_degree);
}

}  // namespace

void survey_edges(const Survey& survey, const Topology& topology, double feature_angle) {
  const Column<TriangleId, Vec3> normals = unit_normals(survey.mesh, survey.context);
  const EdgeSuspects found = find_edges(survey, topology, normals, feature_angle);
  if (!found.folded.empty()) add_folds(survey, topology, normals, found.folded);
  if (!found.jumps.empty()) add_jumps(survey, topology, found.jumps);
  if (!found.shorts.empty()) add_shorts(survey, topology, found.shorts);
  if (!found.coarse.empty()) add_coarse(survey, topology, feature_angle, found.coarse);
}

}  // namespace sterna::volmesh
