// This is the driver. It first inspects the shape, then the layer on the walls as volume_mesh would build it.
#include "volmesh/inspect/inspect.h"

#include <memory>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "volmesh/envelope/feature_angle.h"
#include "volmesh/flow/boundary_layer.h"
#include "volmesh/inspect/survey.h"

namespace sterna::volmesh {
namespace {

/// Placeholder for the first height in steps that require one but do not depend on it, as a fraction of the body length.
constexpr double k_placeholder_height = 1e-6;

InspectReport start(const TriMesh& surface) {
  InspectReport report;
  report.mesh = surface;
  Box box;
  for (const Point& p : surface.points)
    if (is_finite(p)) box.add(p);
  report.length = box.empty() ? 0.0 : box.longest_side();
  report.fields.push_back({"finding", "kind of the most severe finding", "", false, std::vector<float>(surface.n_triangles(), 0.0f)});
  return report;
}

void leave_out(const Survey& survey, const std::string& what, const std::string& why, const std::string& advice) {
  add_finding(survey.report,
              {.kind = FindingKind::not_looked_at, .severity = Severity::note, .text = "not checked: " + what + ", because " + why, .advice = advice}, {});
}

bool has_first_height(const MeshCase& options) {
  return !is_automatic(options.envelope.first_height) || options.first_heights ||
         std::ranges::any_of(options.patches, [](const Rule& rule) { return is_set(rule, "first_height"); });
}

std::vector<TriangleId> triangles_at_holes(const Survey& survey) {
  const Topology topology(survey.mesh, survey.context);
  std::vector<TriangleId> list;
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i)
    if (const HalfedgeId h(static_cast<std::uint64_t>(i)); topology.is_boundary(h)) list.push_back(triangle_of(h));
  return list;
}

/// Adds a finding for an error that volume_mesh would throw at its start.
void add_refusal(const Survey& survey, const Error& error) {
  const ErrorInfo& info = error.info();
  Finding finding{.kind = FindingKind::refused,
                  .severity = Severity::error,
                  .count = error.n_locations(),
                  .text = "volume_mesh rejects the surface: " + info.problem,
                  .advice = info.hint};
  std::vector<TriangleId> where;
  if (info.code == ErrorCode::open_surface) {
    where = triangles_at_holes(survey);  // one triangle at each edge
    finding.kind = FindingKind::open;
    finding.count = static_cast<std::int64_t>(where.size());
  }
  for (std::size_t i = 0; i < std::min(info.locations.size(), survey.n_locations()); ++i)
    finding.locations.push_back({info.locations[i].position, {}, 0.0, info.locations[i].what});
  add_finding(survey.report, std::move(finding), where);
}

std::string first_height_advice(const Survey& survey) {
  if (!survey.request.flow)
    return "first_height = " + number_text(k_placeholder_height * survey.report.length, 1) +
           " or similar (--first-height); y_plus{} computes first_height from the flow";
  const FirstHeight first = first_height({.y_plus = survey.request.limits.wanted_y_plus}, *survey.request.flow);
  return "first_height = " + number_text(first.height, k_advice_digits) + " (" + describe(first) + ")";
}

/// Returns the walls with their outer boundary, as volume_mesh makes them. Returns null if volume_mesh rejects them; the rejection is reported.
std::unique_ptr<LayerDomain> layer_domain_of(const Survey& survey, const MeshCase& options) {
  try {
    return std::make_unique<LayerDomain>(survey.mesh, options, survey.context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled || error.code() == ErrorCode::internal) throw;
    if (error.code() != ErrorCode::self_intersection || survey_crossings(survey)) add_refusal(survey, error);
    return nullptr;
  }
}

/// Runs the checks that need no layer. Used for a surface that has no walls with layers.
void survey_shape(const Survey& survey) {
  const LayerBase base(survey.mesh, survey.context);
  const WallMap map(survey.mesh);
  survey_edges(survey, base.topology, feature_angle_of(base, survey.request.volume.envelope, survey.context));
  survey_visibility(survey, base, map);
  if (!survey.report.find(FindingKind::crossing)) survey_contacts(survey, base, Collider(base, nullptr, survey.context), map);
}

/// Returns the topology of the surface, or nothing if it equals that of the walls.
std::optional<Topology> topology_beside(const TriMesh& mesh, const LayerDomain* layer_domain, const RunContext& context) {
  if (layer_domain && layer_domain->domain.wall.triangles == mesh.triangles) return std::nullopt;
  return Topology(mesh, context);
}

}  // namespace

InspectReport inspect_triangles(const TriMesh& triangles, const InspectRequest& request, const RunContext& context) {
  InspectReport report = start(triangles);
  const Survey survey{report.mesh, request, context, report};
  survey_unit(survey);
  survey_slivers(survey);
  leave_out(survey, "crossings, folds, growth directions, gaps and layer heights", "the triangles could not be joined into a surface",
            "repair the findings of severity error first");
  return report;
}

InspectReport inspect_wall(const TriMesh& surface, const InspectRequest& request, const RunContext& context) {
  InspectReport report = start(surface);
  const TriMesh& mesh = report.mesh;
  const Survey survey{mesh, request, context, report};
  survey_unit(survey);
  survey_y_plus(survey);
  survey_slivers(survey);
  context.progress(0.1);
  const bool is_known = has_first_height(request.volume);
  MeshCase options = request.volume;
  options.needles.split_needles = 0.0;  // sliver triangles are not split, because findings refer to the given surface
  if (!is_known) options.envelope.first_height = k_placeholder_height * report.length;
  const std::unique_ptr<LayerDomain> layer_domain = layer_domain_of(survey, options);
  context.progress(0.5);
  const std::optional<Topology> own = topology_beside(mesh, layer_domain.get(), context);
  const Topology& topology = own ? *own : layer_domain->base.topology;
  report.is_closed = topology.n_boundary_halfedges() == 0;
  survey_bodies(survey, topology);
  if (!layer_domain) {
    if (report.find(FindingKind::open)) survey_crossings(survey);
    survey_shape(survey);
    leave_out(survey, "gaps and heights of the layer", "volume_mesh rejects the surface", "repair the findings of severity error first");
    return report;
  }
  const WallMap map(mesh, layer_domain->domain);
  survey_edges(survey, topology, layer_domain->options.envelope.feature_angle);
  survey_visibility(survey, layer_domain->base, map);
  survey_contacts(survey, layer_domain->base, layer_domain->collider, map);
  context.progress(0.7);
  if (!is_known) {
    leave_out(survey, "layer heights and their limits", "no first_height was given", first_height_advice(survey));
    return report;
  }
  survey_cells(survey, *layer_domain);
  survey_bases(survey, *layer_domain);
  survey_wake(survey);
  survey_heights(survey, *layer_domain);
  context.progress(1.0);
  return report;
}

}  // namespace sterna::volmesh
