// Steps: find the parts that are closed solids. Test for each other part if the option selects it, or else if it is flat, on a solid's edges, or within solids.
// Warn for each removed part.
#include "geom/cad/open_shells.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "geom/base/glob.h"
#include "geom/base/number_text.h"

namespace sterna::cad {
namespace {

/// Largest distance of a flat sheet from its plane, relative to its size.
constexpr double k_flat_share = 1e-5;
/// Distance from a solid's surface within which a point is on it, relative to the model's size.
constexpr double k_on_share = 1e-5;
constexpr int k_sheet_samples = 8;
/// Area of a sheet that is degenerate to a line, relative to the square of the model's size.
constexpr double k_no_sheet_area = 1e-10;

bool is_closed_solid(const TopoDS_Shape& shape) {
  if (shape.ShapeType() != TopAbs_SOLID) return false;
  TopTools_IndexedDataMapOfShapeListOfShape faces;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces);
  for (int e = 1; e <= faces.Extent(); ++e) {
    const TopoDS_Edge& edge = TopoDS::Edge(faces.FindKey(e));
    if (faces(e).Extent() == 1 && !BRep_Tool::Degenerated(edge) && !BRep_Tool::IsClosed(edge, TopoDS::Face(faces(e).First()))) return false;
  }
  return true;
}

/// Returns points on all edges and in the middle of all faces.
std::vector<gp_Pnt> samples_of(const TopoDS_Shape& sheet) {
  std::vector<gp_Pnt> points;
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(sheet, TopAbs_EDGE, edges);
  for (int e = 1; e <= edges.Extent(); ++e) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(e));
    if (BRep_Tool::Degenerated(edge)) continue;
    const BRepAdaptor_Curve curve(edge);
    for (int i = 0; i <= k_sheet_samples; ++i)
      points.push_back(curve.Value(curve.FirstParameter() + (curve.LastParameter() - curve.FirstParameter()) * i / k_sheet_samples));
  }
  for (TopExp_Explorer f(sheet, TopAbs_FACE); f.More(); f.Next()) {
    const Point middle = location_of(f.Current());
    points.push_back(gp_Pnt(middle.x, middle.y, middle.z));
  }
  return points;
}

bool is_flat(const std::vector<gp_Pnt>& points) {
  if (points.size() < 3) return true;
  const gp_Pnt& origin = points.front();
  gp_Vec normal;
  double size = 0.0;
  gp_Vec longest;
  for (const gp_Pnt& p : points)
    if (const gp_Vec v(origin, p); v.Magnitude() > size) {
      size = v.Magnitude();
      longest = v;
    }
  for (const gp_Pnt& p : points)
    if (const gp_Vec n = longest.Crossed(gp_Vec(origin, p)); n.Magnitude() > normal.Magnitude()) normal = n;
  if (normal.Magnitude() <= 0.0) return true;
  normal.Normalize();
  return std::all_of(points.begin(), points.end(), [&](const gp_Pnt& p) { return std::abs(normal.Dot(gp_Vec(origin, p))) <= k_flat_share * size; });
}

bool shares_edge(const TopoDS_Shape& sheet, const TopTools_IndexedMapOfShape& edges) {
  for (TopExp_Explorer e(sheet, TopAbs_EDGE); e.More(); e.Next())
    if (edges.Contains(e.Current())) return true;
  return false;
}

std::string name_of(const ShapePart& part, const FaceLabels& labels) {
  if (const FaceLabel* label = labels.Seek(TopExp_Explorer(part.shape, TopAbs_FACE).Current())) {
    if (!label->name.empty()) return label->name;
    if (!label->component.empty()) return label->component;
  }
  return !part.name.empty() ? part.name : part.component;
}

bool is_pattern(const std::string& sheets) { return sheets != "automatic" && sheets != "keep" && sheets != "drop"; }

bool matches_any(const std::string& name, const std::string& patterns) {
  for (std::size_t at = 0; at < patterns.size();) {
    const std::size_t end = std::min(patterns.find(',', at), patterns.size());
    std::size_t from = patterns.find_first_not_of(' ', at);
    if (from < end) {
      const std::size_t last = patterns.find_last_not_of(' ', end - 1);
      if (matches_glob(name, patterns.substr(from, last + 1 - from))) return true;
    }
    at = end + 1;
  }
  return false;
}

}  // namespace

void drop_sheets(LabelledShape& labelled, const ReadCadOptions& options, CadReport& report) {
  if (options.sheets == "keep") return;
  std::vector<bool> is_solid;
  TopTools_IndexedMapOfShape solid_edges;
  std::vector<std::unique_ptr<BRepClass3d_SolidClassifier>> solids;
  for (const ShapePart& part : labelled.parts) {
    is_solid.push_back(is_closed_solid(part.shape));
    if (!is_solid.back()) continue;
    TopExp::MapShapes(part.shape, TopAbs_EDGE, solid_edges);
    solids.push_back(std::make_unique<BRepClass3d_SolidClassifier>(part.shape));
  }
  if (solids.empty() || solids.size() == labelled.parts.size()) return;
  const double size = longest_side(compound_of(labelled.parts));
  const double on = std::max(k_on_share * size, Precision::Confusion());
  const auto is_within = [&](const std::vector<gp_Pnt>& points) {
    return std::all_of(points.begin(), points.end(), [&](const gp_Pnt& p) {
      return std::any_of(solids.begin(), solids.end(), [&](const std::unique_ptr<BRepClass3d_SolidClassifier>& solid) {
        solid->Perform(p, on);
        return solid->State() == TopAbs_IN || solid->State() == TopAbs_ON;
      });
    });
  };
  std::vector<ShapePart> kept;
  std::size_t n_open = 0;
  for (std::size_t i = 0; i < labelled.parts.size(); ++i) {
    const ShapePart& part = labelled.parts[i];
    if (is_solid[i]) {
      kept.push_back(part);
      continue;
    }
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(part.shape, properties);
    const double area = std::abs(properties.Mass());
    if (area <= k_no_sheet_area * size * size) {  // degenerate tips: the mesher absorbs them
      kept.push_back(part);
      continue;
    }
    const std::string name = name_of(part, labelled.labels);
    std::string why;
    if (is_pattern(options.sheets)) {
      if (matches_any(name, options.sheets)) why = "named in `sheets`";
    } else if (options.sheets == "drop") {
      why = "open, beside closed solids";
    } else {
      const std::vector<gp_Pnt> points = samples_of(part.shape);
      why = shares_edge(part.shape, solid_edges) ? "open, on edges of a closed solid"
            : is_flat(points)                    ? "open and flat, beside closed solids"
            : is_within(points)                  ? "open, within a closed solid"
                                                 : "";
    }
    if (why.empty()) {
      kept.push_back(part);
      ++n_open;
      continue;
    }
    report.warnings.push_back("the sheet \"" + name + "\" (" + number_text(area) + " m^2 near " + format_point(location_of(part.shape)) + ", " + why +
                              ") is left out because it does not border the fluid; sheets = \"keep\" keeps all sheets");
  }
  labelled.parts = std::move(kept);
  if (n_open > 0)
    report.warnings.push_back(
        std::to_string(n_open) + (n_open == 1 ? " open shell is" : " open shells are") +
        " beside closed solids; if they are not part of the wall, sheets = \"drop\" leaves out all open shells, sheets = \"name*\" those with matching names");
}

}  // namespace sterna::cad
