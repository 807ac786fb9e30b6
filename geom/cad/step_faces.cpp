// Steps for each face on a closed surface: remove seams from its loops; follow the loops in the parameters, unwrapped; test if a natural border would be lost;
// find an angle that no hole crosses; rotate the surface to that angle; add a loop along the seam.
#include "geom/cad/step_faces.h"

#include <BRep_Tool.hxx>
#include <GeomConvert.hxx>
#include <GeomToStep_MakeCartesianPoint.hxx>
#include <GeomToStep_MakeCurve.hxx>
#include <GeomToStep_MakeSurface.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Precision.hxx>
#include <STEPConstruct_UnitContext.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <Standard_Failure.hxx>
#include <StepData_GlobalFactors.hxx>
#include <StepGeom_BSplineSurface.hxx>
#include <StepGeom_CartesianPoint.hxx>
#include <StepGeom_Curve.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepGeom_SurfaceOfRevolution.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <StepShape_EdgeCurve.hxx>
#include <StepShape_EdgeLoop.hxx>
#include <StepShape_FaceBound.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_HArray1OfFaceBound.hxx>
#include <StepShape_HArray1OfOrientedEdge.hxx>
#include <StepShape_OrientedEdge.hxx>
#include <StepShape_VertexLoop.hxx>
#include <StepShape_VertexPoint.hxx>
#include <StepToGeom.hxx>
#include <StepToTopoDS_DataMapOfTRI.hxx>
#include <StepToTopoDS_NMTool.hxx>
#include <StepToTopoDS_Tool.hxx>
#include <StepToTopoDS_TranslateFace.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopoDS.hxx>
#include <Transfer_TransientProcess.hxx>
#include <gp_Ax1.hxx>
#include <gp_Pnt2d.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

namespace sterna::cad {
namespace {

using StepEdge = Handle(StepShape_OrientedEdge);

/// Intervals of an edge at which its course in the parameters of the face is sampled: less than a quarter turn each for any edge that turns up to eight times.
constexpr int k_edge_locations = 32;
/// A longer step between two samples, relative to the period, passes through a pole.
constexpr double k_largest_step = 0.3;
/// An end of a surface narrower than this fraction of the surface is a pole.
constexpr double k_pole_share = 1e-6;
/// Smallest distance between a seam and the holes, relative to the period: a smaller one would produce sliver triangles.
constexpr double k_free_share = 1e-3;

/// A surface that is closed in one direction and has a pole at both ends of the other.
struct PoledSurface {
  Handle(Geom_Surface) surface;
  bool is_u = true;                 ///< closed in u, poles at the ends of v
  double from = 0.0, period = 0.0;  ///< range of the closed direction
  std::array<gp_Pnt, 2> poles;
  double pole_size = 0.0;  ///< points nearer to a pole than this belong to it; the circumferential parameter is undefined there
  gp_Pnt2d at(double around, double along) const { return is_u ? gp_Pnt2d(around, along) : gp_Pnt2d(along, around); }
};

/// Edges head to tail around a hole, without seams, and the location of the loop.
struct Hole {
  std::vector<StepEdge> edges;
  Handle(StepShape_FaceBound) bound;  ///< bound in the file; null if seams were cut out of it
  bool orientation = true;
  double low = 0.0, high = 0.0;  ///< range of the hole in the closed direction, unwrapped (may exceed one period)
  double winding = 0.0;          ///< number of turns around the closed direction
  double area = 0.0;             ///< area enclosed in the parameters, positive if counterclockwise
  bool meets_pole = false;       ///< the course jumps from one meridian to another, so winding and area are undefined
};

double spread(const Handle(Geom_Surface) & surface, const PoledSurface& poled, double along) {
  constexpr int k_locations = 8;
  const auto point = [&](int i) {
    const gp_Pnt2d uv = poled.at(poled.from + poled.period * i / k_locations, along);
    return surface->Value(uv.X(), uv.Y());
  };
  double largest = 0.0;
  for (int i = 1; i < k_locations; ++i) largest = std::max(largest, point(0).Distance(point(i)));
  return largest;
}

std::optional<PoledSurface> poled_surface(const Handle(Geom_Surface) & surface) {
  double u1 = 0.0, u2 = 0.0, v1 = 0.0, v2 = 0.0;
  surface->Bounds(u1, u2, v1, v2);
  for (const double bound : {u1, u2, v1, v2})
    if (Precision::IsInfinite(bound)) return std::nullopt;
  for (const bool is_u : {true, false}) {
    const PoledSurface poled{surface, is_u, is_u ? u1 : v1, is_u ? u2 - u1 : v2 - v1, {}};
    const double first = is_u ? v1 : u1, last = is_u ? v2 : u2;
    double size = 0.0, gap = 0.0;
    for (const double share : {0.25, 0.5, 0.75}) {
      const double along = first + share * (last - first);
      size = std::max(size, spread(surface, poled, along));
      const gp_Pnt2d a = poled.at(poled.from, along), b = poled.at(poled.from + poled.period, along);
      gap = std::max(gap, surface->Value(a.X(), a.Y()).Distance(surface->Value(b.X(), b.Y())));
    }
    const double tolerance = k_pole_share * size;
    if (!(size > 0.0) || gap > tolerance || spread(surface, poled, first) > tolerance || spread(surface, poled, last) > tolerance) continue;
    PoledSurface result = poled;
    const gp_Pnt2d a = poled.at(poled.from, first), b = poled.at(poled.from, last);
    result.poles = {surface->Value(a.X(), a.Y()), surface->Value(b.X(), b.Y())};
    result.pole_size = 2.0 * tolerance;
    return result;
  }
  return std::nullopt;
}

/// Translates raw faces, one at a time, to obtain the curves of their edges.
class FaceReader {
 public:
  explicit FaceReader(const Handle(StepData_StepModel) & model) : process_(new Transfer_TransientProcess(model->NbEntities())) {}

