#include "geom/cad/heal.h"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Message_Msg.hxx>
#include <Message_MsgFile.hxx>
#include <Message_ProgressScope.hxx>
#include <Precision.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeExtend_BasicMsgRegistrator.hxx>
#include <ShapeFix_FixSmallFace.hxx>
#include <ShapeFix_Shape.hxx>
#include <ShapeFix_Solid.hxx>
#include <ShapeFix_Wireframe.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Solid.hxx>

#include <algorithm>
#include <cmath>

#include "geom/base/number_text.h"
#include "geom/cad/openings.h"

namespace sterna::cad {
namespace {

/// Gaps that sewing tries to close if the user sets no tolerance, relative to the longest side. The first one is the resolution of common modellers. The last
/// one is 0.6 mm for an airliner; larger tolerances would sew thin trailing edges together.
constexpr std::array<double, 3> k_sew_ladder = {1e-7, 1e-6, 1e-5};
/// Sewing beyond this fraction of the shortest edge merges its two ends.
constexpr double k_sew_of_shortest_edge = 0.25;
/// Edges and faces below this fraction of the longest side have no shape that a mesh could resolve.
constexpr double k_small_share = 1e-6;
/// Limit of tolerances while borders are repaired, relative to the longest side.
constexpr double k_max_tolerance_share = 1e-4;
/// Two faces are identical if area, centre and box agree to this fraction of the face's size.
constexpr double k_same_face = 1e-6;
/// A step that removes small entities may change neither the area nor the volume by more than this fraction: the required accuracy of STEP.
constexpr double k_extent_change = 1e-6;

/// A repair that changes an area or a volume by more than this fraction is reported.
constexpr double k_least_reported_change = 1e-3;

/// OpenCASCADE's message keys of repairs, in our words; other messages are reported by their key.
constexpr std::array<std::pair<const char*, const char*>, 27> k_words = {{
    {"FixWire.FixDegenerated.MSG0", "edge at a pole marked as degenerate"},
    {"FixWire.FixDegenerated.MSG5", "edge at a pole marked as degenerate"},
    {"FixWire.FixCurve3d.Removed", "edge without curves removed"},
    {"FixAdvWire.FixSmall.MSG0", "small edge removed"},
    {"FixAdvWire.FixSmall.MSG5", "small edge removed"},
    {"FixAdvWire.FixIntersection.MSG0", "border that crossed itself corrected"},
    {"FixAdvWire.FixIntersection.MSG5", "edge that crossed itself corrected"},
    {"FixAdvWire.FixIntersection.MSG10", "edges that crossed each other corrected"},
    {"FixAdvWire.FixLacking.MSG0", "missing edge of a border inserted"},
    {"FixAdvWire.FixLacking.MSG5", "missing edge of a border inserted"},
    {"FixAdvFace.FixMissingSeam.MSG0", "missing seam added"},
    {"FixAdvFace.FixSmallAreaWire.MSG0", "border without area removed"},
    {"FixAdvFace.FixOrientation.MSG0", "natural border added to a face without border"},
    {"FixAdvFace.FixOrientation.MSG5", "border that ran the wrong way reversed"},
    {"FixAdvFace.FixOrientation.MSG11", "border that cannot be oriented"},
    {"FixAdvFace.FixLoopWire.MSG0", "border split into several"},
    {"FixAdvFace.FixSpotFace.MSG0", "face as small as a point removed"},
    {"FixAdvFace.FixStripFace.MSG0", "face as narrow as a line removed"},
    {"FixWireframe.FixSmallEdges.MSG0", "small edge removed"},
    {"FixWireframe.FixSmallEdges.MSG1", "small border removed"},
    {"FixWireframe.FixSmallEdges.MSG2", "small face removed"},
    {"FixWireframe.FixFixWireGaps.MSG0", "gap in a border closed"},
    {"Fix.SplitCommonVertex.MSG0", "borders with a common corner separated"},
    {"FixEdge.SameParameter.MSG0", "curves of an edge reparametrised to agree"},
    {"FixAdvShell.FixOrientation.MSG0", "faces of a shell oriented alike"},
    {"FixAdvShell.FixOrientation.MSG30", "shell of parts that do not touch split"},
    {"FixAdvSolid.FixOrientation.MSG20", "orientation of an inside-out solid reversed"},
}};

/// Collects the messages of OpenCASCADE's fixers in their order.
class RepairNotes : public ShapeExtend_BasicMsgRegistrator {
 public:
  explicit RepairNotes(CadReport& report) : report_(report) {
    for (const auto& [key, words] : k_words) Message_MsgFile::AddMsg(key, words);
  }
  void Send(const TopoDS_Shape& shape, const Message_Msg& message, const Message_Gravity) override {
    report_.repaired.push_back({.what = TCollection_AsciiString(message.Value(), '?').ToCString(), .location = location_of(shape)});
  }
  DEFINE_STANDARD_RTTI_INLINE(RepairNotes, ShapeExtend_BasicMsgRegistrator)

