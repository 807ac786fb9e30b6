#include "volmesh/inspect/survey.h"

#include <array>
#include <cmath>

#include "geom/base/number_text.h"

namespace sterna::volmesh {
namespace {

constexpr std::array<std::string_view, 3> k_severities = {"note", "warn", "error"};
constexpr std::array<std::string_view, 31> k_kinds = {"none",       "malformed",     "non_manifold",  "open",     "not_orientable", "crossing",   "refused",
                                                      "turned",     "repaired",      "unit",          "bodies",   "cavity",         "needle",     "fold",
                                                      "coarse",     "size_jump",     "short_edge",    "contact",  "hidden",         "visibility", "lowered",
                                                      "compressed", "collapsed",     "tall_first",    "thin_top", "thick_top",      "y_plus",     "thin_base",
                                                      "wake",       "not_looked_at", "many_triangles"};
constexpr std::string_view k_finding_field = "finding";

}  // namespace

std::string_view to_string(Severity severity) { return k_severities[static_cast<std::size_t>(severity)]; }
std::string_view to_string(FindingKind kind) { return k_kinds[static_cast<std::size_t>(kind)]; }

std::string count_of(std::int64_t n, const std::string& one, const std::string& many) { return std::to_string(n) + " " + (n == 1 ? one : many); }

std::string percent(double share) {
  constexpr double k_whole = 0.1;  ///< values above this are printed without decimals
  const double value = 100.0 * share;
  return (share >= k_whole ? std::to_string(std::lround(value)) : number_text(value, k_advice_digits)) + " %";
}

std::int64_t InspectReport::count(Severity severity) const {
  return std::count_if(findings.begin(), findings.end(), [&](const Finding& finding) { return finding.severity == severity; });
}

const Finding* InspectReport::find(FindingKind kind) const {
  const auto found = std::find_if(findings.begin(), findings.end(), [&](const Finding& finding) { return finding.kind == kind; });
  return found == findings.end() ? nullptr : &*found;
}

Point Survey::middle(TriangleId t) const {
  const auto [a, b, c] = corners(mesh, t);
  return (a + b + c) / 3.0;
}

void Survey::add(Finding finding, const std::vector<Suspect<TriangleId>>& suspects,
                 const std::function<FindingLocation(const Suspect<TriangleId>&)>& location_of) const {
  finding.count = static_cast<std::int64_t>(suspects.size());
  std::vector<TriangleId> where;
  for (const auto& s : suspects) where.push_back(s.id);
  for (const auto& s : worst(suspects, n_locations())) finding.locations.push_back(location_of(s));
  add_finding(report, std::move(finding), where);
}

void add_finding(InspectReport& report, Finding finding, const std::vector<TriangleId>& where) {
  auto field = std::find_if(report.fields.begin(), report.fields.end(), [](const TriMeshField& f) { return f.name == k_finding_field; });
  if (field == report.fields.end()) {
    report.fields.insert(report.fields.begin(),
                         {std::string(k_finding_field), "kind of the most severe finding", "", false, std::vector<float>(report.mesh.n_triangles(), 0.0f)});
    field = report.fields.begin();
  }
  const auto severity_of = [&](float code) {
    for (const Finding& other : report.findings)
      if (static_cast<float>(other.kind) == code) return static_cast<int>(other.severity);
    return -1;
  };
  const float code = static_cast<float>(finding.kind);
  std::array<int, k_kinds.size()> severities{};
  for (std::size_t i = 0; i < severities.size(); ++i) severities[i] = severity_of(static_cast<float>(i));
  for (const TriangleId t : where) {
    float& old = field->values[t.index()];
    if (old == 0.0f || severities[static_cast<std::size_t>(old)] < static_cast<int>(finding.severity)) old = code;
  }
  const auto is_before = [](const Finding& a, const Finding& b) { return a.severity != b.severity ? a.severity > b.severity : a.kind < b.kind; };
  report.findings.insert(std::upper_bound(report.findings.begin(), report.findings.end(), finding, is_before), std::move(finding));
}

WallMap::WallMap(const TriMesh& surface, Borrowed<const Domain> domain)
    : wall_(domain->wall), wall2surface_(&domain->wall2surface), vertex_(domain->wall.n_vertices()), n_vertices_(surface.n_vertices()) {
  for (const TriangleId t : wall_.triangles.ids())
    for (std::size_t k = 0; k < 3; ++k) vertex_[wall_.triangles[t][k]] = surface.triangles[triangle(t)][k];
}

std::vector<float> WallMap::field(const std::vector<double>& at_wall) const {
  std::vector<float> values(n_vertices_, std::numeric_limits<float>::quiet_NaN());
  for (const VertexId v : wall_.points.ids()) {
    const VertexId of_surface = vertex_.empty() ? v : vertex_[v];
    if (of_surface.is_valid()) values[of_surface.index()] = static_cast<float>(at_wall[v.index()]);
  }
  return values;
}

}  // namespace sterna::volmesh
