// Boxes, areas and volumes of models by part, and open edges; all of them also as text.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "geom/model/model_measures.h"
#include "scripting/values/models.h"

namespace sterna::scripting {
namespace {

/// Number of samples in each direction of a face, and along each edge, for boxes.
constexpr int k_box_samples = 12;

/// Returns the parameter box of the outer border of a face.
ParameterBox used_box(const Model& model, const ModelFace& face) {
  if (face.borders.empty() || face.borders.front().empty()) return face.surface->domain();
  Uv low{1e300, 1e300}, high{-1e300, -1e300};
  for (const EdgeUse& use : face.borders.front()) {
    const Interval range = model.edges[use.edge].range;
    for (int i = 0; i <= k_box_samples; ++i) {
      const Uv p = use.parameter->point(range.from + range.length() * i / k_box_samples);
      low = {std::min(low.u, p.u), std::min(low.v, p.v)};
      high = {std::max(high.u, p.u), std::max(high.v, p.v)};
    }
  }
  return {{low.u, high.u}, {low.v, high.v}};
}

/// Returns true if the face fills its parameter box, regardless of the number of edges of its sides: then points within the box are on the face.
bool is_whole(const Model& model, const ModelFace& face, const ParameterBox& box) {
  if (face.borders.size() != 1) return false;
  constexpr double k_on_side = 1e-6;  // relative to the box
  const auto is_at_end = [](double x, const Interval& range) {
    return std::min(std::abs(x - range.from), std::abs(x - range.to)) <= k_on_side * range.length();
  };
  for (const EdgeUse& use : face.borders.front()) {
    const Interval range = model.edges[use.edge].range;
    bool is_u = true, is_v = true;
    for (int i = 0; i <= k_box_samples; ++i) {
      const Uv p = use.parameter->point(range.from + range.length() * i / k_box_samples);
      is_u = is_u && is_at_end(p.u, box.u);
      is_v = is_v && is_at_end(p.v, box.v);
    }
    if (!is_u && !is_v) return false;
  }
  return true;
}

PartMeasures part_of(const BodyMeasures& body, std::string kind, const std::vector<FaceId>& faces, const Column<FaceId, FaceMeasures>& measures) {
  PartMeasures part{
      .name = body.name, .kind = std::move(kind), .n_faces = body.n_faces, .area = body.area, .volume = body.volume, .is_closed = body.has_volume};
  if (body.n_faces > 0) part.box = {body.box.min, body.box.max};
  for (const FaceId f : faces) part.projected_area += measures[f].projected_z;
  return part;
}

std::string part_text(const PartMeasures& part) {
  std::string text = fmt::format("{} {}, wetted area {:.6g} m^2, projected from above {:.6g} m^2", part.n_faces, part.n_faces == 1 ? "face" : "faces",
                                 part.area, part.projected_area);
  if (part.is_closed) text += fmt::format(", volume {:.6g} m^3", part.volume);
  if (!part.box.empty()) text += fmt::format(", box {} to {}", format_point(part.box.min), format_point(part.box.max));
  return text;
}

}  // namespace

Box box_of(const Model& model, FaceId f) {
  const ModelFace& face = model.faces[f];
  Box box;
  const ParameterBox used = used_box(model, face);
  const bool has_points_within = (face.borders.size() == 1 && face.borders.front().size() <= 4) || is_whole(model, face, used);
  for (int i = 0; i <= k_box_samples; ++i)
    for (int j = 0; j <= k_box_samples; ++j)
      if (has_points_within)
        box.add(face.surface->point({used.u.from + used.u.length() * i / k_box_samples, used.v.from + used.v.length() * j / k_box_samples}));
  for (const Border& border : face.borders)
    for (const EdgeUse& use : border) {
      const ModelEdge& edge = model.edges[use.edge];
      if (edge.is_degenerate()) box.add(model.corners[edge.start].point);
      else
        for (int i = 0; i <= k_box_samples; ++i) box.add(edge.curve->point(edge.range.from + edge.range.length() * i / k_box_samples));
    }
  return box;
}

Box box_of(const Model& model) {
  Box box;
  for (const FaceId f : model.faces.ids()) box.add(box_of(model, f));
  return box;
}

ModelReport measure_model(const ModelValue& value, const RunContext& context) {
  const Model& model = value.model;
  const ModelMeasures measures = model_measures(model, context);
  std::vector<FaceId> all;
  std::vector<std::vector<FaceId>> by_component(model.components.size());
  for (const FaceId f : model.faces.ids()) {
    all.push_back(f);
    by_component[model.faces[f].component.index()].push_back(f);
  }
  ModelReport report{.total = part_of(measures.total, {}, all, measures.faces)};
  for (const ComponentId c : model.components.ids())
    report.components.push_back(
        part_of(measures.components[c.index()], std::string(to_string(model.components[c].kind)), by_component[c.index()], measures.faces));
  for (const SolidId s : model.solids.ids()) report.solids.push_back(part_of(measures.solids[s.index()], {}, model.solids[s].faces, measures.faces));
  if (value.description)
    for (const Wing& wing : value.description->wings) report.wings.push_back(wing_reference(wing));
  else if (std::any_of(model.components.begin(), model.components.end(), [](const Component& c) { return c.kind == ComponentKind::wing; }))
    report.no_wings = value.without_description;
  return report;
}

std::vector<OpenEdge> open_edges(const Model& model) {
  std::vector<OpenEdge> result;
  const auto uses = uses_of_edges(model);
  for (const EdgeId e : free_edges(model)) {
    const ModelEdge& edge = model.edges[e];
    const ModelFace& face = model.faces[uses[e].front().face];
    OpenEdge open{.face = face.name, .component = model.components[face.component].name};
    constexpr int k_steps = 64;
    Point last = open.from = edge.curve->point(edge.range.from);
    for (int i = 1; i <= k_steps; ++i) {
      const Point next = edge.curve->point(edge.range.from + edge.range.length() * i / k_steps);
      open.length += distance(last, next);
      if (2 * i == k_steps) open.middle = next;
      last = next;
    }
    open.to = last;
    result.push_back(std::move(open));
  }
  return result;
}

std::string open_plane_text(const std::vector<OpenEdge>& open) {
  constexpr double k_in_plane = 1e-6;  // relative to the size of all open edges
  Box box;
  double length = 0.0;
  for (const OpenEdge& edge : open) {
    for (const Point& p : {edge.from, edge.middle, edge.to}) box.add(p);
    length += edge.length;
  }
  if (box.empty()) return {};
  for (std::size_t k = 0; k < 3; ++k) {
    if (box.max[k] - box.min[k] > k_in_plane * box.longest_side()) continue;
    const double at = 0.5 * (box.min[k] + box.max[k]);
    return fmt::format("the plane {} = {:.6g} only: {} {}, {:.4g} m", "xyz"[k], std::abs(at) <= k_in_plane * box.longest_side() ? 0.0 : at, open.size(),
                       open.size() == 1 ? "edge" : "edges", length);
  }
  return {};
}

std::string measures_text(const ModelReport& measures) {
  std::string text = "  total    " + part_text(measures.total);
  // If every component is a separate solid, one line describes both.
  const bool are_same = std::equal(measures.solids.begin(), measures.solids.end(), measures.components.begin(), measures.components.end(),
                                   [](const PartMeasures& a, const PartMeasures& b) { return a.name == b.name && a.is_closed == b.is_closed; });
  for (const PartMeasures& solid : measures.solids)
    if (!are_same) text += fmt::format("\n  solid    \"{}\", {}: {}", solid.name, solid.is_closed ? "closed" : "open", part_text(solid));
  for (const PartMeasures& part : measures.components) text += fmt::format("\n  part     \"{}\", {}: {}", part.name, part.kind, part_text(part));
  for (const WingReference& wing : measures.wings)
    text += fmt::format(
        "\n  wing     \"{}\": span {:.6g} m, area {:.6g} m^2, projected from above {:.6g} m^2, unrolled {:.6g} m^2, aspect ratio {:.4g}, mean chord geometric "
        "{:.6g} m, aerodynamic {:.6g} m from {}",
        wing.name, wing.span, wing.area, wing.projected_area, wing.unrolled_area, wing.aspect_ratio, wing.mean_geometric_chord, wing.mean_aerodynamic_chord,
        format_point(wing.aerodynamic_chord_start));
  if (!measures.no_wings.empty()) text += "\n  wing     no reference data, which only components defined as data have: " + measures.no_wings;
  return text;
}

namespace {

/// Returns true if the whole model lies in one plane of constant x, y or z. Its boundary then does not indicate symmetry.
bool is_flat_model(const Model& model) {
  constexpr double k_flat_share = 1e-6;  // relative to the longest side
  const Box box = box_of(model);
  const Vec3 side = box.max - box.min;
  return std::min({side.x, side.y, side.z}) <= k_flat_share * box.longest_side();
}

}  // namespace

std::string closedness_text(const Model& model, std::size_t limit) {
  const auto n_closed = std::count_if(model.solids.begin(), model.solids.end(), [](const ModelSolid& s) { return s.is_closed; });
  std::set<std::uint64_t> in_solids;
  for (const ModelSolid& solid : model.solids)
    for (const FaceId f : solid.faces) in_solids.insert(f.value());
  std::string text =
      fmt::format("{} closed {}, {} open, {} loose {}", n_closed, n_closed == 1 ? "solid" : "solids", static_cast<std::int64_t>(model.solids.size()) - n_closed,
                  model.faces.size() - in_solids.size(), model.faces.size() - in_solids.size() == 1 ? "face" : "faces");
  const std::vector<OpenEdge> open = open_edges(model);
  if (open.empty()) return text + "; no open edge";
  if (const std::string plane = is_flat_model(model) ? std::string() : open_plane_text(open); !plane.empty()) return text + "; open along " + plane;
  text += fmt::format("; {} open {}", open.size(), open.size() == 1 ? "edge" : "edges");
  for (std::size_t i = 0; i < std::min(limit, open.size()); ++i)
    text += fmt::format("\n  open     face \"{}\" of \"{}\": edge from {} over {} to {}, {:.4g} m long", open[i].face, open[i].component,
                        format_point(open[i].from), format_point(open[i].middle), format_point(open[i].to), open[i].length);
  if (open.size() > limit) text += fmt::format("\n  open     and {} more", open.size() - limit);
  return text;
}

}  // namespace sterna::scripting