 private:
  CadReport& report_;
};

struct FaceMeasure {
  double area = 0.0;
  gp_Pnt centre;
};

FaceMeasure measure(const TopoDS_Shape& face) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  return {std::abs(properties.Mass()), properties.CentreOfMass()};
}

Bnd_Box box_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  return box;
}

bool is_same_box(const Bnd_Box& a, const Bnd_Box& b) {
  if (a.IsVoid() || b.IsVoid()) return false;
  const double tolerance = k_same_face * std::sqrt(a.SquareExtent());
  return a.CornerMin().Distance(b.CornerMin()) <= tolerance && a.CornerMax().Distance(b.CornerMax()) <= tolerance;
}

/// Transfers labels to the new faces.
template <class NewShape>
void move_labels(FaceLabels& labels, const TopoDS_Shape& before, const NewShape& new_shape) {
  for (TopExp_Explorer f(before, TopAbs_FACE); f.More(); f.Next()) {
    const FaceLabel* label = labels.Seek(f.Current());
    if (!label) continue;
    const FaceLabel copy = *label;
    const TopoDS_Shape after = new_shape(f.Current());
    if (after.IsNull()) continue;
    for (TopExp_Explorer part(after, TopAbs_FACE); part.More(); part.Next()) labels.Bind(part.Current(), copy);
  }
}

/// Removes faces that occur twice in a part, or loose beside it. Contacts between solids are not duplicates.
void drop_doubled_faces(LabelledShape& labelled, CadReport& report) {
  struct Known {
    Bnd_Box box;
    TopoDS_Shape face;
    std::size_t group;
  };
  std::vector<Known> known;
  for (std::size_t p = 0; p < labelled.parts.size(); ++p) {
    ShapePart& part = labelled.parts[p];
    const bool is_loose = part.shape.ShapeType() != TopAbs_SOLID;
    const std::size_t group = is_loose ? labelled.parts.size() : p;
    const Handle(BRepTools_ReShape) context = new BRepTools_ReShape;
    bool is_changed = false;
    for (TopExp_Explorer f(part.shape, TopAbs_FACE); f.More(); f.Next()) {
      const Bnd_Box box = box_of(f.Current());
      const auto is_double = [&](const Known& other) {
        if ((other.group != group && !is_loose) || !is_same_box(box, other.box)) return false;
        const FaceMeasure a = measure(f.Current()), b = measure(other.face);
        return std::abs(a.area - b.area) <= k_same_face * b.area && a.centre.Distance(b.centre) <= k_same_face * std::sqrt(b.area);
      };
      if (std::any_of(known.begin(), known.end(), is_double)) {
        report.repaired.push_back({.what = "duplicate face removed", .location = location_of(f.Current())});
        context->Remove(f.Current());
        is_changed = true;
      } else {
        known.push_back({box, f.Current(), group});
      }
    }
    if (is_changed) part.shape = context->Apply(part.shape);
  }
  std::erase_if(labelled.parts, [](const ShapePart& part) { return part.shape.IsNull() || !TopExp_Explorer(part.shape, TopAbs_FACE).More(); });
}

