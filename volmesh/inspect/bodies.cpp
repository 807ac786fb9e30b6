// Connected parts of the surface: finds the number of bodies, and bodies inside the solid of another body.
#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "volmesh/inspect/survey.h"

namespace sterna::volmesh {
namespace {

struct BodyPart {
  TriangleId first;  ///< lowest triangle of the part
  std::int64_t n_triangles = 0;
  double volume = 0.0;  ///< m^3, signed; negative if the normals point inwards
  Box box;
  bool is_open = false;
};

std::vector<BodyPart> parts_of(const TriMesh& mesh, const Topology& topology, const Components& components) {
  std::vector<BodyPart> parts(components.count);
  const Point origin = bounding_box(mesh).center();
  for (const TriangleId t : mesh.triangles.ids()) {
    BodyPart& part = parts[components.component[t]];
    if (part.n_triangles++ == 0) part.first = t;
    const auto [a, b, c] = corners(mesh, t);
    part.volume += tet_volume(origin, a, b, c);
    for (const Point& p : {a, b, c}) part.box.add(p);
    for (int k = 0; k < 3; ++k) part.is_open |= topology.is_boundary(halfedge(t, k));
  }
  return parts;
}

std::vector<TriangleId> triangles_of(const Components& components, const std::vector<BodyPart>& parts, auto&& is_meant) {
  std::vector<TriangleId> list;
  for (const TriangleId t : components.component.ids())
    if (is_meant(parts[components.component[t]])) list.push_back(t);
  return list;
}

}  // namespace

void survey_bodies(const Survey& survey, const Topology& topology) {
  const TriMesh& mesh = survey.mesh;
  const Components components = connected_components(mesh, topology);
  const std::vector<BodyPart> parts = parts_of(mesh, topology, components);
  survey.report.n_bodies = components.count;
  // The part that encloses the fluid also has inward normals. Its bounding box equals that of the whole surface.
  const Box all = bounding_box(mesh);
  const auto encloses_all = [&](const BodyPart& part) { return part.box.min == all.min && part.box.max == all.max; };
  const auto is_cavity = [&](const BodyPart& part) { return !part.is_open && part.volume < 0.0 && !encloses_all(part); };
  std::int64_t n_cavities = 0;
  Finding cavities{.kind = FindingKind::cavity, .severity = Severity::warn};
  Finding bodies{.kind = FindingKind::bodies, .severity = Severity::note, .count = static_cast<std::int64_t>(parts.size())};
  for (const BodyPart& part : parts) {
    const FindingLocation location{part.box.center(), survey.patch_of(part.first), part.volume,
                                   "part of " + count_of(part.n_triangles, "triangle", "triangles") + ", " + number_text(part.volume, k_text_digits) + " m^3"};
    n_cavities += is_cavity(part);
    if (is_cavity(part) && cavities.locations.size() < survey.n_locations()) cavities.locations.push_back(location);
    if (bodies.locations.size() < survey.n_locations()) bodies.locations.push_back(location);
  }
  if (n_cavities > 0) {
    cavities.count = n_cavities;
    cavities.text =
        count_of(n_cavities, "part lies", "parts lie") + " inside another solid part: the space inside is a cavity that the outer flow does not reach";
    cavities.advice = "leave the inner part out of the file; unite overlapping bodies with `sterna union`";
    add_finding(survey.report, std::move(cavities), triangles_of(components, parts, is_cavity));
  }
  if (parts.size() < 2) return;
  bodies.unit = "m^3";
  bodies.text = "the surface has " + std::to_string(parts.size()) + " parts that are not connected";
  bodies.advice = "no action if the parts are meant to be separate; unite parts that touch or cross with `sterna union`";
  add_finding(survey.report, std::move(bodies), {});
}

}  // namespace sterna::volmesh