  /// Collects points in space along an edge in its direction of use.
  bool points_of(const StepEdge& use, std::vector<gp_Pnt>& points) {
    const Handle(StepShape_EdgeCurve) curve = Handle(StepShape_EdgeCurve)::DownCast(use->EdgeElement());
    if (curve.IsNull() || !tool_->IsBound(curve)) return false;
    double from = 0.0, to = 0.0;
    const Handle(Geom_Curve) geometry = BRep_Tool::Curve(TopoDS::Edge(tool_->Find(curve)), from, to);
    if (geometry.IsNull()) return false;
    const bool is_along = use->Orientation() == curve->SameSense();
    for (int i = 0; i <= k_edge_locations; ++i) {
      const double share = static_cast<double>(i) / k_edge_locations;
      points.push_back(geometry->Value(is_along ? from + share * (to - from) : to - share * (to - from)));
    }
    return true;
  }

  void read(const Handle(StepShape_FaceSurface) & face) {
    tool_ = std::make_unique<StepToTopoDS_Tool>(StepToTopoDS_DataMapOfTRI(), process_);
    StepToTopoDS_NMTool other;
    StepToTopoDS_TranslateFace translate;
    translate.SetPrecision(Precision::Confusion());
    translate.SetMaxTol(1.0);
    translate.Init(face, *tool_, other);
  }

