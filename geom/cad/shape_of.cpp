// Converts a Model to OpenCASCADE's topology: corners, edges, faces with their curves, then solids; nothing is approximated.
#include <BRepLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Precision.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>

#include <algorithm>

#include "geom/cad/occt_call.h"
#include "geom/cad/occt_geometry.h"
#include "geom/cad/occt_shape.h"

namespace sterna::cad {
namespace {

constexpr const char* k_shape_attempt = "converting the model to OpenCASCADE";

[[noreturn]] void fail(const std::string& problem, const Point& at) {
  throw Error({.code = ErrorCode::geometry_failed, .attempted = k_shape_attempt, .problem = problem, .locations = {{at, problem}}});
}

double tolerance_of(double tolerance) { return std::max(tolerance, Precision::Confusion()); }

class ShapeBuilder {
 public:
  explicit ShapeBuilder(const Model& model) : model_(model) {}

  std::unique_ptr<CadShape::Content> build() {
    for (const CornerId c : model_.corners.ids()) add_corner(model_.corners[c]);
    for (const EdgeId e : model_.edges.ids()) add_edge(e);
    const auto uses = uses_of_edges(model_);
    for (const FaceId f : model_.faces.ids()) surfaces_.push_back(surface_of_face(f));
    for (const EdgeId e : model_.edges.ids())
      for (std::size_t i = 0; i < uses[e].size(); ++i) add_parameter_curve(e, uses[e], i);
    for (const FaceId f : model_.faces.ids()) add_face(f);
    add_solids();
    BRepLib::UpdateTolerances(content_->shape);
    return std::move(content_);
  }

 private:
  void add_corner(const ModelCorner& corner) {
    TopoDS_Vertex vertex;
    builder_.MakeVertex(vertex, gp_Pnt(corner.point.x, corner.point.y, corner.point.z), tolerance_of(corner.tolerance));
    corners_.push_back(vertex);
  }

  void add_edge(EdgeId e) {
    const ModelEdge& edge = model_.edges[e];
    TopoDS_Edge result;
    if (edge.is_degenerate()) {
      builder_.MakeEdge(result);
      builder_.Degenerated(result, true);
      builder_.UpdateEdge(result, tolerance_of(edge.tolerance));
    } else {
      const Handle(Geom_Curve) curve = geom_of(*edge.curve);
      if (curve.IsNull())
        fail("edge " + std::to_string(e.index()) + " has no exact form in OpenCASCADE", edge.curve->point(0.5 * (edge.range.from + edge.range.to)));
      builder_.MakeEdge(result, curve, tolerance_of(edge.tolerance));
    }
    builder_.Add(result, corners_[edge.start.index()].Oriented(TopAbs_FORWARD));
    builder_.Add(result, corners_[edge.end.index()].Oriented(TopAbs_REVERSED));
    builder_.Range(result, edge.range.from, edge.range.to);
    content_->edges.push_back(result);
  }

  Handle(Geom_Surface) surface_of_face(FaceId f) const {
    const ModelFace& face = model_.faces[f];
    Handle(Geom_Surface) surface = geom_of(*face.surface);
    if (!surface.IsNull()) return surface;
    const ParameterBox box = face.surface->domain();
    fail("face " + std::to_string(f.index()) + " (\"" + face.name + "\", " + face.surface->kind() + ") has no exact form in OpenCASCADE",
         face.surface->point({0.5 * (box.u.from + box.u.to), 0.5 * (box.v.from + box.v.to)}));
  }

  const EdgeUse& use_at(const EdgeUseLocation& location) const { return model_.faces[location.face].borders[location.border][location.location]; }