/// Area of all faces, and volume if a shape is closed, else 0.
struct Extent {
  double area = 0.0, volume = 0.0;
};

Extent extent_of(const TopoDS_Shape& shape);

std::string changed_text(const char* what, double before, double after, const char* unit) {
  if (std::abs(after - before) <= k_least_reported_change * std::abs(before)) return {};
  return std::string(what) + " from " + number_text(before) + " to " + number_text(after) + " " + unit;
}

/// Warns if a repair changed the area or the volume of a part by more than rounding; the effect of a wrong border would otherwise be lost silently.
void report_change(const std::string& name, const Extent& before, const Extent& after, const Point& location, CadReport& report) {
  const std::string area = changed_text("area", before.area, after.area, "m^2");
  const std::string volume = before.volume != 0.0 && after.volume == 0.0 ? "the part is no longer closed"
                             : before.volume != 0.0                      ? changed_text("volume", before.volume, after.volume, "m^3")
                                                                         : "";
  if (area.empty() && volume.empty()) return;
  report.warnings.push_back("repairs changed \"" + name + "\" near " + format_point(location) + ": " + area + (area.empty() || volume.empty() ? "" : ", ") +
                            volume + "; compare with the program that wrote the file; heal = false reads the file without repairs");
}

/// Repairs faces, borders and shells that OpenCASCADE's check rejects.
void repair_invalid(LabelledShape& labelled, double size, CadReport& report, const Message_ProgressRange& progress, const RunContext& context) {
  Message_ProgressScope parts(progress, "mending", static_cast<double>(labelled.parts.size()));
  for (ShapePart& part : labelled.parts) {
    context.check_stop();
    const Message_ProgressRange range = parts.Next();
    if (BRepCheck_Analyzer(part.shape).IsValid()) continue;
    const Extent before = extent_of(part.shape);
    const Handle(ShapeBuild_ReShape) changes = new ShapeBuild_ReShape;
    const Handle(ShapeFix_Shape) fixer = new ShapeFix_Shape(part.shape);
    fixer->SetContext(changes);
    fixer->SetMsgRegistrator(new RepairNotes(report));
    fixer->SetMaxTolerance(std::max(k_max_tolerance_share * size, Precision::Confusion()));
    fixer->Perform(range);
    move_labels(labelled.labels, part.shape, [&](const TopoDS_Shape& face) { return changes->Apply(face); });
    part.shape = fixer->Shape();
    if (!part.shape.IsNull()) report_change(part.component, before, extent_of(part.shape), location_of(part.shape), report);
  }
  std::erase_if(labelled.parts, [](const ShapePart& part) { return part.shape.IsNull() || !TopExp_Explorer(part.shape, TopAbs_FACE).More(); });
}

double length_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::LinearProperties(shape, properties);
  return properties.Mass();
}

bool has_small_edges(const TopoDS_Shape& shape, double small) {
  for (TopExp_Explorer e(shape, TopAbs_EDGE); e.More(); e.Next())
    if (!BRep_Tool::Degenerated(TopoDS::Edge(e.Current())) && length_of(e.Current()) < small) return true;
  return false;
}

/// Returns true if there are spot or strip faces: the area is less than that of a band of width `small` along half the border.
bool has_small_faces(const TopoDS_Shape& shape, double small) {
  for (TopExp_Explorer f(shape, TopAbs_FACE); f.More(); f.Next())
    if (measure(f.Current()).area < 0.5 * small * length_of(f.Current())) return true;
  return false;
}

