#include "scripting/values/fluid_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/cad/aircraft_union.h"
#include "geom/cad/fluid.h"
#include "geom/cad/refit.h"
#include "geom/mesh/mirror_gap.h"
#include "geom/model/analytic_surfaces.h"
#include "geom/model/model_builder.h"
#include "geom/model/model_measures.h"
#include "scripting/values/aircraft_model.h"
#include "surfmesh/model/model_facets.h"

namespace sterna::scripting {
namespace {

/// Tolerance of the splines for deformed surfaces before a boolean, as a fraction of the longest side; the same as in write_cad.
constexpr double k_refit_share = 1e-6;
/// Margin of a box as a fraction of a body's longest side: boxes from samples are too small by about a thousandth.
constexpr double k_box_margin = 0.01;
/// Corners within this distance of the plane of a face are in the plane; fraction of a tunnel's longest side.
constexpr double k_flat_share = 1e-9;

bool is_container(const Model& model, const ModelSolid& solid) {
  return solid.is_closed && std::all_of(solid.faces.begin(), solid.faces.end(),
                                        [&](FaceId f) { return model.components[model.faces[f].component].kind == ComponentKind::tunnel; });
}

/// Solids of tunnels, and the other solids. There is no result if the model has sheets or loose faces.
struct Solids {
  std::vector<Model> containers, bodies;
  bool is_all_closed = true;
};

Solids solids_of(const Model& model) {
  Solids result;
  std::size_t n_faces = 0;
  for (const ModelSolid& solid : model.solids) {
    n_faces += solid.faces.size();
    result.is_all_closed = result.is_all_closed && solid.is_closed;
  }
  result.is_all_closed = result.is_all_closed && n_faces == model.faces.size();
  if (!result.is_all_closed) return result;
  for (Model& part : cad::split_solids(model)) (is_container(part, part.solids.raw().front()) ? result.containers : result.bodies).push_back(std::move(part));
  return result;
}

std::string names_text(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return text;
}

/// A plane of a convex container: a point and the unit normal to the inside. planes_of() is empty if the container has other faces or corners.
struct Plane {
  Point at;
  Vec3 inward;
};
std::vector<Plane> planes_of(const Model& model, const ModelSolid& container) {
  std::vector<Plane> planes;
  std::vector<Point> points;
  for (const FaceId f : container.faces)
    for (const Border& border : model.faces[f].borders)
      for (const EdgeUse& use : border) {
        const ModelEdge& edge = model.edges[use.edge];
        if (edge.is_degenerate()) return {};
        for (const double share : {0.0, 0.25, 0.5, 0.75}) points.push_back(edge.curve->point(edge.range.from + share * (edge.range.to - edge.range.from)));
      }
  Box box;
  for (const Point& p : points) box.add(p);
  const double tolerance = k_flat_share * box.longest_side();
  for (const FaceId f : container.faces) {
    const ModelFace& face = model.faces[f];
    const ParameterBox domain = face.surface->domain();
    const Uv middle{0.5 * (domain.u.from + domain.u.to), 0.5 * (domain.v.from + domain.v.to)};
    if (!dynamic_cast<const PlaneSurface*>(face.surface.get())) return {};
    const SurfaceDerivatives d = face.surface->derivatives(middle);
    Plane plane{d.point, normalized(cross(d.du, d.dv))};
    const double side = dot(box.center() - plane.at, plane.inward);
    if (side < 0.0) plane.inward = -plane.inward;
    if (std::abs(side) <= tolerance || std::any_of(points.begin(), points.end(), [&](const Point& p) { return dot(p - plane.at, plane.inward) < -tolerance; }))
      return {};
    planes.push_back(plane);
  }
  return planes;
}

/// Returns a box that certainly contains a part: box_of() uses samples.
Box surely_around(const Model& model, const ModelSolid& solid) {
  Box box;
  for (const FaceId f : solid.faces) box.add(box_of(model, f));
  const double margin = k_box_margin * box.longest_side();
  box.min = box.min - Vec3{margin, margin, margin};
  box.max = box.max + Vec3{margin, margin, margin};
  return box;
}

bool boxes_meet(const Box& a, const Box& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (a.max[k] < b.min[k] || b.max[k] < a.min[k]) return false;
  return true;
}

/// Returns true if bounding boxes prove that no boolean is needed. There must be one convex container with plane faces and inward normals, and all other solids
/// must be closed, inside the container and separate from each other.
bool are_bodies_apart(const Model& model) {
  const ModelSolid* container = nullptr;
  std::vector<Box> boxes;
  std::size_t n_faces = 0;
  for (const SolidId s : model.solids.ids()) {
    const ModelSolid& solid = model.solids[s];
    n_faces += solid.faces.size();
    if (!solid.is_closed) return false;
    if (is_container(model, solid)) {
      if (container || solid_measures(model, s).volume >= 0.0) return false;
      container = &solid;
    } else {
      boxes.push_back(surely_around(model, solid));
    }
  }
  if (n_faces != model.faces.size() || !container || boxes.empty()) return false;
  const std::vector<Plane> planes = planes_of(model, *container);
  if (planes.empty()) return false;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const Point p{(corner & 1u) != 0 ? boxes[i].max.x : boxes[i].min.x, (corner & 2u) != 0 ? boxes[i].max.y : boxes[i].min.y,
                    (corner & 4u) != 0 ? boxes[i].max.z : boxes[i].min.z};
      if (std::any_of(planes.begin(), planes.end(), [&](const Plane& plane) { return dot(p - plane.at, plane.inward) <= 0.0; })) return false;
    }
    for (std::size_t k = 0; k < i; ++k)
      if (boxes_meet(boxes[i], boxes[k])) return false;
  }
  return true;
}