 private:
  Handle(Transfer_TransientProcess) process_;
  std::unique_ptr<StepToTopoDS_Tool> tool_;
};

Handle(StepShape_Vertex) start_of(const StepEdge& use) { return use->EdgeStart(); }
Handle(StepShape_Vertex) end_of(const StepEdge& use) { return use->EdgeEnd(); }

/// Collects the edges of a loop that it does not use twice, head to tail. Returns false if they do not close.
bool holes_of(const Handle(StepShape_FaceBound) & bound, const Handle(StepShape_EdgeLoop) & loop, std::vector<Hole>& holes) {
  std::vector<StepEdge> edges;
  for (int i = 1; i <= loop->NbEdgeList(); ++i) {
    const StepEdge use = loop->EdgeListValue(i);
    int n_uses = 0;
    for (int k = 1; k <= loop->NbEdgeList(); ++k) n_uses += loop->EdgeListValue(k)->EdgeElement() == use->EdgeElement();
    if (n_uses == 1) edges.push_back(use);
  }
  const bool is_whole = edges.size() == static_cast<std::size_t>(loop->NbEdgeList());
  while (!edges.empty()) {
    Hole hole{.edges = {edges.front()}, .bound = is_whole ? bound : Handle(StepShape_FaceBound)(), .orientation = bound->Orientation()};
    edges.erase(edges.begin());
    while (end_of(hole.edges.back()) != start_of(hole.edges.front())) {
      const auto next = std::find_if(edges.begin(), edges.end(), [&](const StepEdge& e) { return start_of(e) == end_of(hole.edges.back()); });
      if (next == edges.end()) return false;
      hole.edges.push_back(*next);
      edges.erase(next);
    }
    holes.push_back(std::move(hole));
  }
  return true;
}

bool follow(Hole& hole, const PoledSurface& poled, FaceReader& reader) {
  std::vector<gp_Pnt> points;
  for (const StepEdge& use : hole.edges)
    if (!reader.points_of(use, points)) return false;
  const Handle(ShapeAnalysis_Surface) surface = new ShapeAnalysis_Surface(poled.surface);
  gp_Pnt2d uv = surface->ValueOfUV(points.front(), Precision::Confusion());
  const auto around_of = [&](const gp_Pnt2d& p) { return poled.is_u ? p.X() : p.Y(); };
  double around = around_of(uv), first = around;
  hole.low = hole.high = around;
  gp_Pnt2d before = uv;
  for (const gp_Pnt& point : points) {
    uv = surface->ValueOfUV(point, Precision::Confusion());
    double step = around_of(uv) - around;
    step -= poled.period * std::round(step / poled.period);
    // At the pole itself the parameter is arbitrary: two small steps may represent the jump.
    hole.meets_pole = hole.meets_pole || std::abs(step) > k_largest_step * poled.period || point.Distance(poled.poles[0]) <= poled.pole_size ||
                      point.Distance(poled.poles[1]) <= poled.pole_size;
    around += step;
    const gp_Pnt2d here = poled.is_u ? gp_Pnt2d(around, uv.Y()) : gp_Pnt2d(uv.X(), around);
    hole.area += 0.5 * (before.X() * here.Y() - here.X() * before.Y());
    before = here;
    hole.low = std::min(hole.low, around);
    hole.high = std::max(hole.high, around);
  }
  hole.winding = (around - first) / poled.period;
  return true;
}

/// Returns an angle where a seam crosses no hole: the surface's own seam if possible, else the middle of the widest gap.
std::optional<double> free_angle(const std::vector<Hole>& holes, const PoledSurface& poled) {
  const double margin = k_free_share * poled.period;
  struct Span {
    double from, to;
  };
  std::vector<Span> spans;  // starting within one period, sorted
  for (const Hole& hole : holes) {
    const double shift = poled.period * std::floor((hole.low - margin - poled.from) / poled.period);
    spans.push_back({hole.low - margin - shift, hole.high + margin - shift});
  }
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.from < b.from; });
  double reach = spans.empty() ? poled.from : -Precision::Infinite();
  for (const Span& span : spans) reach = std::max(reach, span.to - poled.period);  // spans that extend over the end cover the start
  if (reach < poled.from && (spans.empty() || spans.front().from > poled.from)) return poled.from;
  double best = 0.0, best_gap = 0.0;
  for (std::size_t i = 0; i <= spans.size(); ++i) {
    const double next = i < spans.size() ? spans[i].from : spans.front().from + poled.period;
    if (next - reach > best_gap) {
      best_gap = next - reach;
      best = reach + 0.5 * best_gap;
    }
    if (i < spans.size()) reach = std::max(reach, spans[i].to);
  }
  if (best_gap <= 0.0) return std::nullopt;
  return best;
}

/// Returns the same surface with its seam elsewhere; null for kinds that cannot be rotated.
Handle(Geom_Surface) turned(const PoledSurface& poled, double angle) {
  if (angle == poled.from) return poled.surface;
  const Handle(Geom_Surface) copy = Handle(Geom_Surface)::DownCast(poled.surface->Copy());
  if (const Handle(Geom_SurfaceOfRevolution) revolution = Handle(Geom_SurfaceOfRevolution)::DownCast(copy); !revolution.IsNull()) {
    const Handle(Geom_Curve) exact = GeomConvert::CurveToBSplineCurve(revolution->BasisCurve());  // trimmed curves have angles in the file's unit
    revolution->SetBasisCurve(exact);
    revolution->Rotate(revolution->Axis(), angle - poled.from);
    return Handle(Geom_Surface)(revolution);
  }
  const Handle(Geom_BSplineSurface) spline = Handle(Geom_BSplineSurface)::DownCast(copy);
  if (spline.IsNull()) return {};
  const double within = angle - poled.period * std::floor((angle - poled.from) / poled.period);
  const double tolerance = Precision::PConfusion();
  if (poled.is_u) {
    if (!spline->IsUPeriodic()) spline->SetUPeriodic();
    spline->InsertUKnot(within, 1, tolerance);
    int lower = 0, upper = 0;
    spline->LocateU(within, tolerance, lower, upper);
    spline->SetUOrigin(lower);
  } else {
    if (!spline->IsVPeriodic()) spline->SetVPeriodic();
    spline->InsertVKnot(within, 1, tolerance);
    int lower = 0, upper = 0;
    spline->LocateV(within, tolerance, lower, upper);
    spline->SetVOrigin(lower);
  }
  return Handle(Geom_Surface)(spline);
}

