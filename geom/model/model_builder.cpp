#include "geom/model/model_builder.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "geom/base/error.h"
#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/face_quadrature.h"
#include "geom/model/model_measures.h"
#include "geom/model/nurbs_curve.h"
#include "geom/model/nurbs_tools.h"

namespace sterna {
namespace {

/// Largest distance of an edge from its surface, relative to the size, if both come from the same numbers. It covers the rounding of evaluators.
constexpr double k_off_surface = 1e-9;
/// Allowed distance of a planar border from its plane, relative to its size. It covers the rounding of rotations.
constexpr double k_off_plane = 1e-9;

[[noreturn]] void refuse_model(ErrorCode code, const std::string& problem, std::vector<ErrorLocation> locations = {}) {
  throw Error({.code = code, .attempted = "building a model", .problem = problem, .locations = std::move(locations)});
}

Point at_part(const ModelEdge& edge, double part) { return edge.curve->point(edge.range.from + part * edge.range.length()); }

/// Evaluates the curve given by one row of poles and weights; its point is one pole of the parameter line.
struct BuilderRow {
  std::vector<Point> poles;
  std::vector<double> weights;
};

CurvePtr curve_through_rows(const std::vector<BuilderRow>& rows, int row_degree, const std::vector<double>& row_knots, double at, int degree,
                            const std::vector<double>& knots) {
  NurbsCurveForm<Point> line;
  line.degree = degree;
  line.knots = knots;
  for (const BuilderRow& row : rows) {
    if (row.weights.empty()) {
      line.poles.push_back(NurbsCurve({row_degree, row_knots, row.poles, {}}).point(at));
      continue;
    }
    // Homogeneous coordinates are used, with the weight as a separate spline.
    std::vector<Point> weights, weighted;
    for (std::size_t i = 0; i < row.poles.size(); ++i) {
      weights.push_back({row.weights[i], 0.0, 0.0});
      weighted.push_back(row.weights[i] * row.poles[i]);
    }
    const double w = NurbsCurve({row_degree, row_knots, weights, {}}).point(at).x;
    line.weights.push_back(w);
    line.poles.push_back(NurbsCurve({row_degree, row_knots, weighted, {}}).point(at) / w);
  }
  return std::make_shared<NurbsCurve>(std::move(line));
}

}  // namespace

CurvePtr line_of_constant_u(const NurbsSurfaceForm& form, double at) { return line_of_constant_v(exchanged(form), at); }

CurvePtr line_of_constant_v(const NurbsSurfaceForm& form, double at) {
  std::vector<BuilderRow> rows(form.n_u);
  for (std::size_t i = 0; i < form.n_u; ++i)
    for (std::size_t j = 0; j < form.n_v; ++j) {
      rows[i].poles.push_back(form.poles[i * form.n_v + j]);
      if (!form.weights.empty()) rows[i].weights.push_back(form.weights[i * form.n_v + j]);
    }
  return curve_through_rows(rows, form.degree_v, form.knots_v, at, form.degree_u, form.knots_u);
}

ModelBuilder::ModelBuilder(Component component) { component_ = model_.components.push_back(std::move(component)); }

CornerId ModelBuilder::corner(const Point& point) { return model_.corners.push_back({.point = point}); }

EdgeId ModelBuilder::edge(CurvePtr curve, Interval range, CornerId start, CornerId end, std::string name) {
  return model_.edges.push_back({.curve = std::move(curve), .range = range, .start = start, .end = end, .name = std::move(name)});
}

EdgeId ModelBuilder::straight_edge(CornerId start, CornerId end, std::string name) {
  const CurvePtr line = segment(model_.corners[start].point, model_.corners[end].point);
  return edge(line, line->domain(), start, end, std::move(name));
}

SplitCurve ModelBuilder::split_curve(CurvePtr curve, std::vector<double> at, CornerId first, CornerId last, const std::string& name) {
  SplitCurve split{std::move(curve), std::move(at), {first}, {}};
  for (std::size_t i = 1; i < split.at.size(); ++i) {
    split.corners.push_back(i + 1 == split.at.size() ? last : corner(split.curve->point(split.at[i])));
    split.edges.push_back(edge(split.curve, {split.at[i - 1], split.at[i]}, split.corners[i - 1], split.corners[i], name));
  }
  return split;
}

EdgeId ModelBuilder::pole(CornerId at) { return model_.edges.push_back({.range = {0.0, 1.0}, .start = at, .end = at}); }

EdgeUse ModelBuilder::use_along(const Surface& surface, EdgeId id, Uv from, Uv to, const std::string& what) {
  ModelEdge& edge = model_.edges[id];
  if (edge.is_degenerate()) return {id, false, parameter_segment(from, to, edge.range)};
  const auto on_side = [&](double part) { return surface.point(from + part * (to - from)); };
  constexpr double k_probe = 1.0 / 3.0;  // also distinguishes the directions of closed edges
  const bool is_reversed = distance(at_part(edge, 1.0 - k_probe), on_side(k_probe)) < distance(at_part(edge, k_probe), on_side(k_probe));
  double off = 0.0, size = 0.0;
  Point worst;
  for (int i = 0; i <= 12; ++i) {
    const double part = i / 12.0;
    const Point on_edge = at_part(edge, is_reversed ? 1.0 - part : part);
    size = std::max({size, distance(on_edge, at_part(edge, 0.0)), norm(on_edge)});
    if (const double d = distance(on_edge, on_side(part)); d > off) {
      off = d;
      worst = on_edge;
    }
  }
  if (off > k_off_surface * size)
    refuse_model(ErrorCode::internal, what + ": an edge is " + std::to_string(off) + " m off the side whose border it is",
                 {{worst, edge.name.empty() ? "edge" : edge.name}});
  edge.tolerance = std::max(edge.tolerance, off);
  for (const CornerId c : {edge.start, edge.end}) model_.corners[c].tolerance = std::max(model_.corners[c].tolerance, off);
  return {id, is_reversed, is_reversed ? parameter_segment(to, from, edge.range) : parameter_segment(from, to, edge.range)};
}

FaceId ModelBuilder::patch(SurfacePtr surface, const ParameterBox& box, const std::array<EdgeId, 4>& sides, FaceRole role, const std::string& name) {
  const std::array<Uv, 5> corners{{{box.u.from, box.v.from}, {box.u.to, box.v.from}, {box.u.to, box.v.to}, {box.u.from, box.v.to}, {box.u.from, box.v.from}}};
  std::vector<Side> around;
  for (std::size_t i = 0; i < 4; ++i) around.push_back({sides[i], corners[i], corners[i + 1]});
  return face(std::move(surface), around, role, name);
}

FaceId ModelBuilder::face(SurfacePtr surface, const std::vector<Side>& sides, FaceRole role, const std::string& name) {
  Border border;
  for (std::size_t i = 0; i < sides.size(); ++i)
    border.push_back(
        use_along(*surface, sides[i].edge, sides[i].from, sides[i].to, name + " (" + std::string(to_string(role)) + "), side " + std::to_string(i)));
  return model_.faces.push_back({.surface = std::move(surface), .borders = {std::move(border)}, .component = component_, .role = role, .name = name});
}

FaceId ModelBuilder::plane(const std::vector<EdgeId>& border, FaceRole role, const std::string& name, const std::vector<EdgeId>& hole) {
  std::vector<Point> samples;
  const auto chained = [&](const std::vector<EdgeId>& edges) {
    std::vector<bool> is_reversed;
    const ModelEdge& first = model_.edges[edges.front()];
    const ModelEdge& second = model_.edges[edges[1 % edges.size()]];
    CornerId at = edges.size() > 1 && (first.start == second.start || first.start == second.end) && !(edges.size() == 2) ? first.end : first.start;
    for (const EdgeId id : edges) {
      const ModelEdge& edge = model_.edges[id];
      if (edge.start != at && edge.end != at)
        refuse_model(ErrorCode::internal, name + ": the edges of a planar face are not connected end to end", {{model_.corners[at].point, "end of an edge"}});
      is_reversed.push_back(edge.start != at);
      at = is_reversed.back() ? edge.start : edge.end;
      constexpr int k_samples = 64;
      for (int i = 0; i < k_samples; ++i)
        samples.push_back(at_part(edge, is_reversed.back() ? 1.0 - static_cast<double>(i) / k_samples : static_cast<double>(i) / k_samples));
    }
    return is_reversed;
  };
  const std::vector<bool> outer = chained(border);
  Vec3 area;  // twice the vector area of the border
  Point middle;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    area += cross(samples[i] - samples[0], samples[(i + 1) % samples.size()] - samples[0]);
    middle += samples[i] / static_cast<double>(samples.size());
  }
  if (!(norm(area) > 0.0)) refuse_model(ErrorCode::bad_argument, name + ": a planar face has no area", {{middle, "here"}});
  const std::vector<bool> inner = hole.empty() ? std::vector<bool>{} : chained(hole);
  const Frame frame = frame_along(middle, area);
  double size = 0.0;
  ParameterBox box{{0.0, 0.0}, {0.0, 0.0}};
  for (const Point& p : samples) {
    const Vec3 local = frame.local(p);
    size = std::max(size, norm(local));
    box = {{std::min(box.u.from, local.x), std::max(box.u.to, local.x)}, {std::min(box.v.from, local.y), std::max(box.v.to, local.y)}};
  }
  for (const Point& p : samples)
    if (std::abs(frame.local(p).z) > k_off_plane * std::max(size, norm(p)))
      refuse_model(ErrorCode::bad_argument, name + ": the border of a flat end is not planar, " + std::to_string(frame.local(p).z) + " m off its plane",
                   {{p, "here"}});
  const double margin = 0.05 * size;  // edges extend slightly beyond the box of samples
  box = {{box.u.from - margin, box.u.to + margin}, {box.v.from - margin, box.v.to + margin}};
  const auto flat = [&](const std::vector<EdgeId>& edges, const std::vector<bool>& is_reversed) {
    Border uses;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const ModelEdge& edge = model_.edges[edges[i]];
      const std::optional<NurbsCurveForm<Point>> form = part_of(edge.curve, edge.range)->exact_nurbs();
      ParameterCurvePtr parameter;
      if (form) {
        NurbsCurveForm<Uv> projected{form->degree, form->knots, {}, form->weights};
        for (const Point& p : form->poles) projected.poles.push_back({frame.local(p).x, frame.local(p).y});
        parameter = std::make_shared<NurbsParameterCurve>(std::move(projected));
      } else if (const auto* arc = dynamic_cast<const EllipseCurve*>(edge.curve.get())) {
        const auto uv = [&](const Vec3& d) { return Uv{dot(d, frame.x), dot(d, frame.y)}; };
        parameter = std::make_shared<ParameterArc>(uv(arc->centre() - frame.origin), uv(arc->x()), uv(arc->y()), edge.range);
      } else {
        refuse_model(ErrorCode::internal, name + ": an edge of a planar face has no exact projection");
      }
      uses.push_back({edges[i], is_reversed[i], std::move(parameter)});
    }
    return uses;
  };
  std::vector<Border> borders{flat(border, outer)};
  if (!hole.empty()) borders.push_back(flat(hole, inner));
  return model_.faces.push_back(
      {.surface = std::make_shared<PlaneSurface>(frame, box), .borders = std::move(borders), .component = component_, .role = role, .name = name});
}