/// Returns true if every edge joins two faces, or a face with itself, and none is used more often.
bool is_closed(const TopoDS_Shape& shape) {
  TopTools_IndexedDataMapOfShapeListOfShape faces;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces);
  for (int e = 1; e <= faces.Extent(); ++e)
    if (faces(e).Extent() != 2 && !BRep_Tool::Degenerated(TopoDS::Edge(faces.FindKey(e)))) return false;
  return true;
}

/// Computes the volume about the middle of the box: relative to a distant reference point a narrow gap would count as volume. Returns nothing for open shapes.
double volume_of(const TopoDS_Shape& shape, const gp_Pnt& about) {
  if (!is_closed(shape)) return 0.0;
  GProp_GProps properties(about);
  BRepGProp::VolumeProperties(shape, properties);
  return std::abs(properties.Mass());
}

Extent extent_of(const TopoDS_Shape& shape) {
  const Bnd_Box box = box_of(shape);
  if (box.IsVoid()) return {};
  return {measure(shape).area, volume_of(shape, gp_Pnt(0.5 * (box.CornerMin().XYZ() + box.CornerMax().XYZ())))};
}

bool is_same_extent(double before, double after) { return std::abs(after - before) <= k_extent_change * before; }

/// Accepts the result of a step that removes small entities, unless it changed area or volume: then the step did more harm than good. An example is a strip
/// along a long trailing edge: removing it can change the volume of a thin wing by a larger fraction than its area.
void accept(ShapePart& part, LabelledShape& labelled, const TopoDS_Shape& result, const Handle(ShapeBuild_ReShape) & changes, std::size_t n_notes_before,
            const char* what, CadReport& report) {
  if (result.IsNull()) return;
  const Bnd_Box box = box_of(part.shape);
  const gp_Pnt middle(0.5 * (box.CornerMin().XYZ() + box.CornerMax().XYZ()));
  const bool is_same_area = is_same_extent(measure(part.shape).area, measure(result).area);
  if (!is_same_area || !is_same_extent(volume_of(part.shape, middle), volume_of(result, middle))) {
    const Point location = report.repaired.size() > n_notes_before ? report.repaired[n_notes_before].location : location_of(part.shape);
    report.repaired.resize(n_notes_before);
    report.warnings.push_back(std::string(what) + " near " + format_point(location) + " were kept: removing them would change the " +
                              (is_same_area ? "volume" : "area") + " by more than a fraction of 1e-6");
    return;
  }
  move_labels(labelled.labels, part.shape, [&](const TopoDS_Shape& face) { return changes->Apply(face); });
  part.shape = result;
}

void drop_small(LabelledShape& labelled, double small, CadReport& report, const RunContext& context) {
  for (ShapePart& part : labelled.parts) {
    context.check_stop();
    if (has_small_edges(part.shape, small)) {
      const Handle(ShapeBuild_ReShape) changes = new ShapeBuild_ReShape;
      ShapeFix_Wireframe fixer(part.shape);
      fixer.SetContext(changes);
      const std::size_t n_before = report.repaired.size();
      fixer.SetMsgRegistrator(new RepairNotes(report));
      fixer.SetPrecision(small);
      fixer.ModeDropSmallEdges() = true;
      fixer.FixSmallEdges();
      accept(part, labelled, fixer.Shape(), changes, n_before, "small edges", report);
    }
    if (has_small_faces(part.shape, small)) {
      const Handle(ShapeBuild_ReShape) changes = new ShapeBuild_ReShape;
      ShapeFix_FixSmallFace fixer;
      fixer.Init(part.shape);
      fixer.SetContext(changes);
      const std::size_t n_before = report.repaired.size();
      fixer.SetMsgRegistrator(new RepairNotes(report));
      fixer.SetPrecision(small);
      fixer.Perform();
      accept(part, labelled, fixer.Shape(), changes, n_before, "small faces", report);
    }
  }
}