  /// Adds the curve of one use; both uses of a seam are added together, at the first of them.
  void add_parameter_curve(EdgeId e, const std::vector<EdgeUseLocation>& uses, std::size_t i) {
    const FaceId face = uses[i].face;
    const auto same_face = [&](const EdgeUseLocation& other) { return other.face == face; };
    if (std::any_of(uses.begin(), uses.begin() + static_cast<std::ptrdiff_t>(i), same_face)) return;
    const auto seam = std::find_if(uses.begin() + static_cast<std::ptrdiff_t>(i) + 1, uses.end(), same_face);
    const double tolerance = tolerance_of(model_.edges[e].tolerance);
    const TopoDS_Edge& edge = content_->edges[e.index()];
    const Handle(Geom2d_Curve) first = parameter_curve(uses[i]);
    if (seam == uses.end()) {
      builder_.UpdateEdge(edge, first, surfaces_[face.index()], TopLoc_Location(), tolerance);
    } else {
      const Handle(Geom2d_Curve) second = parameter_curve(*seam);
      const bool swap = use_at(uses[i]).is_reversed;
      builder_.UpdateEdge(edge, swap ? second : first, swap ? first : second, surfaces_[face.index()], TopLoc_Location(), tolerance);
    }
    builder_.Range(edge, surfaces_[face.index()], TopLoc_Location(), model_.edges[e].range.from, model_.edges[e].range.to);
  }

  Handle(Geom2d_Curve) parameter_curve(const EdgeUseLocation& location) const {
    Handle(Geom2d_Curve) curve = geom_of(*use_at(location).parameter);
    if (!curve.IsNull()) return curve;
    const ParameterCurve& parameter = *use_at(location).parameter;
    fail("a parameter curve of face " + std::to_string(location.face.index()) + " has no exact form in OpenCASCADE",
         model_.faces[location.face].surface->point(parameter.point(parameter.domain().from)));
  }

  void add_face(FaceId f) {
    const ModelFace& face = model_.faces[f];
    TopoDS_Face result;
    builder_.MakeFace(result, surfaces_[f.index()], tolerance_of(face.tolerance));
    for (const Border& border : face.borders) {
      TopoDS_Wire wire;
      builder_.MakeWire(wire);
      for (const EdgeUse& use : border) builder_.Add(wire, content_->edges[use.edge.index()].Oriented(use.is_reversed ? TopAbs_REVERSED : TopAbs_FORWARD));
      wire.Closed(true);
      builder_.Add(result, wire);
    }
    content_->faces.push_back(TopoDS::Face(result.Oriented(face.is_reversed ? TopAbs_REVERSED : TopAbs_FORWARD)));
  }

  void add_solids() {
    TopoDS_Compound compound;
    builder_.MakeCompound(compound);
    std::vector<bool> is_loose(model_.faces.size(), true);
    for (const ModelSolid& solid : model_.solids) {
      TopoDS_Shell shell;
      builder_.MakeShell(shell);
      for (const FaceId f : solid.faces) {
        builder_.Add(shell, content_->faces[f.index()]);
        is_loose[f.index()] = false;
      }
      shell.Closed(BRep_Tool::IsClosed(shell));
      TopoDS_Shape result = shell;
      if (solid.is_closed) {
        TopoDS_Solid whole;
        builder_.MakeSolid(whole);
        builder_.Add(whole, shell);
        result = whole;
      }
      content_->solids.push_back(result);
      builder_.Add(compound, result);
    }
    for (const FaceId f : model_.faces.ids())
      if (is_loose[f.index()]) builder_.Add(compound, content_->faces[f.index()]);
    content_->shape = compound;
  }

  const Model& model_;
  BRep_Builder builder_;
  std::vector<TopoDS_Vertex> corners_;
  std::vector<Handle(Geom_Surface)> surfaces_;
  std::unique_ptr<CadShape::Content> content_ = std::make_unique<CadShape::Content>();
};

}  // namespace

std::shared_ptr<const CadShape> shape_of(const Model& model, const RunContext& context) {
  if (model.shape) {
    static_cast<void>(model.shape->content());  // builds a lazy shape now, since that may use OpenCASCADE, which must not be entered twice
    return model.shape;
  }
  std::shared_ptr<const CadShape> shape;
  run_occt({.attempted = k_shape_attempt}, context,
           [&](const Message_ProgressRange&) { shape = std::make_shared<const CadShape>(ShapeBuilder(model).build()); });
  return shape;
}

}  // namespace sterna::cad