Handle(TCollection_HAsciiString) no_name() { return new TCollection_HAsciiString(""); }

Handle(StepShape_FaceBound) bound_of(const std::vector<StepEdge>& edges, bool orientation) {
  const Handle(StepShape_HArray1OfOrientedEdge) list = new StepShape_HArray1OfOrientedEdge(1, static_cast<int>(edges.size()));
  for (std::size_t i = 0; i < edges.size(); ++i) list->SetValue(static_cast<int>(i) + 1, edges[i]);
  const Handle(StepShape_EdgeLoop) loop = new StepShape_EdgeLoop;
  loop->Init(no_name(), list);
  const Handle(StepShape_FaceBound) bound = new StepShape_FaceBound;
  bound->Init(no_name(), loop, orientation);
  return bound;
}

/// Returns a loop up the seam of the surface and back down.
Handle(StepShape_FaceBound) seam_bound(const Handle(Geom_Surface) & surface, bool is_u) {
  double u1 = 0.0, u2 = 0.0, v1 = 0.0, v2 = 0.0;
  surface->Bounds(u1, u2, v1, v2);
  Handle(Geom_Curve) curve = is_u ? surface->UIso(u1) : surface->VIso(v1);
  const gp_Pnt from = surface->Value(u1, v1), to = is_u ? surface->Value(u1, v2) : surface->Value(u2, v1);
  if (const Handle(Geom_TrimmedCurve) trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve); !trimmed.IsNull()) curve = trimmed->BasisCurve();
  const auto vertex = [](const gp_Pnt& point) {
    const Handle(StepShape_VertexPoint) result = new StepShape_VertexPoint;
    result->Init(no_name(), GeomToStep_MakeCartesianPoint(point).Value());
    return result;
  };
  const Handle(StepShape_EdgeCurve) edge = new StepShape_EdgeCurve;
  edge->Init(no_name(), vertex(from), vertex(to), GeomToStep_MakeCurve(curve).Value(), true);
  std::vector<StepEdge> edges(2);
  for (int i = 0; i < 2; ++i) {
    edges[static_cast<std::size_t>(i)] = new StepShape_OrientedEdge;
    edges[static_cast<std::size_t>(i)]->Init(no_name(), edge, i == 0);
  }
  return bound_of(edges, true);
}

enum class Outcome { untouched, changed, failed };

class SeamGiver {
 public:
  explicit SeamGiver(const Handle(StepData_StepModel) & model) : model_(model), reader_(model) {}

  Outcome treat(const Handle(StepShape_FaceSurface) & face) {
    const Handle(StepGeom_Surface) geometry = face->FaceGeometry();
    if (geometry.IsNull() || (!geometry->IsKind(STANDARD_TYPE(StepGeom_SurfaceOfRevolution)) && !geometry->IsKind(STANDARD_TYPE(StepGeom_BSplineSurface))))
      return Outcome::untouched;
    std::vector<Hole> holes;
    bool has_vertex = false, has_seam = false, is_chained = true;
    for (int i = 1; i <= face->NbBounds(); ++i) {
      const Handle(StepShape_FaceBound) bound = face->BoundsValue(i);
      const Handle(StepShape_Loop) loop = bound->Bound();
      has_vertex = has_vertex || loop->IsKind(STANDARD_TYPE(StepShape_VertexLoop));
      const Handle(StepShape_EdgeLoop) edges = Handle(StepShape_EdgeLoop)::DownCast(loop);
      if (edges.IsNull()) continue;
      const std::size_t n_before = holes.size();
      is_chained = holes_of(bound, edges, holes) && is_chained;
      has_seam = has_seam || holes.size() == n_before || holes.back().bound.IsNull();
    }
    const bool is_crossed = std::any_of(holes.begin(), holes.end(), [](const Hole& hole) { return hole.bound.IsNull(); });
    if (holes.empty() || !is_chained || (has_seam && !is_crossed)) return Outcome::untouched;
    return give(face, holes, has_vertex || has_seam);
  }