Model ModelBuilder::closed_solid(const std::string& name) {
  ModelSolid solid{.name = name, .faces = {}, .is_closed = true};
  for (const FaceId f : model_.faces.ids()) solid.faces.push_back(f);
  const SolidId id = model_.solids.push_back(std::move(solid));
  orient_outwards(model_, id);
  return std::move(model_);
}

namespace {

/// Smallest volume, as a fraction of area times reach, whose sign can be determined from few samples. The largest error of this fraction among the aircraft of
/// the tests is 8e-4, for a pylon with kinks; most errors are 1e-5. Bodies have fractions of some hundredths, slender wings 7e-3. Smaller volumes are
/// integrated to rounding.
constexpr double k_plain_share = 5e-3;

/// Returns the volume of a solid with consistently oriented faces; the sign is correct, the value is accurate to rounding only if the sign is in doubt.
double signed_volume(const Model& model, const ModelSolid& solid) {
  Vec3 corners;
  std::size_t n_corners = 0;
  for (const FaceId f : solid.faces)
    for (const Border& border : model.faces[f].borders)
      for (const EdgeUse& u : border) {
        corners += model.corners[model.edges[u.edge].start].point - Point{};
        ++n_corners;
      }
  const Point about = Point{} + corners / static_cast<double>(n_corners);
  double volume = 0.0, scale = 0.0;
  for (const FaceId f : solid.faces) {
    const FaceQuadrature q = integrate_face_roughly(model, f, about);
    volume += model.faces[f].is_reversed ? -q.sums.volume : q.sums.volume;
    scale += q.sums.area * std::max(distance(q.low, about), distance(q.high, about));
  }
  if (std::abs(volume) > k_plain_share * scale) return volume;
  volume = 0.0;
  for (const FaceId f : solid.faces) volume += face_measures(model, f).volume;
  return volume;
}

}  // namespace

