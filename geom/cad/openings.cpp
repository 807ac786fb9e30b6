#include "geom/cad/openings.h"

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <GeomAPI_ProjectPointOnCurve.hxx>
#include <Geom_Curve.hxx>
#include <Precision.hxx>
#include <ShapeAnalysis_FreeBounds.hxx>
#include <ShapeFix_Shell.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Wire.hxx>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sterna::cad {
namespace {

/// Sample points along an edge where its distance to another is measured.
constexpr int k_samples = 16;
/// Ends of a pair coincide to this fraction of the edge's length.
constexpr double k_same_end = 1e-4;
/// Joining beyond this fraction of the shortest free edge would merge its ends.
constexpr double k_of_shortest_edge = 0.25;

struct FreeEdge {
  TopoDS_Edge edge;
  TopoDS_Shape face;
  Handle(Geom_Curve) curve;
  double from = 0.0, to = 0.0, length = 0.0;
  gp_Pnt at(double share) const { return curve->Value(from + share * (to - from)); }
};

std::vector<FreeEdge> free_edges_of(const std::vector<TopoDS_Shape>& shapes) {
  TopTools_IndexedDataMapOfShapeListOfShape faces;
  for (const TopoDS_Shape& shape : shapes) TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces);
  std::vector<FreeEdge> result;
  for (int e = 1; e <= faces.Extent(); ++e) {
    const TopoDS_Edge& edge = TopoDS::Edge(faces.FindKey(e));
    if (faces(e).Extent() != 1 || BRep_Tool::Degenerated(edge) || BRep_Tool::IsClosed(edge, TopoDS::Face(faces(e).First()))) continue;
    FreeEdge free{.edge = edge, .face = faces(e).First(), .curve = {}};
    free.curve = BRep_Tool::Curve(edge, free.from, free.to);
    if (free.curve.IsNull()) continue;
    GProp_GProps properties;
    BRepGProp::LinearProperties(edge, properties);
    free.length = properties.Mass();
    result.push_back(free);
  }
  return result;
}

bool have_same_ends(const FreeEdge& a, const FreeEdge& b, double tolerance) {
  const auto near = [&](double s, double t) { return a.at(s).Distance(b.at(t)) <= tolerance; };
  return (near(0.0, 0.0) && near(1.0, 1.0)) || (near(0.0, 1.0) && near(1.0, 0.0));
}

/// Returns the largest distance of sample points of `a` from `b`.
double distance_of(const FreeEdge& a, const FreeEdge& b) {
  double largest = 0.0;
  for (int i = 0; i <= k_samples; ++i) {
    const gp_Pnt p = a.at(static_cast<double>(i) / k_samples);
    double nearest = std::min(p.Distance(b.at(0.0)), p.Distance(b.at(1.0)));
    const GeomAPI_ProjectPointOnCurve projection(p, b.curve, b.from, b.to);
    if (projection.NbPoints() > 0) nearest = std::min(nearest, projection.LowerDistance());
    largest = std::max(largest, nearest);
  }
  return largest;
}

/// A face whose border runs back and forth encloses no area. It is recognised by an area below this fraction of the square of the border's length.
constexpr double k_no_area = 1e-8;
bool has_area(const TopoDS_Face& face) {
  GProp_GProps area, border;
  BRepGProp::SurfaceProperties(face, area);
  BRepGProp::LinearProperties(face, border);
  return std::abs(area.Mass()) > k_no_area * border.Mass() * border.Mass();
}

/// Returns the faces of an open part and its caps as one shell, consistently oriented.
TopoDS_Shape shell_with(const TopoDS_Shape& part, const std::vector<TopoDS_Face>& caps) {
  BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  for (TopExp_Explorer f(part, TopAbs_FACE); f.More(); f.Next()) builder.Add(shell, f.Current());
  for (const TopoDS_Face& cap : caps) builder.Add(shell, cap);
  ShapeFix_Shell fixer;
  fixer.FixFaceOrientation(shell);
  return fixer.Shell();
}

}  // namespace

double gap_of_pairs(const std::vector<TopoDS_Shape>& shapes, double small) {
  const std::vector<FreeEdge> edges = free_edges_of(shapes);
  double gap = 0.0, shortest = Precision::Infinite();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (edges[i].length > small) shortest = std::min(shortest, edges[i].length);
    for (std::size_t k = i + 1; k < edges.size(); ++k) {
      const FreeEdge &a = edges[i], &b = edges[k];
      const double length = std::min(a.length, b.length);
      if (a.face.IsSame(b.face) || length <= small || !have_same_ends(a, b, k_same_end * length)) continue;
      const double apart = std::max(distance_of(a, b), distance_of(b, a));
      if (apart <= k_pair_gap * length) gap = std::max(gap, apart);
    }
  }
  return gap <= k_of_shortest_edge * shortest ? gap : 0.0;
}

void cap_openings(LabelledShape& labelled, CadReport& report) {
  std::size_t n_caps = 0, n_borders = 0;
  std::optional<Point> bent;  // an open boundary that no flat face closes
  for (ShapePart& part : labelled.parts) {
    if (part.shape.ShapeType() == TopAbs_SOLID) continue;
    TopoDS_Compound faces;
    BRep_Builder().MakeCompound(faces);
    for (TopExp_Explorer f(part.shape, TopAbs_FACE); f.More(); f.Next()) BRep_Builder().Add(faces, f.Current());
    std::vector<TopoDS_Face> caps;
    for (TopExp_Explorer wire(ShapeAnalysis_FreeBounds(faces).GetClosedWires(), TopAbs_WIRE); wire.More(); wire.Next()) {
      BRepBuilderAPI_MakeFace maker(TopoDS::Wire(wire.Current()), true);
      ++n_borders;
      if (maker.IsDone() && has_area(maker.Face())) caps.push_back(maker.Face());
      else if (!bent) bent = location_of(wire.Current());
    }
    n_caps += caps.size();
    if (caps.empty()) continue;
    const FaceLabel* of_shell = labelled.labels.Seek(TopExp_Explorer(part.shape, TopAbs_FACE).Current());
    FaceLabel label = of_shell ? *of_shell : FaceLabel{};
    label.name = label.component.empty() ? "cap" : label.component + " cap";
    for (const TopoDS_Face& cap : caps) {
      labelled.labels.Bind(cap, label);
      report.repaired.push_back({.what = "flat opening closed with a face", .location = location_of(cap)});
    }
    part.shape = shell_with(part.shape, caps);
  }
  if (n_borders == 0) report.warnings.emplace_back("cap = true has no effect: the model has no opening");
  else if (n_caps < n_borders)
    report.warnings.push_back(std::to_string(n_borders - n_caps) + " of " + std::to_string(n_borders) +
                              " openings are not flat and stay open with cap = true; the first is near " + format_point(*bent) +
                              "; `sterna repair` and --auto close them in the triangulation");
}

}  // namespace sterna::cad
