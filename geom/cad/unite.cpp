// OpenCASCADE's general fuse with growing tolerances. Steps of a try: fuse, origins of the faces, model, proof. When no tolerance is enough, pairs are tried
// one by one, to name the one that fails.
#include "geom/cad/unite.h"

#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBndLib.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "geom/cad/occt_call.h"
#include "geom/cad/occt_shape.h"

namespace sterna::cad {
namespace {

/// Tolerances that are tried, as shares of the longest side: exact first, the last is a tenth of what a mesh of a wing's leading edge resolves.
constexpr std::array<double, 5> k_ladder = {0.0, 1e-7, 1e-6, 1e-5, 1e-4};
/// Volumes agree to this share of the sum: parts that only touch lose or gain by the tolerance of the fuse.
constexpr double k_volume_share = 1e-4;
/// Surfaces that meet at a smaller angle, radians, are nearly tangent: elements between them become slivers.
constexpr double k_tangent_angle = 10.0 * std::numbers::pi / 180.0;
/// Places that an error lists.
constexpr std::size_t k_listed = 5;

struct Part {
  const Model* model;
  std::shared_ptr<const CadShape> shape;
  double volume = 0.0;
  std::string name() const { return model->components.empty() ? std::string("unnamed") : model->components.raw().front().name; }
};

/// Where a face of the result came from.
struct Origin {
  std::size_t part = 0;
  FaceId face;
};
using Origins = NCollection_DataMap<TopoDS_Shape, Origin, TopTools_ShapeMapHasher>;

struct Try {
  Model model;
  std::vector<Origin> origin_of_face;
  double volume = 0.0;
  UniteTry outcome;
};

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps volume;
  BRepGProp::VolumeProperties(shape, volume, 1e-6);
  return volume.Mass();
}

/// Result faces by the faces of the parts they are pieces of.
Origins origins_of(BRepAlgoAPI_Fuse& fuse, const std::vector<Part>& parts) {
  Origins origins;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::vector<TopoDS_Face>& faces = parts[p].shape->content().faces;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto add = [&](const TopoDS_Shape& piece) {
        if (!origins.IsBound(piece)) origins.Bind(piece, {p, FaceId(static_cast<std::uint64_t>(f))});
      };
      const TopTools_ListOfShape& pieces = fuse.Modified(faces[f]);
      for (const TopoDS_Shape& piece : pieces) add(piece);
      if (pieces.IsEmpty() && !fuse.IsDeleted(faces[f])) add(faces[f]);
    }
  }
  return origins;
}

LabelledShape label(const TopoDS_Shape& shape, const Origins& origins, const std::vector<Part>& parts) {
  LabelledShape labelled;
  labelled.parts.push_back({.shape = shape, .component = parts.front().name(), .name = {}, .label = {}});
  for (Origins::Iterator it(origins); it.More(); it.Next()) {
    const Model& model = *parts[it.Value().part].model;
    const ModelFace& face = model.faces[it.Value().face];
    labelled.labels.Bind(it.Key(), {.name = face.name, .colour = face.colour, .layer = face.layer, .component = model.components[face.component].name});
  }
  return labelled;
}

/// Roles, kinds and the very surfaces of the parts.
std::string restore_origins(Try& result, const Origins& origins, const std::vector<Part>& parts) {
  const CadShape::Content& content = result.model.shape->content();
  for (const FaceId f : result.model.faces.ids()) {
    const Origin* origin = origins.Seek(content.faces[f.index()]);
    if (!origin) return "a face of the result comes from no part";
    const Model& model = *parts[origin->part].model;
    const ModelFace& from = model.faces[origin->face];
    ModelFace& face = result.model.faces[f];
    face.role = from.role;
    result.model.components[face.component].kind = model.components[from.component].kind;
    TopLoc_Location place, from_place;
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(content.faces[f.index()], place);
    const Handle(Geom_Surface) from_surface = BRep_Tool::Surface(parts[origin->part].shape->content().faces[origin->face.index()], from_place);
    if (surface == from_surface && place.IsEqual(from_place)) face.surface = from.surface;
    result.origin_of_face.push_back(*origin);
  }
  return {};
}

/// What is wrong with a result; empty: nothing.
std::string objection(Try& result, const std::vector<Part>& parts) {
  result.outcome.places = faults_of(*result.model.shape);
  if (!result.outcome.places.empty()) return "the result is not valid: " + result.outcome.places.front().what;
  const bool is_closed = !result.model.solids.empty() && std::all_of(result.model.solids.begin(), result.model.solids.end(), [](const ModelSolid& s) { return s.is_closed; });
  if (!is_closed) {
    for (const EdgeId e : free_edges(result.model)) {
      const ModelEdge& edge = result.model.edges[e];
      result.outcome.places.push_back({edge.curve->point(0.5 * (edge.range.from + edge.range.to)), "open edge"});
    }
    return "the result is not closed";
  }
  double sum = 0.0, largest = 0.0;
  for (const Part& part : parts) {
    sum += part.volume;
    largest = std::max(largest, part.volume);
  }
  result.volume = volume_of(result.model.shape->content().shape);
  if (result.volume < largest - k_volume_share * sum || result.volume > sum * (1.0 + k_volume_share))
    return "the volume of the result, " + std::to_string(result.volume) + " m^3, is not between that of the largest part, " + std::to_string(largest) + ", and the sum, " + std::to_string(sum);
  return {};
}