int count_free_edges(const std::vector<TopoDS_Shape>& shapes) {
  TopTools_IndexedDataMapOfShapeListOfShape faces;
  for (const TopoDS_Shape& shape : shapes) TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces);
  int n_free = 0;
  for (int e = 1; e <= faces.Extent(); ++e) {
    const TopoDS_Edge& edge = TopoDS::Edge(faces.FindKey(e));
    n_free += faces(e).Extent() == 1 && !BRep_Tool::Degenerated(edge) && !BRep_Tool::IsClosed(edge, TopoDS::Face(faces(e).First()));
  }
  return n_free;
}

/// Returns the length of the shortest edge, ignoring edges so small that sewing may remove them.
double shortest_edge(const std::vector<TopoDS_Shape>& shapes, double small) {
  double shortest = Precision::Infinite();
  for (const TopoDS_Shape& shape : shapes)
    for (TopExp_Explorer e(shape, TopAbs_EDGE); e.More(); e.Next())
      if (const double length = BRep_Tool::Degenerated(TopoDS::Edge(e.Current())) ? 0.0 : length_of(e.Current()); length > small)
        shortest = std::min(shortest, length);
  return shortest;
}

std::vector<double> sewing_tolerances(const ReadCadOptions& options, double size, double shortest) {
  if (!is_automatic(options.sew_tolerance)) return {options.sew_tolerance};
  std::vector<double> tolerances;
  for (const double share : k_sew_ladder) {
    const double tolerance = std::max(share * size, Precision::Confusion());
    if (tolerance <= k_sew_of_shortest_edge * shortest && (tolerances.empty() || tolerance > tolerances.back())) tolerances.push_back(tolerance);
  }
  return tolerances;
}

std::vector<TopoDS_Shape> open_shapes(const LabelledShape& labelled) {
  std::vector<TopoDS_Shape> open;
  for (const ShapePart& part : labelled.parts)
    if (count_free_edges({part.shape}) > 0) open.push_back(part.shape);
  return open;
}

/// Sews open shells and loose faces of all parts with the first tolerance that leaves the fewest free edges. `may_drop`: entities smaller than the tolerance
/// are removed.
void sew_open_parts(LabelledShape& labelled, const std::vector<TopoDS_Shape>& open, const std::vector<double>& tolerances, bool may_drop, CadReport& report,
                    const Message_ProgressRange& progress, const RunContext& context) {
  const int n_before = count_free_edges(open);
  Message_ProgressScope tries(progress, "sewing", static_cast<double>(std::max<std::size_t>(tolerances.size(), 1)));
  Handle(BRepBuilderAPI_Sewing) best;
  int n_best = n_before;
  for (const double tolerance : tolerances) {
    context.check_stop();
    const Handle(BRepBuilderAPI_Sewing) sewing = new BRepBuilderAPI_Sewing(tolerance, true, may_drop);
    for (const TopoDS_Shape& shape : open)
      for (TopExp_Explorer f(shape, TopAbs_FACE); f.More(); f.Next()) sewing->Add(f.Current());
    sewing->Perform(tries.Next());
    context.check_stop();
    if (sewing->SewedShape().IsNull()) continue;
    const int n_free = count_free_edges({sewing->SewedShape()});
    if (n_free < n_best) {
      best = sewing;
      n_best = n_free;
    }
    if (n_free == 0) break;
  }
  if (best.IsNull()) return;
  for (int i = 1; i <= best->NbContigousEdges(); ++i) {
    const TopoDS_Edge& edge = best->ContigousEdge(i);
    report.repaired.push_back(
        {.what = "edges of two faces joined", .location = location_of(edge), .value = std::min(BRep_Tool::Tolerance(edge), best->Tolerance())});
  }
  for (int i = 1; i <= best->NbDeletedFaces(); ++i)
    report.repaired.push_back({.what = "face without extent removed", .location = location_of(best->DeletedFace(i))});
  for (const TopoDS_Shape& shape : open) move_labels(labelled.labels, shape, [&](const TopoDS_Shape& face) { return best->Modified(face); });
  std::erase_if(labelled.parts,
                [&](const ShapePart& part) { return std::any_of(open.begin(), open.end(), [&](const TopoDS_Shape& s) { return s.IsSame(part.shape); }); });
  const auto add = [&](const TopoDS_Shape& shape) {
    const FaceLabel* label = labelled.labels.Seek(TopExp_Explorer(shape, TopAbs_FACE).Current());
    labelled.parts.push_back({.shape = shape, .component = label ? label->component : std::string(), .name = {}, .label = {}});
  };
  for (TopExp_Explorer s(best->SewedShape(), TopAbs_SHELL); s.More(); s.Next()) add(s.Current());
  for (TopExp_Explorer f(best->SewedShape(), TopAbs_FACE, TopAbs_SHELL); f.More(); f.Next()) add(f.Current());
}