 private:
  Outcome give(const Handle(StepShape_FaceSurface) & face, std::vector<Hole>& holes, bool is_natural) {
    const Handle(Geom_Surface) surface = StepToGeom::MakeSurface(face->FaceGeometry());
    if (surface.IsNull()) return Outcome::untouched;
    const std::optional<PoledSurface> poled = poled_surface(surface);
    if (!poled) return Outcome::untouched;
    reader_.read(face);
    for (Hole& hole : holes)
      if (!follow(hole, *poled, reader_)) return is_natural ? Outcome::failed : Outcome::untouched;
    if (std::any_of(holes.begin(), holes.end(), [](const Hole& hole) { return std::abs(hole.winding) > 0.5; })) return Outcome::untouched;
    const auto is_hole = [&](const Hole& hole) { return (hole.area < 0.0) == (hole.orientation == face->SameSense()); };
    if (!is_natural && !std::all_of(holes.begin(), holes.end(), is_hole)) return Outcome::untouched;
    // A border through a pole, such as the great circle of a half sphere, is the outer border of the face.
    if (!is_natural && std::any_of(holes.begin(), holes.end(), [](const Hole& hole) { return hole.meets_pole; })) return Outcome::untouched;
    const std::optional<double> angle = free_angle(holes, *poled);
    const Handle(Geom_Surface) result = angle ? turned(*poled, *angle) : Handle(Geom_Surface)();
    if (result.IsNull()) return Outcome::failed;
    if (result != poled->surface) face->SetFaceGeometry(GeomToStep_MakeSurface(result).Value());
    const Handle(StepShape_HArray1OfFaceBound) bounds = new StepShape_HArray1OfFaceBound(1, static_cast<int>(holes.size()) + 1);
    bounds->SetValue(1, seam_bound(result, poled->is_u));
    for (std::size_t i = 0; i < holes.size(); ++i)
      bounds->SetValue(static_cast<int>(i) + 2, holes[i].bound.IsNull() ? bound_of(holes[i].edges, holes[i].orientation) : holes[i].bound);
    face->SetBounds(bounds);
    model_->AddWithRefs(face, 0, true);
    return Outcome::changed;
  }

  Handle(StepData_StepModel) model_;
  FaceReader reader_;
};

/// Sets the units of the file as OpenCASCADE does when it translates a shape: geometry created here is then in the same units.
void set_units(const Handle(StepData_StepModel) & model) {
  for (int i = 1; i <= model->NbEntities(); ++i) {
    Handle(StepRepr_GlobalUnitAssignedContext) units;
    if (const auto a = Handle(StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext)::DownCast(model->Value(i)); !a.IsNull())
      units = a->GlobalUnitAssignedContext();
    else if (const auto b = Handle(StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx)::DownCast(model->Value(i)); !b.IsNull())
      units = b->GlobalUnitAssignedContext();
    if (units.IsNull()) continue;
    STEPConstruct_UnitContext context;
    context.ComputeFactors(units);
    StepData_GlobalFactors::Intance().InitializeFactors(context.LengthFactor(), context.PlaneAngleFactor(), context.SolidAngleFactor());
    return;
  }
}

}  // namespace

SeamReport give_seams(const Handle(StepData_StepModel) & model) {
  SeamReport report;
  SeamGiver giver(model);
  set_units(model);
  const int n_entities = model->NbEntities();
  for (int i = 1; i <= n_entities; ++i) {
    const Handle(StepShape_FaceSurface) face = Handle(StepShape_FaceSurface)::DownCast(model->Value(i));
    if (face.IsNull() || face->Bounds().IsNull()) continue;
    Outcome outcome = Outcome::failed;
    try {
      outcome = giver.treat(face);
    } catch (const Standard_Failure&) {  // a curve or surface that OpenCASCADE cannot create: its reader will report it
    }
    if (outcome == Outcome::changed) ++report.n_changed;
    if (outcome != Outcome::failed) continue;
    const bool is_named = !face->Name().IsNull() && !face->Name()->IsEmpty();
    report.failed.push_back(is_named ? face->Name()->ToCString() : "#" + std::to_string(model->IdentLabel(face)));
  }
  return report;
}

}  // namespace sterna::cad