ModelValue as_fluid(ModelValue value) {
  value.description.reset();
  value.without_description = "it is the fluid in a tunnel";
  return value;
}

std::string inside_text(const std::vector<std::string>& names) { return names_text(names) + (names.size() == 1 ? " is" : " are") + " inside"; }

std::vector<std::string> names_of_bodies(const Model& model) {
  std::vector<std::string> names;
  for (const ModelSolid& solid : model.solids)
    if (!is_container(model, solid)) names.push_back(model.components[model.faces[solid.faces.front()].component].name);
  return names;
}

}  // namespace

void refit_for_cad(Model& model, const RunContext& context) {
  if (!cad::needs_refit(model)) return;
  cad::RefitReport refit;
  model = cad::refitted(model, k_refit_share * box_of(model).longest_side(), refit, context);
  context.info(
      fmt::format("{} deformed surfaces and {} curves became splines for OpenCASCADE, at most {:.3g} m away", refit.n_surfaces, refit.n_curves, refit.error));
}

bool has_container(const Model& model) {
  return std::any_of(model.solids.begin(), model.solids.end(), [&](const ModelSolid& solid) { return is_container(model, solid); });
}

ModelValue assemble_united(const std::vector<ModelHandle>& models, const RunContext& context) {
  ModelValue value = assemble(models, context);
  if (models.size() == 1) return value;
  Model for_cad = value.model;
  refit_for_cad(for_cad, context);
  Solids solids = solids_of(for_cad);
  if (!solids.is_all_closed) {
    context.info("the assembly has open surfaces: its models stay separate, even if they touch");
    return value;
  }
  const std::vector<Model> united = cad::unite_touching(solids.bodies, {}, context);
  if (united.size() == solids.bodies.size()) return value;
  context.info(fmt::format("assembly: {} solids, {} after touching solids were united", solids.bodies.size(), united.size()));
  Model all;
  for (const std::vector<Model>* parts : {&united, &std::as_const(solids.containers)})
    for (const Model& part : *parts) append(all, part);
  take_solids(for_cad, all, value);
  return value;
}