/// Joins faces in two steps: first with tolerances that are small relative to the model; then pairs of edges that share their ends but bulge apart, with the
/// gap between them as tolerance.
void join_faces(LabelledShape& labelled, const ReadCadOptions& options, double size, double small, CadReport& report, const Message_ProgressRange& progress,
                const RunContext& context) {
  Message_ProgressScope steps(progress, "joining", 2.0);
  std::vector<TopoDS_Shape> open = open_shapes(labelled);
  const Message_ProgressRange first = steps.Next();
  if (open.empty()) return;
  sew_open_parts(labelled, open, sewing_tolerances(options, size, shortest_edge(open, small)), true, report, first, context);
  if (!is_automatic(options.sew_tolerance)) return;
  open = open_shapes(labelled);
  constexpr double k_margin = 1.1;  // the gap is measured at samples only, so it may be larger between them
  if (const double gap = k_margin * gap_of_pairs(open, small); gap > 0.0) sew_open_parts(labelled, open, {gap}, false, report, steps.Next(), context);
}

/// Makes solids of closed shells, with faces oriented outwards.
void make_solids(LabelledShape& labelled, CadReport& report) {
  for (ShapePart& part : labelled.parts) {
    if (part.shape.ShapeType() == TopAbs_SHELL && is_closed(part.shape)) {
      part.shape = ShapeFix_Solid().SolidFromShell(TopoDS::Shell(part.shape));
      report.repaired.push_back({.what = "closed shell turned into a solid", .location = location_of(part.shape)});
    } else if (part.shape.ShapeType() == TopAbs_SOLID) {
      TopoDS_Solid solid = TopoDS::Solid(part.shape);
      GProp_GProps volume;
      BRepGProp::VolumeProperties(solid, volume);
      if (volume.Mass() >= 0.0 || count_free_edges({solid}) > 0) continue;
      if (!BRepLib::OrientClosedSolid(solid)) continue;
      part.shape = solid;
      report.repaired.push_back({.what = "orientation of an inside-out solid reversed", .location = location_of(part.shape)});
    }
  }
}

}  // namespace

void heal(LabelledShape& labelled, const ReadCadOptions& options, CadReport& report, const Message_ProgressRange& progress, const RunContext& context) {
  const double size = longest_side(compound_of(labelled.parts));
  const double small = is_automatic(options.small) ? k_small_share * size : options.small;
  Message_ProgressScope steps(progress, "healing", 2.0);
  drop_doubled_faces(labelled, report);
  repair_invalid(labelled, size, report, steps.Next(), context);
  drop_small(labelled, small, report, context);
  const double area = extent_of(compound_of(labelled.parts)).area;
  join_faces(labelled, options, size, small, report, steps.Next(), context);
  report_change("all faces", {.area = area}, {.area = extent_of(compound_of(labelled.parts)).area}, location_of(compound_of(labelled.parts)), report);
  if (options.cap) cap_openings(labelled, report);
  make_solids(labelled, report);
}

}  // namespace sterna::cad