void orient_outwards(Model& model, SolidId solid_id) {
  const ModelSolid& solid = model.solids[solid_id];
  const Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(model);
  const auto use = [&](const EdgeUseLocation& location) -> const EdgeUse& { return model.faces[location.face].borders[location.border][location.location]; };
  for (const FaceId f : solid.faces)
    for (const Border& border : model.faces[f].borders)
      for (const EdgeUse& u : border)
        if (const ModelEdge& edge = model.edges[u.edge]; !edge.is_degenerate() && uses[u.edge].size() != 2)
          refuse_model(ErrorCode::internal,
                       "solid '" + solid.name + "' is not closed: an edge of face '" + model.faces[f].name + "' is used " +
                           std::to_string(uses[u.edge].size()) + " times instead of twice",
                       {{at_part(edge, 0.5), edge.name.empty() ? "middle of the edge" : edge.name}});
  Column<FaceId, std::uint8_t> is_done(model.faces.size(), 0);
  std::deque<FaceId> queue{solid.faces.front()};
  is_done[queue.front()] = 1;
  while (!queue.empty()) {
    const FaceId f = queue.front();
    queue.pop_front();
    for (const Border& border : model.faces[f].borders)
      for (const EdgeUse& u : border) {
        if (model.edges[u.edge].is_degenerate()) continue;
        const std::vector<EdgeUseLocation>& pair = uses[u.edge];
        if (pair[0].face == pair[1].face) continue;  // a seam
        const EdgeUseLocation& other = pair[0].face == f ? pair[1] : pair[0];
        ModelFace& neighbour = model.faces[other.face];
        const bool target =
            u.is_reversed != model.faces[f].is_reversed ? use(other).is_reversed : !use(other).is_reversed;  // the effective directions must differ
        if (!is_done[other.face]) {
          neighbour.is_reversed = target;
          is_done[other.face] = 1;
          queue.push_back(other.face);
        } else if (neighbour.is_reversed != target) {
          refuse_model(ErrorCode::internal,
                       "solid '" + solid.name + "': faces '" + model.faces[f].name + "' and '" + neighbour.name + "' cannot be oriented alike",
                       {{at_part(model.edges[u.edge], 0.5), "their edge"}});
        }
      }
  }
  for (const FaceId f : solid.faces)
    if (!is_done[f]) refuse_model(ErrorCode::internal, "solid '" + solid.name + "' is not in one piece: face '" + model.faces[f].name + "' has no neighbour");
  const double volume = signed_volume(model, solid);
  if (volume == 0.0) refuse_model(ErrorCode::internal, "solid '" + solid.name + "' has no volume");
  if (volume < 0.0)
    for (const FaceId f : solid.faces) model.faces[f].is_reversed = !model.faces[f].is_reversed;
}

