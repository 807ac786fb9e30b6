#include "geom/cad/split_closed.h"

#include <BRepBuilderAPI_Copy.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeUpgrade_ShapeDivideClosed.hxx>
#include <TopExp_Explorer.hxx>

#include <cmath>

#include "geom/base/error.h"
#include "geom/cad/face_origins.h"
#include "geom/cad/occt_call.h"
#include "geom/model/model_measures.h"

namespace sterna::cad {
namespace {

constexpr const char* k_split_attempt = "splitting closed faces";
/// Areas and volumes before and after must agree to this fraction.
constexpr double k_same_split = 1e-6;

bool has_seam(const Model& model) {
  const auto uses = uses_of_edges(model);
  for (const EdgeId e : model.edges.ids())
    if (uses[e].size() == 2 && uses[e][0].face == uses[e][1].face && !model.edges[e].is_degenerate()) return true;
  return false;
}

bool is_same(const Model& a, const Model& b, const RunContext& context) {
  if (a.solids.size() != b.solids.size() || free_edges(a).size() != free_edges(b).size()) return false;
  const ModelMeasures before = model_measures(a, context), after = model_measures(b, context);
  const auto agree = [](double x, double y) { return std::abs(x - y) <= k_same_split * std::abs(x); };
  for (std::size_t s = 0; s < before.solids.size(); ++s)
    if (before.solids[s].has_volume != after.solids[s].has_volume || !agree(before.solids[s].area, after.solids[s].area) ||
        !agree(before.solids[s].volume, after.solids[s].volume))
      return false;
  return agree(before.total.area, after.total.area);
}

}  // namespace

std::optional<Model> split_closed_faces(const Model& model, const RunContext& context) {
  if (!has_seam(model)) return std::nullopt;
  const std::shared_ptr<const CadShape> shape = shape_of(model, context);
  const std::vector<BooleanPart> parts = {BooleanPart{.model = &model, .shape = shape}};
  std::optional<Model> result;
  try {
    run_occt({.attempted = k_split_attempt}, context, [&](const Message_ProgressRange&) {
      const CadShape::Content& content = shape->content();
      BRepBuilderAPI_Copy copy(content.shape, false);  // OpenCASCADE adds curves to the edges of the shapes that it splits
      ShapeUpgrade_ShapeDivideClosed divide(copy.Shape());
      divide.SetNbSplitPoints(1);
      divide.SetSurfaceSegmentMode(false);
      divide.Perform();
      if (divide.Result().IsNull()) return;
      FaceOrigins origins;
      for (std::size_t f = 0; f < content.faces.size(); ++f) {
        const TopoDS_Shape after = divide.GetContext()->Apply(copy.ModifiedShape(content.faces[f]));
        for (TopExp_Explorer piece(after, TopAbs_FACE); piece.More(); piece.Next())
          if (!origins.IsBound(piece.Current())) origins.Bind(piece.Current(), {0, FaceId(f)});
      }
      Model split = model_of(labelled(divide.Result(), origins, parts), k_split_attempt, context);
      std::vector<FaceOrigin> of_face;
      if (!restore_origins(split, origins, parts, of_face).empty()) return;
      result = std::move(split);
    });
  } catch (const Error& error) {
    if (error.code() != ErrorCode::geometry_failed) throw;
    return std::nullopt;
  }
  if (!result || !is_same(model, *result, context)) return std::nullopt;
  for (std::size_t s = 0; s < model.solids.size(); ++s) result->solids[SolidId(s)].name = model.solids[SolidId(s)].name;
  result->source_unit = model.source_unit;
  return result;
}

}  // namespace sterna::cad
