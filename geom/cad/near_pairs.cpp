// Every B-spline is refined by knots until it has k_pieces pieces along each direction; the poles of a piece enclose it. Pairs are dropped if the boxes of all
// their pieces, enlarged by the tolerances, are disjoint.
#include "geom/cad/near_pairs.h"

#include <BOPDS_DS.hxx>
#include <BOPDS_Iterator.hxx>
#include <BOPDS_Pair.hxx>
#include <BOPDS_Tools.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Precision.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "geom/mesh/bvh.h"

namespace sterna::cad {
namespace {

/// Number of pieces along each parameter of a face or edge. The boxes of the pieces then measure a few per cent of a wing's chord and span.
constexpr int k_pieces = 48;

Box box_of(const Bnd_Box& bounds) {
  Box box;
  if (bounds.IsVoid()) return box;
  double a[3], b[3];
  bounds.Get(a[0], a[1], a[2], b[0], b[1], b[2]);
  box.add(Vec3{a[0], a[1], a[2]});
  box.add(Vec3{b[0], b[1], b[2]});
  return box;
}

Box with_margin(Box box, double margin) {
  const Vec3 by{margin, margin, margin};
  box.min -= by;
  box.max += by;
  return box;
}

/// Returns knots to insert so that [from, to] has k_pieces pieces or more. Edges may extend beyond their spline by rounding, where no knot can be inserted.
std::vector<double> finer_knots(const TColStd_Array1OfReal& knots, double from, double to) {
  from = std::max(from, knots.First());
  to = std::min(to, knots.Last());
  std::vector<double> inside;
  for (int i = knots.Lower(); i <= knots.Upper(); ++i)
    if (knots(i) > from && knots(i) < to) inside.push_back(knots(i));
  inside.insert(inside.begin(), from);
  inside.push_back(to);
  const int parts = (k_pieces + static_cast<int>(inside.size()) - 2) / (static_cast<int>(inside.size()) - 1);
  std::vector<double> added;
  for (std::size_t i = 0; i + 1 < inside.size(); ++i)
    for (int k = 1; k < parts; ++k) added.push_back(inside[i] + (inside[i + 1] - inside[i]) * k / parts);
  return added;
}

template <class Insert>
void insert_knots(const std::vector<double>& added, const Insert& insert) {
  if (added.empty()) return;
  TColStd_Array1OfReal knots(1, static_cast<int>(added.size()));
  TColStd_Array1OfInteger multiplicities(1, static_cast<int>(added.size()));
  for (int i = 1; i <= knots.Length(); ++i) {
    knots(i) = added[static_cast<std::size_t>(i - 1)];
    multiplicities(i) = 1;
  }
  insert(knots, multiplicities);
}

/// Returns the first pole (from 1) of each piece that overlaps [from, to].
std::vector<int> first_poles(const TColStd_Array1OfReal& knots, const TColStd_Array1OfInteger& multiplicities, int degree, double from, double to) {
  std::vector<int> firsts;
  int location = 0;
  for (int i = knots.Lower(); i < knots.Upper(); ++i) {
    location += multiplicities(i);
    if (knots(i) <= to && knots(i + 1) >= from) firsts.push_back(location - degree);
  }
  return firsts;
}

/// Returns the boxes of the pieces of an edge; one box if it is not a B-spline.
std::vector<Box> pieces_of(const TopoDS_Edge& edge, const Bnd_Box& whole, double margin) {
  TopLoc_Location location;
  double from = 0.0, to = 0.0;
  Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, location, from, to);
  if (const Handle(Geom_TrimmedCurve) trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve); !trimmed.IsNull()) curve = trimmed->BasisCurve();
  Handle(Geom_BSplineCurve) spline = Handle(Geom_BSplineCurve)::DownCast(curve);
  if (spline.IsNull() || !location.IsIdentity() || spline->IsPeriodic()) return {box_of(whole)};
  spline = Handle(Geom_BSplineCurve)::DownCast(spline->Copy());
  insert_knots(finer_knots(spline->Knots(), from, to),
               [&](const TColStd_Array1OfReal& knots, const TColStd_Array1OfInteger& m) { spline->InsertKnots(knots, m); });
  std::vector<Box> boxes;
  for (const int first : first_poles(spline->Knots(), spline->Multiplicities(), spline->Degree(), from, to)) {
    Box box;
    for (int k = 0; k <= spline->Degree(); ++k) {
      const gp_Pnt p = spline->Pole(first + k);
      box.add(Vec3{p.X(), p.Y(), p.Z()});
    }
    boxes.push_back(with_margin(box, margin));
  }
  return boxes;
}

