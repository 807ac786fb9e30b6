#include "geom/cad/occt_shape.h"

#include <BRepBndLib.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepCheck_ListOfStatus.hxx>
#include <BRepCheck_Result.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>

#include <algorithm>

namespace sterna {

CadShape::CadShape(std::unique_ptr<const Content> content) : content_(std::move(content)) {}
CadShape::CadShape(std::function<std::shared_ptr<const CadShape>()> make) : make_(std::move(make)) {}
CadShape::~CadShape() = default;

const CadShape::Content& CadShape::content() const {
  if (content_) return *content_;
  std::call_once(is_made_, [&] { made_ = make_(); });
  return made_->content();
}

namespace cad {
namespace {

Point point_of_vertex(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

std::string status_text(BRepCheck_Status status) {
  switch (status) {
    case BRepCheck_InvalidPointOnCurve: return "a corner lies off its edge's curve";
    case BRepCheck_InvalidPointOnCurveOnSurface: return "a corner lies off its edge's curve in the face";
    case BRepCheck_InvalidPointOnSurface: return "a corner lies off the surface";
    case BRepCheck_No3DCurve: return "an edge has no curve in space";
    case BRepCheck_Multiple3DCurve: return "an edge has several curves in space";
    case BRepCheck_Invalid3DCurve: return "an edge has an invalid curve in space";
    case BRepCheck_NoCurveOnSurface: return "an edge has no curve in the face";
    case BRepCheck_InvalidCurveOnSurface: return "an edge's curve in the face is off its curve in space";
    case BRepCheck_InvalidCurveOnClosedSurface: return "a seam's curves in the face are invalid";
    case BRepCheck_InvalidSameRangeFlag: return "an edge's curves have different ranges";
    case BRepCheck_InvalidSameParameterFlag: return "an edge's curves have different parameters";
    case BRepCheck_InvalidDegeneratedFlag: return "an edge is wrongly marked as degenerate";
    case BRepCheck_FreeEdge: return "an edge is free";
    case BRepCheck_InvalidMultiConnexity: return "an edge has more than two faces";
    case BRepCheck_InvalidRange: return "an edge has an invalid range";
    case BRepCheck_EmptyWire: return "a border is empty";
    case BRepCheck_RedundantEdge: return "an edge is used twice";
    case BRepCheck_SelfIntersectingWire: return "a border crosses itself";
    case BRepCheck_NoSurface: return "the face has no surface";
    case BRepCheck_InvalidWire: return "a border is invalid";
    case BRepCheck_RedundantWire: return "a border occurs twice";
    case BRepCheck_IntersectingWires: return "borders cross each other";
    case BRepCheck_InvalidImbricationOfWires: return "a hole lies outside of the outer border";
    case BRepCheck_EmptyShell: return "a shell is empty";
    case BRepCheck_RedundantFace: return "a face occurs twice";
    case BRepCheck_InvalidImbricationOfShells: return "shells are nested wrongly";
    case BRepCheck_UnorientableShape: return "faces cannot be oriented alike";
    case BRepCheck_NotClosed: return "not closed";
    case BRepCheck_NotConnected: return "not connected";
    case BRepCheck_SubshapeNotInShape: return "a part is missing";
    case BRepCheck_BadOrientation: return "wrongly oriented";
    case BRepCheck_BadOrientationOfSubshape: return "a part is wrongly oriented";
    case BRepCheck_InvalidPolygonOnTriangulation: return "an edge's polygon is invalid";
    case BRepCheck_InvalidToleranceValue: return "a tolerance is negative or infinite";
    case BRepCheck_EnclosedRegion: return "a region is enclosed";
    case BRepCheck_CheckFail: return "OpenCASCADE's check itself failed";
    case BRepCheck_NoError: break;
  }
  return {};
}

/// Adds the texts of the faults of one shape alone, or as a part of `within`.
void add_faults(const BRepCheck_ListOfStatus& list, const std::string& what, const TopoDS_Shape& at, std::vector<ErrorLocation>& faults) {
  for (const BRepCheck_Status status : list) {
    if (status == BRepCheck_NoError) continue;
    ErrorLocation fault{location_of(at), what + ": " + status_text(status)};
    if (std::none_of(faults.begin(), faults.end(), [&](const ErrorLocation& f) { return f.what == fault.what && f.position == fault.position; }))
      faults.push_back(std::move(fault));
  }
}

std::vector<ErrorLocation> collect_faults(const CadShape::Content& content) {
  const BRepCheck_Analyzer analyzer(content.shape);
  std::vector<ErrorLocation> faults;
  if (analyzer.IsValid()) return faults;
  const auto add = [&](const TopoDS_Shape& shape, const std::string& what) {
    const Handle(BRepCheck_Result)& result = analyzer.Result(shape);
    if (result.IsNull()) return;
    add_faults(result->Status(), what, shape, faults);
    for (result->InitContextIterator(); result->MoreShapeInContext(); result->NextShapeInContext()) add_faults(result->StatusOnShape(), what, shape, faults);
  };
  for (std::size_t f = 0; f < content.faces.size(); ++f) {
    const std::string face = "face " + std::to_string(f);
    add(content.faces[f], face);
    for (const TopAbs_ShapeEnum kind : {TopAbs_WIRE, TopAbs_EDGE, TopAbs_VERTEX})
      for (TopExp_Explorer part(content.faces[f], kind); part.More(); part.Next()) add(part.Current(), face);
  }
  for (std::size_t s = 0; s < content.solids.size(); ++s) {
    const std::string solid = "solid " + std::to_string(s);
    add(content.solids[s], solid);
    for (TopExp_Explorer shell(content.solids[s], TopAbs_SHELL); shell.More(); shell.Next()) add(shell.Current(), solid);
  }
  if (faults.empty()) faults.push_back({location_of(content.shape), "whole shape: rejected by OpenCASCADE's check"});
  return faults;
}

}  // namespace

Point location_of(const TopoDS_Shape& shape) {
  if (shape.IsNull()) return {};
  if (shape.ShapeType() == TopAbs_VERTEX) return point_of_vertex(BRep_Tool::Pnt(TopoDS::Vertex(shape)));
  if (shape.ShapeType() == TopAbs_EDGE) {
    double from = 0.0, to = 0.0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(TopoDS::Edge(shape), from, to);
    if (!curve.IsNull()) return point_of_vertex(curve->Value(0.5 * (from + to)));
  }
  if (shape.ShapeType() == TopAbs_FACE) {
    const TopoDS_Face face = TopoDS::Face(shape);
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
    double u1 = 0.0, u2 = 0.0, v1 = 0.0, v2 = 0.0;
    BRepTools::UVBounds(face, u1, u2, v1, v2);
    if (!surface.IsNull() && u1 <= u2 && v1 <= v2) return point_of_vertex(surface->Value(0.5 * (u1 + u2), 0.5 * (v1 + v2)));
  }
  for (TopExp_Explorer vertex(shape, TopAbs_VERTEX); vertex.More(); vertex.Next()) return point_of_vertex(BRep_Tool::Pnt(TopoDS::Vertex(vertex.Current())));
  return {};
}

TopoDS_Shape compound_of(const std::vector<ShapePart>& parts) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const ShapePart& part : parts) builder.Add(compound, part.shape);
  return compound;
}

double longest_side(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  if (box.IsVoid()) return 0.0;
  box.SetGap(0.0);
  double a[3], b[3];
  box.Get(a[0], a[1], a[2], b[0], b[1], b[2]);
  return std::max({b[0] - a[0], b[1] - a[1], b[2] - a[2]});
}

std::vector<ErrorLocation> faults_of(const CadShape& shape) {
  try {
    return collect_faults(shape.content());
  } catch (const Standard_Failure& failure) {
    return {{location_of(shape.content().shape), std::string("whole shape: OpenCASCADE's check failed with ") + failure.DynamicType()->Name()}};
  }
}

}  // namespace cad
}  // namespace sterna