Try fuse_once(const std::vector<Part>& parts, double tolerance, const UniteOptions& options, const RunContext& context) {
  Try result;
  result.outcome.tolerance = tolerance;
  try {
    run_occt({.attempted = "uniting the parts", .time_limit = options.time_limit}, context, [&](const Message_ProgressRange& progress) {
      TopTools_ListOfShape first, others;
      for (std::size_t p = 0; p < parts.size(); ++p) (p == 0 ? first : others).Append(parts[p].shape->content().shape);
      BRepAlgoAPI_Fuse fuse;
      fuse.SetArguments(first);
      fuse.SetTools(others);
      fuse.SetNonDestructive(true);
      fuse.SetRunParallel(false);
      if (tolerance > 0.0) fuse.SetFuzzyValue(tolerance);
      fuse.Build(progress);
      context.check_stop();
      if (fuse.HasErrors() || !fuse.IsDone() || fuse.Shape().IsNull()) {
        result.outcome.problem = "OpenCASCADE's fuse ended with an error";
        return;
      }
      const Origins origins = origins_of(fuse, parts);
      result.model = model_of(label(fuse.Shape(), origins, parts), "uniting the parts", context);
      result.outcome.problem = restore_origins(result, origins, parts);
      if (result.outcome.problem.empty()) result.outcome.problem = objection(result, parts);
    });
  } catch (const Error& error) {
    if (error.code() != ErrorCode::geometry_failed) throw;
    result.outcome.problem = error.info().problem;  // a larger tolerance may do
    result.outcome.places = error.info().places;
  }
  return result;
}

double size_of(const std::vector<Part>& parts) {
  double size = 0.0;
  for (const Part& part : parts) size = std::max(size, longest_side(part.shape->content().shape));
  return size;
}

std::vector<double> tolerances(const UniteOptions& options, double size) {
  if (!is_automatic(options.tolerance)) return {options.tolerance};
  std::vector<double> result;
  for (const double share : k_ladder) result.push_back(share * size);
  return result;
}

std::optional<Try> climb(const std::vector<Part>& parts, const UniteOptions& options, double size, std::vector<UniteTry>& tries, const RunContext& context) {
  for (const double tolerance : tolerances(options, size)) {
    Try result = fuse_once(parts, tolerance, options, context);
    tries.push_back(result.outcome);
    if (result.outcome.problem.empty()) return result;
    context.debug("union with tolerance " + std::to_string(tolerance) + " m: " + result.outcome.problem);
  }
  return std::nullopt;
}

std::vector<Part> take_parts(std::span<const Model> models, const RunContext& context) {
  std::vector<Part> parts;
  for (const Model& model : models) {
    Part part{&model, shape_of(model, context)};
    const bool is_closed = !model.solids.empty() && std::all_of(model.solids.begin(), model.solids.end(), [](const ModelSolid& s) { return s.is_closed; });
    if (!is_closed) {
      ErrorInfo info{.code = ErrorCode::open_surface, .attempted = "uniting the parts", .problem = "\"" + part.name() + "\" is not closed", .hint = "only closed parts have an inside"};
      for (const EdgeId e : free_edges(model)) {
        const ModelEdge& edge = model.edges[e];
        if (info.places.size() < k_listed) info.places.push_back({edge.curve->point(0.5 * (edge.range.from + edge.range.to)), "open edge"});
      }
      throw Error(std::move(info));
    }
    run_occt({.attempted = "measuring \"" + part.name() + "\""}, context, [&](const Message_ProgressRange&) { part.volume = volume_of(part.shape->content().shape); });
    parts.push_back(part);
  }
  return parts;
}

bool is_near(const Part& a, const Part& b, double gap) {
  Bnd_Box box_a, box_b;
  BRepBndLib::Add(a.shape->content().shape, box_a, false);
  BRepBndLib::Add(b.shape->content().shape, box_b, false);
  box_a.Enlarge(gap);
  return !box_a.IsOut(box_b);
}