void turn_inside_out(Model& model) {
  for (ModelFace& face : model.faces) face.is_reversed = !face.is_reversed;
  model.shape.reset();
}

void append(Model& model, const Model& part) {
  const auto shift = [](auto id, std::size_t by) { return id.is_valid() ? decltype(id)(static_cast<std::uint64_t>(id.index() + by)) : id; };
  const std::size_t n_corners = model.corners.size(), n_edges = model.edges.size(), n_faces = model.faces.size(), n_components = model.components.size();
  for (const Component& c : part.components) model.components.push_back(c);
  for (const ModelCorner& c : part.corners) model.corners.push_back(c);
  for (ModelEdge e : part.edges) {
    e.start = shift(e.start, n_corners);
    e.end = shift(e.end, n_corners);
    model.edges.push_back(std::move(e));
  }
  for (ModelFace f : part.faces) {
    f.component = shift(f.component, n_components);
    for (Border& border : f.borders)
      for (EdgeUse& use : border) use.edge = shift(use.edge, n_edges);
    model.faces.push_back(std::move(f));
  }
  for (ModelSolid s : part.solids) {
    for (FaceId& f : s.faces) f = shift(f, n_faces);
    model.solids.push_back(std::move(s));
  }
  model.shape.reset();
}

}  // namespace sterna