std::vector<Box> pieces_of(const TopoDS_Face& face, const Bnd_Box& whole, double margin) {
  TopLoc_Location location;
  Handle(Geom_BSplineSurface) spline = Handle(Geom_BSplineSurface)::DownCast(BRep_Tool::Surface(face, location));
  if (spline.IsNull() || !location.IsIdentity() || spline->IsUPeriodic() || spline->IsVPeriodic()) return {box_of(whole)};
  double u0 = 0.0, u1 = 0.0, v0 = 0.0, v1 = 0.0;
  BRepTools::UVBounds(face, u0, u1, v0, v1);
  spline = Handle(Geom_BSplineSurface)::DownCast(spline->Copy());
  insert_knots(finer_knots(spline->UKnots(), u0, u1),
               [&](const TColStd_Array1OfReal& knots, const TColStd_Array1OfInteger& m) { spline->InsertUKnots(knots, m); });
  insert_knots(finer_knots(spline->VKnots(), v0, v1),
               [&](const TColStd_Array1OfReal& knots, const TColStd_Array1OfInteger& m) { spline->InsertVKnots(knots, m); });
  const std::vector<int> firsts_u = first_poles(spline->UKnots(), spline->UMultiplicities(), spline->UDegree(), u0, u1);
  const std::vector<int> firsts_v = first_poles(spline->VKnots(), spline->VMultiplicities(), spline->VDegree(), v0, v1);
  std::vector<Box> boxes;
  for (const int u : firsts_u)
    for (const int v : firsts_v) {
      Box box;
      for (int i = 0; i <= spline->UDegree(); ++i)
        for (int j = 0; j <= spline->VDegree(); ++j) {
          const gp_Pnt p = spline->Pole(u + i, v + j);
          box.add(Vec3{p.X(), p.Y(), p.Z()});
        }
      boxes.push_back(with_margin(box, margin));
    }
  return boxes;
}

class NearPairs : public BOPDS_Iterator {
 public:
  NearPairs(const Handle(NCollection_BaseAllocator) & allocator, const RunContext& context) : BOPDS_Iterator(allocator), context_(context) {}

 protected:
  void Intersect(const Handle(IntTools_Context) & tools, const Standard_Boolean check_obb, const Standard_Real fuzzy) override {
    BOPDS_Iterator::Intersect(tools, check_obb, fuzzy);
    for (const auto& [a, b] : {std::pair{TopAbs_EDGE, TopAbs_FACE}, {TopAbs_FACE, TopAbs_FACE}, {TopAbs_EDGE, TopAbs_EDGE}}) {
      BOPDS_VectorOfPair& pairs = myLists(BOPDS_Tools::TypeToInteger(a, b));
      BOPDS_VectorOfPair near(pairs);
      near.Clear();
      for (const BOPDS_Pair& pair : pairs) {
        int i = 0, j = 0;
        pair.Indices(i, j);
        context_.check_stop();
        if (are_near(i, j, fuzzy)) near.Append(pair);
      }
      pairs = near;
    }
  }

 private:
  const BoxTree& pieces(int index, double fuzzy) {
    std::unique_ptr<BoxTree>& tree = trees_[index];
    if (tree) return *tree;
    const TopoDS_Shape& shape = myDS->ShapeInfo(index).Shape();
    const Bnd_Box& whole = myDS->ShapeInfo(index).Box();
    const bool is_face = shape.ShapeType() == TopAbs_FACE;
    const double tolerance = is_face ? BRep_Tool::Tolerance(TopoDS::Face(shape)) : BRep_Tool::Tolerance(TopoDS::Edge(shape));
    // Twice the margin by which OpenCASCADE enlarges its own boxes.
    const double margin = 2.0 * (tolerance + std::max(fuzzy, Precision::Confusion()));
    std::vector<Box> boxes;
    try {
      boxes = is_face ? pieces_of(TopoDS::Face(shape), whole, margin) : pieces_of(TopoDS::Edge(shape), whole, margin);
    } catch (const Standard_Failure&) {  // a spline that accepts no more knots: its whole box is also correct
      boxes = {box_of(whole)};
    }
    tree = std::make_unique<BoxTree>(std::move(boxes), context_);
    return *tree;
  }

  bool are_near(int i, int j, double fuzzy) {
    const BoxTree &a = pieces(i, fuzzy), &b = pieces(j, fuzzy);
    for (const Box& box : a.boxes()) {
      bool is_found = false;
      b.for_each_overlap(box, [&](std::uint32_t) {
        is_found = true;
        return false;
      });
      if (is_found) return true;
    }
    return false;
  }

  RunContext context_;
  std::map<int, std::unique_ptr<BoxTree>> trees_;
};

}  // namespace

void NearPairsFiller::Init(const Message_ProgressRange& range) {
  BOPAlgo_PaveFiller::Init(range);
  if (HasErrors()) return;
  // The filler deletes its iterator through the base class, and has the same pointer until the next one exists.
  static_assert(std::has_virtual_destructor_v<BOPDS_Iterator>);
  delete std::exchange(myIterator, new NearPairs(myAllocator, context_));
  myIterator->SetRunParallel(myRunParallel);
  myIterator->SetDS(myDS);
  myIterator->Prepare(myContext, myUseOBB, myFuzzyValue);
}

}  // namespace sterna::cad