/// \throws Error(geometry_failed): names the first pair that does not unite alone.
[[noreturn]] void blame(const std::vector<Part>& parts, const UniteOptions& options, double size, const std::vector<UniteTry>& tries, const RunContext& context) {
  ErrorInfo info{.code = ErrorCode::geometry_failed, .attempted = "uniting " + std::to_string(parts.size()) + " parts"};
  const UniteTry* blamed = &tries.back();
  std::vector<UniteTry> pair_tries;
  for (std::size_t a = 0; a < parts.size() && info.problem.empty() && parts.size() > 2; ++a)
    for (std::size_t b = a + 1; b < parts.size() && info.problem.empty(); ++b) {
      if (!is_near(parts[a], parts[b], k_ladder.back() * size)) continue;
      pair_tries.clear();
      if (climb({parts[a], parts[b]}, options, size, pair_tries, context)) continue;
      blamed = &pair_tries.back();
      info.problem = "\"" + parts[a].name() + "\" and \"" + parts[b].name() + "\" do not unite: " + blamed->problem;
    }
  if (info.problem.empty()) {
    std::string names;
    for (const Part& part : parts) names += (names.empty() ? "\"" : ", \"") + part.name() + "\"";
    info.problem = names + " do not unite: " + blamed->problem;
  }
  info.problem += "; tried up to a tolerance of " + std::to_string(blamed->tolerance) + " m";
  info.n_places = static_cast<std::int64_t>(blamed->places.size());
  info.places.assign(blamed->places.begin(), blamed->places.begin() + static_cast<std::ptrdiff_t>(std::min(k_listed, blamed->places.size())));
  info.hint = "move or turn one of them a little, so that surfaces neither coincide nor touch tangentially";
  throw Error(std::move(info));
}

/// Outward normal of a face beside the middle of one of its edges.
Vec3 normal_at(const Model& model, const EdgeUsePlace& place) {
  const ModelFace& face = model.faces[place.face];
  const EdgeUse& use = face.borders[place.border][place.place];
  const Interval range = model.edges[use.edge].range;
  const SurfaceDerivatives d = face.surface->derivatives(use.parameter->point(0.5 * (range.from + range.to)));
  const Vec3 normal = normalized(cross(d.du, d.dv));
  return face.is_reversed ? -normal : normal;
}

/// Joins between parts whose surfaces meet at a small angle, from outside (a thin gap) or by folding back (a knife edge).
void doubt_tangent_joins(const Try& result, UniteReport& report) {
  const auto uses = uses_of_edges(result.model);
  for (const EdgeId e : result.model.edges.ids()) {
    if (uses[e].size() != 2 || result.model.edges[e].is_degenerate()) continue;
    const FaceId a = uses[e][0].face, b = uses[e][1].face;
    if (result.origin_of_face[a.index()].part == result.origin_of_face[b.index()].part) continue;
    const double angle = std::numbers::pi - angle_between(normal_at(result.model, uses[e][0]), normal_at(result.model, uses[e][1]));
    if (angle > k_tangent_angle) continue;
    const ModelEdge& edge = result.model.edges[e];
    report.doubts.push_back({edge.curve->point(0.5 * (edge.range.from + edge.range.to)), "\"" + result.model.faces[a].name + "\" and \"" + result.model.faces[b].name + "\" meet at an angle of " +
                                                                                              std::to_string(angle * 180.0 / std::numbers::pi) + " degrees"});
  }
}

/// Bodies that stayed apart, with their distance to the first.
void doubt_gaps(const Try& result, UniteReport& report, const RunContext& context) {
  const CadShape::Content& content = result.model.shape->content();
  if (content.solids.size() < 2) return;
  run_occt({.attempted = "measuring gaps between bodies"}, context, [&](const Message_ProgressRange&) {
    for (std::size_t s = 1; s < content.solids.size(); ++s) {
      context.check_stop();
      const BRepExtrema_DistShapeShape gap(content.solids[0], content.solids[s]);
      if (!gap.IsDone() || gap.NbSolution() < 1) continue;
      const gp_Pnt p = gap.PointOnShape1(1);
      const auto name = [&](std::size_t solid) { return result.model.components[result.model.faces[result.model.solids.raw()[solid].faces.front()].component].name; };
      report.doubts.push_back({{p.X(), p.Y(), p.Z()}, "\"" + name(0) + "\" and \"" + name(s) + "\" are apart by " + std::to_string(gap.Value()) + " m"});
    }
  });
}

}  // namespace

UniteResult unite(std::span<const Model> models, const UniteOptions& options, const RunContext& context) {
  const std::vector<Part> parts = take_parts(models, context);
  if (parts.empty()) throw Error({.code = ErrorCode::bad_argument, .attempted = "uniting the parts", .problem = "there are none"});
  UniteReport report;
  for (const Part& part : parts) {
    report.sum_of_volumes += part.volume;
    report.largest_volume = std::max(report.largest_volume, part.volume);
  }
  const double size = size_of(parts);
  if (parts.size() == 1) {
    report.volume = parts.front().volume;
    report.n_bodies = models.front().solids.size();
    Model model = models.front();
    model.shape = parts.front().shape;
    return {std::move(model), std::move(report)};
  }
  std::optional<Try> result = climb(parts, options, size, report.tries, context);
  if (!result) blame(parts, options, size, report.tries, context);
  report.volume = result->volume;
  report.n_bodies = result->model.solids.size();
  doubt_tangent_joins(*result, report);
  doubt_gaps(*result, report, context);
  return {std::move(result->model), std::move(report)};
}

}  // namespace sterna::cad
