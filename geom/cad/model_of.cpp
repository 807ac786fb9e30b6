// Converts OpenCASCADE's topology to the columns of a Model. Steps: collect the faces of every part once; give every edge its curves; number corners, edges and
// borders by identity (IsSame); take names from labels, else from the parts.
#include <BRepLib.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <ShapeAnalysis.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>

#include <algorithm>
#include <limits>
#include <map>

#include "geom/cad/occt_geometry.h"
#include "geom/cad/occt_shape.h"

namespace sterna::cad {
namespace {

/// Largest distance between an edge's curve and its image in a face that is accepted without OpenCASCADE's improvement, metres: the resolution of OpenCASCADE
/// (Precision::Confusion).
constexpr double k_same_parameter = 1e-7;

/// Intervals of an edge at whose ends the distance to its faces is measured; OpenCASCADE's own check uses 23 points.
constexpr int k_tolerance_samples = 24;

Point model_point(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

[[noreturn]] void fail(const std::string& attempted, const std::string& problem, const TopoDS_Shape& at) {
  throw Error({.code = ErrorCode::geometry_failed, .attempted = attempted, .problem = problem, .locations = {{location_of(at), problem}}});
}

/// An oriented edge of a wire, with its ends in space and in the parameters of the face.
struct WireEdge {
  TopoDS_Edge edge;
  TopoDS_Vertex from, to;
  gp_Pnt2d uv_from, uv_to;
};

class ModelBuilder {
 public:
  ModelBuilder(const LabelledShape& labelled, const std::string& attempted, const RunContext& context)
      : labelled_(labelled), attempted_(attempted), context_(context) {}

  Model build() {
    content_->shape = compound_of(labelled_.parts);
    BRepLib::BuildCurves3d(content_->shape);
    BRepLib::SameParameter(content_->shape, k_same_parameter);
    for (const ShapePart& part : labelled_.parts) add_part(part);
    model_.shape = std::make_shared<const CadShape>(std::move(content_));
    return std::move(model_);
  }

 private:
  void add_part(const ShapePart& part) {
    const ComponentId component = component_of(!part.component.empty() ? part.component : part.name);
    const auto add_solid = [&](const TopoDS_Shape& shape) {
      ModelSolid solid{.name = part.name.empty() ? model_.components[component].name : part.name, .faces = {}, .is_closed = false};
      for (TopExp_Explorer f(shape, TopAbs_FACE); f.More(); f.Next()) {
        const FaceId id = add_face(TopoDS::Face(f.Current()), part, component);
        if (id.is_valid()) solid.faces.push_back(id);
      }
      if (solid.faces.empty()) return;
      solid.is_closed = is_closed(solid);
      content_->solids.push_back(shape);
      model_.solids.push_back(std::move(solid));
    };
    for (TopExp_Explorer s(part.shape, TopAbs_SOLID); s.More(); s.Next()) add_solid(s.Current());
    for (TopExp_Explorer s(part.shape, TopAbs_SHELL, TopAbs_SOLID); s.More(); s.Next()) add_solid(s.Current());
    for (TopExp_Explorer f(part.shape, TopAbs_FACE, TopAbs_SHELL); f.More(); f.Next()) add_face(TopoDS::Face(f.Current()), part, component);
  }

  /// Returns true if every edge that is not a pole is used twice, once in each direction as seen from outside.
  bool is_closed(const ModelSolid& solid) const {
    std::map<EdgeId, std::pair<int, int>> uses;
    for (const FaceId f : solid.faces)
      for (const Border& border : model_.faces[f].borders)
        for (const EdgeUse& use : border) ++(use.is_reversed != model_.faces[f].is_reversed ? uses[use.edge].first : uses[use.edge].second);
    return std::all_of(uses.begin(), uses.end(), [&](const auto& use) { return model_.edges[use.first].is_degenerate() || use.second == std::pair(1, 1); });
  }

  ComponentId component_of(const std::string& given) {
    const std::string name = given.empty() ? "part_" + std::to_string(model_.components.size() + 1) : given;
    for (const ComponentId c : model_.components.ids())
      if (model_.components[c].name == name) return c;
    return model_.components.push_back({.name = name});
  }

  FaceId add_face(const TopoDS_Face& face, const ShapePart& part, ComponentId component) {
    context_.check_stop();
    if (faces_.Contains(face)) return {};  // a face between two solids belongs to the first
    const TopoDS_Face forward = TopoDS::Face(face.Oriented(TopAbs_FORWARD));
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(forward);
    if (surface.IsNull()) fail(attempted_, "face " + std::to_string(faces_.Extent()) + " has no surface", face);
    ParameterBox box;
    BRepTools::UVBounds(forward, box.u.from, box.u.to, box.v.from, box.v.to);
    ModelFace result;
    result.surface = surface_of(surface, box);
    result.is_reversed = face.Orientation() == TopAbs_REVERSED;
    result.component = component;
    result.tolerance = BRep_Tool::Tolerance(face);
    set_label(result, face, part);
    const TopoDS_Wire outer = ShapeAnalysis::OuterWire(forward);
    for (TopoDS_Iterator wire(forward); wire.More(); wire.Next()) {
      if (wire.Value().ShapeType() != TopAbs_WIRE) continue;
      Border border = border_of(TopoDS::Wire(wire.Value()), forward, *result.surface);
      if (border.empty()) continue;
      const bool is_outer = wire.Value().IsSame(outer);
      result.borders.insert(is_outer ? result.borders.begin() : result.borders.end(), std::move(border));
    }
    if (result.borders.empty()) fail(attempted_, "face " + std::to_string(faces_.Extent()) + " has no border", face);
    faces_.Add(face);
    content_->faces.push_back(face);
    return model_.faces.push_back(std::move(result));
  }

  void set_label(ModelFace& result, const TopoDS_Face& face, const ShapePart& part) {
    const FaceLabel* own = labelled_.labels.Seek(face);
    const FaceLabel label = own ? *own : FaceLabel{};
    if (!label.component.empty()) result.component = component_of(label.component);
    result.name = !label.name.empty() ? label.name : model_.components[result.component].name;
    result.colour = label.colour ? label.colour : part.label.colour;
    result.layer = !label.layer.empty() ? label.layer : part.label.layer;
  }

  /// Increases a tolerance to the measured distance, since tolerances stated in files are often too small.
  static void widen_tolerance(ModelEdge& edge, const Surface& surface, const ParameterCurve& parameter) {
    if (edge.is_degenerate()) return;
    for (int i = 0; i <= k_tolerance_samples; ++i) {
      const double t = edge.range.from + edge.range.length() * i / k_tolerance_samples;
      edge.tolerance = std::max(edge.tolerance, distance(edge.curve->point(t), surface.point(parameter.point(t))));
    }
  }

  Border border_of(const TopoDS_Wire& wire, const TopoDS_Face& forward, const Surface& surface) {
    Border border;
    for (const WireEdge& use : edges_in_order(wire, forward)) {
      double from = 0.0, to = 0.0;
      const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(use.edge, forward, from, to);
      const EdgeId edge = edge_of(use.edge);
      border.push_back({.edge = edge, .is_reversed = use.edge.Orientation() == TopAbs_REVERSED, .parameter = parameter_curve_of(curve, {from, to})});
      widen_tolerance(model_.edges[edge], surface, *border.back().parameter);
    }
    return border;
  }

  /// Returns the edges of a wire head to tail. The next edge starts at the corner where the last one ends; if several edges do (seams), the parameters decide.
  /// Edges inside or outside of the border (INTERNAL, EXTERNAL) are excluded.
  std::vector<WireEdge> edges_in_order(const TopoDS_Wire& wire, const TopoDS_Face& forward) const {
    std::vector<WireEdge> edges;
    for (TopoDS_Iterator it(wire); it.More(); it.Next()) {
      const TopoDS_Edge edge = TopoDS::Edge(it.Value());
      if (edge.Orientation() != TopAbs_FORWARD && edge.Orientation() != TopAbs_REVERSED) continue;
      double from = 0.0, to = 0.0;
      const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, forward, from, to);
      if (curve.IsNull()) fail(attempted_, "an edge of face " + std::to_string(faces_.Extent()) + " has no curve in the face", edge);
      const bool is_reversed = edge.Orientation() == TopAbs_REVERSED;
      edges.push_back({edge, TopExp::FirstVertex(edge, true), TopExp::LastVertex(edge, true), curve->Value(is_reversed ? to : from),
                       curve->Value(is_reversed ? from : to)});
    }
    for (std::size_t i = 1; i < edges.size(); ++i) {
      std::size_t best = i;
      double best_distance = std::numeric_limits<double>::infinity();
      for (std::size_t k = i; k < edges.size(); ++k) {
        if (!edges[k].from.IsSame(edges[i - 1].to)) continue;
        const double distance = edges[k].uv_from.SquareDistance(edges[i - 1].uv_to);
        if (distance < best_distance) {
          best = k;
          best_distance = distance;
        }
      }
      std::rotate(edges.begin() + static_cast<std::ptrdiff_t>(i), edges.begin() + static_cast<std::ptrdiff_t>(best),
                  edges.begin() + static_cast<std::ptrdiff_t>(best) + 1);
    }
    return edges;
  }

  EdgeId edge_of(const TopoDS_Edge& use) {
    const TopoDS_Edge edge = TopoDS::Edge(use.Oriented(TopAbs_FORWARD));
    if (const int index = edges_.FindIndex(edge); index > 0) return EdgeId(index - 1);
    ModelEdge result;
    if (!BRep_Tool::Degenerated(edge)) {
      const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, result.range.from, result.range.to);
      if (curve.IsNull()) fail(attempted_, "edge " + std::to_string(edges_.Extent()) + " has no curve in space", edge);
      result.curve = curve_of(curve, result.range);
    } else {
      BRep_Tool::Range(edge, result.range.from, result.range.to);
    }
    result.tolerance = BRep_Tool::Tolerance(edge);
    result.start = corner_of(TopExp::FirstVertex(edge), edge);
    result.end = corner_of(TopExp::LastVertex(edge), edge);
    edges_.Add(edge);
    content_->edges.push_back(edge);
    return model_.edges.push_back(std::move(result));
  }

  CornerId corner_of(const TopoDS_Vertex& vertex, const TopoDS_Edge& edge) {
    if (vertex.IsNull()) fail(attempted_, "edge " + std::to_string(edges_.Extent()) + " has no end", edge);
    if (const int index = corners_.FindIndex(vertex); index > 0) return CornerId(index - 1);
    corners_.Add(vertex);
    return model_.corners.push_back({model_point(BRep_Tool::Pnt(vertex)), BRep_Tool::Tolerance(vertex)});
  }

  const LabelledShape& labelled_;
  const std::string& attempted_;
  const RunContext& context_;
  Model model_;
  std::unique_ptr<CadShape::Content> content_ = std::make_unique<CadShape::Content>();
  TopTools_IndexedMapOfShape faces_, edges_, corners_;
};

}  // namespace

Model model_of(const LabelledShape& labelled, const std::string& attempted, const RunContext& context) {
  return ModelBuilder(labelled, attempted, context).build();
}

}  // namespace sterna::cad
