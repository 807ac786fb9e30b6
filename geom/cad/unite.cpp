// OpenCASCADE's general fuse with growing tolerances, after a look at the contacts. Steps of a try: intersections, fuse, origins of the faces, model, proof. When no
// tolerance is enough, pairs that touch are tried one by one, to name the one that fails.
#include "geom/cad/unite.h"

#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBndLib.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Message_ProgressScope.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <functional>
#include <optional>

#include "geom/base/parallel.h"
#include "geom/cad/near_pairs.h"
#include "geom/cad/occt_call.h"
#include "geom/cad/occt_shape.h"
#include "geom/model/model_measures.h"

namespace sterna::cad {
namespace {

/// Tolerances that are tried, as shares of the longest side: exact first, the last is a tenth of what a mesh of a wing's leading edge resolves.
constexpr std::array<double, 5> k_ladder = {0.0, 1e-7, 1e-6, 1e-5, 1e-4};
/// Volumes agree to this share of the sum: parts that only touch lose or gain by the tolerance of the fuse.
constexpr double k_volume_share = 1e-4;
/// Area of a part that the union may have more or less than samples tell, of the part's area: twice what sampling errs on wings and bodies. A lost
/// face of a wing or a nacelle is more.
constexpr double k_area_share = 0.05;
/// Share of a try's progress that finding intersections is.
constexpr double k_intersect_share = 0.9;
/// Places that an error lists.
constexpr std::size_t k_listed = 5;

struct Part {
  const Model* model;
  std::shared_ptr<const CadShape> shape;
  double volume = 0.0;
  double area = 0.0;
  PartExposure exposure;
  std::string name() const { return part_name(*model); }
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
  bool is_late = false;  ///< the time limit ended it
  UniteTry outcome;
};

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

/// Middles of the free edges.
std::vector<ErrorPlace> open_places(const Model& model) {
  std::vector<ErrorPlace> places;
  for (const EdgeId e : free_edges(model)) {
    const ModelEdge& edge = model.edges[e];
    places.push_back({edge.curve->point(0.5 * (edge.range.from + edge.range.to)), "open edge"});
  }
  return places;
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

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// \returns what is wrong with the volume; empty: nothing
std::string volume_objection(const std::vector<Part>& parts, double volume) {
  double sum = 0.0, largest = 0.0;
  for (const Part& part : parts) {
    sum += part.volume;
    largest = std::max(largest, part.volume);
  }
  if (volume >= largest - k_volume_share * sum && volume <= sum * (1.0 + k_volume_share)) return {};
  return "the volume of the result, " + number_text(volume) + " m^3, is not between that of the largest part, " + number_text(largest) + ", and the sum, " + number_text(sum);
}

/// The first part of which too much or too little is left.
std::string area_objection(const Try& result, const std::vector<Part>& parts, const std::vector<FaceMeasures>& measures) {
  std::vector<double> areas(parts.size(), 0.0);
  for (std::size_t f = 0; f < measures.size(); ++f) areas[result.origin_of_face[f].part] += measures[f].area;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const PartExposure& exposure = parts[p].exposure;
    const double least = (exposure.outside - k_area_share) * parts[p].area, most = (exposure.outside + exposure.unsure + k_area_share) * parts[p].area;
    if (areas[p] < least || areas[p] > most)
      return number_text(areas[p]) + " m^2 of \"" + parts[p].name() + "\" are left, but " + number_text(exposure.outside * parts[p].area) + " m^2 of it lie outside of the other parts";
  }
  return {};
}

/// What is wrong with a result; empty: nothing.
std::string objection(Try& result, const std::vector<Part>& parts, const RunContext& context) {
  result.outcome.places = faults_of(*result.model.shape);
  if (!result.outcome.places.empty()) return "the result is not valid: " + result.outcome.places.front().what;
  const bool is_closed = !result.model.solids.empty() && std::all_of(result.model.solids.begin(), result.model.solids.end(), [](const ModelSolid& s) { return s.is_closed; });
  if (!is_closed) {
    result.outcome.places = open_places(result.model);
    return "the result is not closed";
  }
  std::vector<FaceMeasures> measures(result.model.faces.size());
  parallel_for(context, measures.size(), [&](std::size_t f) { measures[f] = face_measures(result.model, FaceId(static_cast<std::uint64_t>(f))); }, 1);
  for (const FaceMeasures& face : measures) result.volume += face.volume;
  const std::string volume = volume_objection(parts, result.volume);
  return volume.empty() ? area_objection(result, parts, measures) : volume;
}

TopTools_ListOfShape list_of(std::span<const Part> parts) {
  TopTools_ListOfShape list;
  for (const Part& part : parts) list.Append(part.shape->content().shape);
  return list;
}

/// A fuse whose intersections are known.
void fuse_shapes(const std::vector<Part>& parts, double tolerance, const RunContext& context, const Message_ProgressRange& progress, const std::function<void(BRepAlgoAPI_Fuse&)>& take) {
  Message_ProgressScope steps(progress, nullptr, 1.0);
  const auto set_options = [&](auto& algorithm) {
    algorithm.SetNonDestructive(true);
    algorithm.SetRunParallel(context.threads() > 1);
    if (tolerance > 0.0) algorithm.SetFuzzyValue(tolerance);
  };
  NearPairsFiller filler(context);
  filler.SetArguments(list_of(parts));
  set_options(filler);
  {
    const StageTimer timer(context, "unite/intersect");
    filler.Perform(steps.Next(k_intersect_share));
  }
  context.check_stop();
  const StageTimer timer(context, "unite/build");
  BRepAlgoAPI_Fuse fuse(filler);
  fuse.SetArguments(list_of(std::span(parts).first(1)));
  fuse.SetTools(list_of(std::span(parts).subspan(1)));
  set_options(fuse);
  fuse.Build(steps.Next(1.0 - k_intersect_share));
  context.check_stop();
  take(fuse);
}

Try fuse_once(const std::vector<Part>& parts, double tolerance, const UniteOptions& options, const RunContext& context) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  Try result;
  result.outcome.tolerance = tolerance;
  try {
    run_occt({.attempted = "uniting the parts", .time_limit = options.time_limit}, context, [&](const Message_ProgressRange& progress) {
      fuse_shapes(parts, tolerance, context, progress, [&](BRepAlgoAPI_Fuse& fuse) {
        if (fuse.HasErrors() || !fuse.IsDone() || fuse.Shape().IsNull()) {
          result.outcome.problem = "OpenCASCADE's fuse ended with an error";
          return;
        }
        const StageTimer timer(context, "unite/proof");
        const Origins origins = origins_of(fuse, parts);
        result.model = model_of(label(fuse.Shape(), origins, parts), "uniting the parts", context);
        result.outcome.problem = restore_origins(result, origins, parts);
        if (result.outcome.problem.empty()) result.outcome.problem = objection(result, parts, context);
      });
    });
  } catch (const Error& error) {
    if (error.code() != ErrorCode::geometry_failed) throw;
    result.is_late = std::chrono::duration<double>(Clock::now() - start).count() > options.time_limit;
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

std::string names_of(const std::vector<Part>& parts) {
  std::string names;
  for (const Part& part : parts) names += (names.empty() ? "\"" : ", \"") + part.name() + "\"";
  return names;
}

/// No larger tolerance makes it faster.
Error late(const std::vector<Part>& parts, const UniteTry& outcome) {
  return Error({.code = ErrorCode::geometry_failed, .attempted = "uniting " + names_of(parts), .problem = outcome.problem, .hint = "give it a larger time_limit"});
}

/// \throws Error(geometry_failed) for a try that takes too long
std::optional<Try> climb(const std::vector<Part>& parts, const UniteOptions& options, double size, std::vector<UniteTry>& tries, const RunContext& context) {
  for (const double tolerance : tolerances(options, size)) {
    Try result = fuse_once(parts, tolerance, options, context);
    tries.push_back(result.outcome);
    if (result.outcome.problem.empty()) return result;
    context.debug("union with tolerance " + std::to_string(tolerance) + " m: " + result.outcome.problem);
    if (result.is_late) throw late(parts, result.outcome);
  }
  return std::nullopt;
}

std::vector<Part> take_parts(std::span<const Model> models, const RunContext& context) {
  std::vector<Part> parts;
  for (const Model& model : models) {
    Part part{.model = &model, .shape = shape_of(model, context), .exposure = {}};
    const bool is_closed = !model.solids.empty() && std::all_of(model.solids.begin(), model.solids.end(), [](const ModelSolid& s) { return s.is_closed; });
    if (!is_closed) {
      ErrorInfo info{.code = ErrorCode::open_surface, .attempted = "uniting the parts", .problem = "\"" + part.name() + "\" is not closed", .hint = "only closed parts have an inside"};
      info.places = open_places(model);
      info.n_places = static_cast<std::int64_t>(info.places.size());
      info.places.resize(std::min(k_listed, info.places.size()));
      throw Error(std::move(info));
    }
    for (const SolidId solid : model.solids.ids()) {
      const SolidMeasures measures = solid_measures(model, solid);
      part.volume += measures.volume;
      part.area += measures.area;
    }
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

/// Two parts, with what of each lies outside of the other.
std::vector<Part> alone(const Part& a, const Part& b, const RunContext& context) {
  const std::array<Model, 2> models{*a.model, *b.model};
  const ContactReport found = find_contacts(models, context);
  std::vector<Part> pair{a, b};
  for (std::size_t p = 0; p < 2; ++p) pair[p].exposure = found.exposures[p];
  return pair;
}

/// \throws Error(geometry_failed): names the first pair that does not unite alone.
[[noreturn]] void blame(const std::vector<Part>& parts, const UniteOptions& options, double size, const UniteReport& report, const RunContext& context) {
  ErrorInfo info{.code = ErrorCode::geometry_failed, .attempted = "uniting " + std::to_string(parts.size()) + " parts"};
  const UniteTry* blamed = &report.tries.back();
  std::vector<ErrorPlace> contacts;  // where OpenCASCADE names no place
  const auto add_contacts = [&](const auto& is_blamed) {
    for (const PartContact& contact : report.contacts)
      if (is_blamed(contact)) contacts.push_back({contact.place, "\"" + parts[contact.first].name() + "\" and \"" + parts[contact.second].name() + "\" meet"});
  };
  std::vector<UniteTry> pair_tries;
  for (std::size_t a = 0; a < parts.size() && info.problem.empty() && parts.size() > 2; ++a)
    for (std::size_t b = a + 1; b < parts.size() && info.problem.empty(); ++b) {
      if (!is_near(parts[a], parts[b], k_ladder.back() * size)) continue;
      pair_tries.clear();
      if (climb(alone(parts[a], parts[b], context), options, size, pair_tries, context)) continue;
      blamed = &pair_tries.back();
      add_contacts([&](const PartContact& contact) { return std::minmax(contact.first, contact.second) == std::minmax(a, b); });
      info.problem = "\"" + parts[a].name() + "\" and \"" + parts[b].name() + "\" do not unite: " + blamed->problem;
    }
  if (info.problem.empty()) {
    info.problem = names_of(parts) + " do not unite: " + blamed->problem;
    add_contacts([](const PartContact& contact) { return contact.kind != ContactKind::apart; });
  }
  info.problem += "; tried up to a tolerance of " + std::to_string(blamed->tolerance) + " m";
  info.places = blamed->places.empty() ? contacts : blamed->places;
  info.n_places = static_cast<std::int64_t>(info.places.size());
  info.places.resize(std::min(k_listed, info.places.size()));
  info.hint = "move or turn one of them a little, so that surfaces neither coincide nor touch tangentially";
  throw Error(std::move(info));
}

void look_at_contacts(std::span<const Model> models, std::vector<Part>& parts, UniteReport& report, const RunContext& context) {
  const StageTimer timer(context, "unite/contacts");
  ContactReport found = find_contacts(models, context);
  for (std::size_t p = 0; p < parts.size(); ++p) parts[p].exposure = found.exposures[p];
  for (const PartContact& contact : found.contacts) {
    const std::string doubt = doubt_of(contact, models);
    if (doubt.empty()) continue;
    context.warn("union: " + doubt + ", at " + format_point(contact.place));
    report.doubts.push_back({contact.place, doubt});
  }
  report.contacts = std::move(found.contacts);
}

}  // namespace

UniteResult unite(std::span<const Model> models, const UniteOptions& options, const RunContext& context) {
  std::vector<Part> parts = take_parts(models, context);
  if (parts.empty()) throw Error({.code = ErrorCode::bad_argument, .attempted = "uniting the parts", .problem = "there are none"});
  UniteReport report;
  for (const Part& part : parts) {
    report.sum_of_volumes += part.volume;
    report.largest_volume = std::max(report.largest_volume, part.volume);
  }
  if (parts.size() == 1) {
    report.volume = parts.front().volume;
    report.n_bodies = models.front().solids.size();
    Model model = models.front();
    model.shape = parts.front().shape;
    return {std::move(model), std::move(report)};
  }
  look_at_contacts(models, parts, report, context);
  const double size = size_of(parts);
  std::optional<Try> result = climb(parts, options, size, report.tries, context);
  if (!result) blame(parts, options, size, report, context);
  report.volume = result->volume;
  report.n_bodies = result->model.solids.size();
  return {std::move(result->model), std::move(report)};
}

}  // namespace sterna::cad