ModelValue fluid_of(ModelValue all, const RunContext& context) {
  if (!has_container(all.model)) return all;
  if (are_bodies_apart(all.model)) {  // the fluid is the tunnel minus cavities, so no face changes
    all.report = "fluid: no body is close to the tunnel's faces or to another body; " + inside_text(names_of_bodies(all.model));
    context.info(all.report);
    const Solids solids = solids_of(all.model);
    Model in_order = solids.containers.front();
    for (const Model& body : solids.bodies) append(in_order, body);
    take_solids(Model(all.model), in_order, all);
    return as_fluid(std::move(all));
  }
  Model for_cad = all.model;
  refit_for_cad(for_cad, context);
  Solids solids = solids_of(for_cad);
  if (!solids.is_all_closed) {
    const std::vector<OpenEdge> open = open_edges(all.model);
    ErrorInfo info{.code = ErrorCode::open_surface,
                   .attempted = "subtracting the model from its tunnel",
                   .problem = "the model has open surfaces",
                   .hint = "only closed bodies have an inside: read_cad{ ..., cap = true } closes flat openings"};
    for (const OpenEdge& edge : open)
      if (info.locations.size() < 5) info.locations.push_back({edge.middle, "open edge of face \"" + edge.face + "\""});
    info.n_locations = static_cast<std::int64_t>(open.size());
    throw Error(std::move(info));
  }
  if (solids.containers.size() > 1)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "subtracting the model from its tunnel",
                 .problem = fmt::format("there are {} tunnels", solids.containers.size()),
                 .hint = "give one closed container for the fluid"});
  if (solids.bodies.empty()) return all;
  std::vector<std::string> passing;  // "sting" through "outflow"
  const auto may_pass = [&](const cad::Overhang& overhang) {
    const bool is_declared = overhang.kind == ComponentKind::sting || std::ranges::any_of(all.through, [&](const std::string& pattern) {
                               return matches_glob(overhang.component, pattern) || matches_glob(overhang.face, pattern);
                             });
    if (const std::string text = "\"" + overhang.component + "\" through \"" + overhang.wall + "\""; is_declared && !std::ranges::count(passing, text))
      passing.push_back(text);
    return is_declared;
  };
  FluidDomain fluid = cad::fluid_domain(solids.containers.front(), solids.bodies, {}, context, may_pass);
  std::string text = fmt::format("fluid: {:.6g} m^3 of {:.6g} m^3", fluid.report.volume, fluid.report.container_volume);
  if (!passing.empty()) {
    text += "; passes: ";
    for (std::size_t i = 0; i < passing.size(); ++i) text += (i == 0 ? "" : ", ") + passing[i];
  } else if (!fluid.report.cut.empty())
    text += "; " + names_text(fluid.report.cut) + (fluid.report.cut.size() == 1 ? " passes" : " pass") + " through the tunnel's faces";
  if (!fluid.report.inside.empty()) text += "; " + inside_text(fluid.report.inside);
  for (const UniteTry& attempt : fluid.report.tries)
    if (!attempt.problem.empty()) text += fmt::format("\n  tolerance {:.3g} m was not enough: {}", attempt.tolerance, attempt.problem);
  context.info(text);
  take_solids(for_cad, fluid.model, all);
  all.report = text;
  return as_fluid(std::move(all));
}

namespace {

/// Reports asymmetry in the same way as half_of does for surfaces.
void report_asymmetry(const Model& model, const HalfModelOptions& options, const RunContext& context) {
  constexpr double k_tolerance = 5e-5, k_clear = 4.0;  // k_tolerance is the distance of facets from the surface (their corners are on it), relative to the
                                                       // longest side; gaps above k_clear * k_tolerance are reported
  const surfmesh::ModelFacets facets = surfmesh::facets_of(model, {.tolerance = k_tolerance}, context);
  TriMesh drawn;
  drawn.patches.push_back({.name = "model"});
  for (const Point& p : facets.points) drawn.points.push_back(p);
  for (const auto& t : facets.triangles) {
    drawn.triangles.push_back({VertexId(t[0]), VertexId(t[1]), VertexId(t[2])});
    drawn.triangle_patch.push_back(PatchId(0u));
  }
  if (drawn.triangles.empty()) return;
  const MirrorGap gap = mirror_gap(drawn, static_cast<std::size_t>(options.axis.front() - 'x'), options.at, 0.0, context);
  if (gap.distance <= k_clear * k_tolerance * bounding_box(drawn).longest_side()) return;
  context.warn(describe_asymmetry(gap, fmt::format("{} = {:g} m", options.axis, options.at)));
}

}  // namespace

ModelValue half_of_model(const ModelValue& whole, const HalfModelOptions& options, const RunContext& context) {
  ModelValue value = whole;
  if (free_edges(value.model).empty()) refit_for_cad(value.model, context);
  HalfModel half = cad::half_model(value.model, options, context);
  const HalfModelReport& r = half.report;
  if (!r.was_half) report_asymmetry(whole.model, options, context);
  value.model = std::move(half.model);
  value.parts.clear();
  value.report = r.was_half
                     ? "the model is a half model already, unchanged"
                     : fmt::format("half at {} = {:g}: {} faces cut{}", options.axis, options.at, r.n_faces_cut, r.was_united ? ", after the union" : "");
  if (r.n_solids_left_out > 0) value.report += fmt::format(", {} solids of the other half removed", r.n_solids_left_out);
  if (r.n_faces_split > 0) value.report += fmt::format(", {} closed faces split at their seams", r.n_faces_split);
  if (r.n_flat_faces > 0) value.report += fmt::format(", {} faces in the plane removed", r.n_flat_faces);
  value.report += fmt::format("; boundary of {} edges, {:.4g} m, moved by at most {:.3g} m into the plane", r.n_border_edges, r.border_length, r.largest_shift);
  context.info(value.report);
  value.description.reset();
  value.without_description = "it is half of a model";
  return value;
}

}  // namespace sterna::scripting
