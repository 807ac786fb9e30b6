// Steps: find the side of the plane on which each face lies; remove solids beyond the plane and unite the others; cut faces that cross the plane by a half
// space; remove faces beyond it and in it; project free edges into the plane.
#include "geom/cad/half_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/cad/aircraft_union.h"
#include "geom/cad/split_closed.h"
#include "geom/cad/try_boolean.h"
#include "geom/model/flattened_curve.h"
#include "geom/model/model_builder.h"
#include "geom/model/model_measures.h"
#include "geom/model/select_faces.h"
#include "geom/model/shapes.h"

namespace sterna::cad {
namespace {

constexpr const char* k_half_attempt = "cutting the model in half";
/// Geometry nearer to the plane than this fraction of the longest side counts as in the plane. Surface meshers and CAD systems split aircraft a hundred times
/// more accurately than that.
constexpr double k_tolerance_share = 1e-6;
/// Allowed distance from the plane of an edge of a face in the plane, as a multiple of the edge's tolerance.
constexpr double k_edge_tolerances = 2.0;
/// Intervals of an edge at whose ends its distance to the plane is measured.
constexpr int k_edge_samples = 24;
/// The box that represents the half space is larger than the model by this fraction of its size.
constexpr double k_margin = 0.25;
constexpr std::string_view k_half_space = "half space";

struct Plane {
  std::size_t axis = 1;
  double at = 0.0;
  double side = 1.0;       ///< sign of the half that is kept
  double tolerance = 0.0;  ///< metres
  /// Returns the height above the plane, positive on the side that is kept.
  double height(const Point& p) const { return side * (p[axis] - at); }
  std::string name() const { return std::string(1, "xyz"[axis]) + " = " + number_text(at); }
};

enum class Side { kept, beyond, in_plane, across };

[[noreturn]] void fail_half(ErrorCode code, const std::string& problem, std::vector<ErrorLocation> locations, const std::string& hint) {
  ErrorInfo info{.code = code, .attempted = k_half_attempt, .problem = problem, .locations = std::move(locations), .hint = hint};
  info.n_locations = static_cast<std::int64_t>(info.locations.size());
  info.locations.resize(std::min(k_max_locations, info.locations.size()));
  throw Error(std::move(info));
}

std::vector<MeasureBox> boxes_of(const Model& model, const RunContext& context) {
  std::vector<MeasureBox> boxes(model.faces.size());
  parallel_for(
      context, boxes.size(), [&](std::size_t f) { boxes[f] = face_measures(model, FaceId(static_cast<std::uint64_t>(f))).box; }, 1);
  return boxes;
}

MeasureBox hull(const std::vector<MeasureBox>& boxes) {
  MeasureBox all = boxes.front();
  for (const MeasureBox& box : boxes)
    for (std::size_t k = 0; k < 3; ++k) {
      all.min[k] = std::min(all.min[k], box.min[k]);
      all.max[k] = std::max(all.max[k], box.max[k]);
    }
  return all;
}

double longest_side(const MeasureBox& box) { return std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z}); }

Side side_of(const MeasureBox& box, const Plane& plane) {
  const double a = plane.height(box.min), b = plane.height(box.max);
  const bool is_kept = std::max(a, b) > plane.tolerance, is_beyond = std::min(a, b) < -plane.tolerance;
  if (is_kept && is_beyond) return Side::across;
  return is_kept ? Side::kept : is_beyond ? Side::beyond : Side::in_plane;
}

std::vector<Side> sides_of(const Model& model, const Plane& plane, const RunContext& context) {
  std::vector<Side> sides;
  for (const MeasureBox& box : boxes_of(model, context)) sides.push_back(side_of(box, plane));
  return sides;
}

Plane plane_of(const HalfModelOptions& options, const std::vector<MeasureBox>& boxes) {
  Plane plane{.axis = options.axis == "x"   ? std::size_t{0}
                      : options.axis == "y" ? std::size_t{1}
                                            : std::size_t{2},
              .at = options.at + 0.0,
              .side = options.keep == "-" ? -1.0 : 1.0};
  plane.tolerance = is_automatic(options.tolerance) ? k_tolerance_share * longest_side(hull(boxes)) : options.tolerance;
  return plane;
}

/// Returns the largest distance of an edge from the plane, from samples, and its location.
std::pair<double, Point> distance_of(const ModelEdge& edge, const Plane& plane) {
  std::pair<double, Point> largest{-1.0, {}};
  for (int i = 0; i <= k_edge_samples; ++i) {
    const Point p = edge.curve->point(edge.range.from + edge.range.length() * i / k_edge_samples);
    if (const double off = std::abs(plane.height(p)); off > largest.first) largest = {off, p};
  }
  return largest;
}

double length_of(const ModelEdge& edge) {
  double length = 0.0;
  Point last = edge.curve->point(edge.range.from);
  for (int i = 1; i <= k_edge_samples; ++i) {
    const Point p = edge.curve->point(edge.range.from + edge.range.length() * i / k_edge_samples);
    length += distance(last, p);
    last = p;
  }
  return length;
}

bool is_in_plane(const ModelEdge& edge, const Plane& plane) {
  return distance_of(edge, plane).first <= std::max(plane.tolerance, k_edge_tolerances * edge.tolerance);
}

/// \throws Error(open_surface) if free edges are off the plane
void require_border_in_plane(const Model& model, const Plane& plane, const std::string& hint) {
  std::vector<ErrorLocation> locations;
  const auto uses = uses_of_edges(model);
  for (const EdgeId e : free_edges(model)) {
    if (is_in_plane(model.edges[e], plane)) continue;
    const auto [off, location] = distance_of(model.edges[e], plane);
    locations.push_back({location, "open edge of face \"" + model.faces[uses[e].front().face].name + "\", " + number_text(off) + " m off the plane"});
  }
  if (!locations.empty())
    fail_half(ErrorCode::open_surface, std::to_string(locations.size()) + " free edges are not in the plane " + plane.name(), std::move(locations), hint);
}

/// Returns the solids that are not entirely beyond the plane, as one model; several solids are united.
Model without_other_half(const Model& model, const Plane& plane, const HalfModelOptions& options, HalfModelReport& report, const RunContext& context) {
  std::vector<Model> parts;
  for (Model& part : split_solids(model)) {
    const std::vector<Side> sides = sides_of(part, plane, context);
    const bool is_beyond = std::none_of(sides.begin(), sides.end(), [](Side s) { return s == Side::kept || s == Side::across; });
    if (is_beyond) ++report.n_solids_left_out;
    else parts.push_back(std::move(part));
  }
  if (parts.empty())
    fail_half(ErrorCode::bad_argument, "no part of the model is on the side of " + plane.name() + " that is kept", {},
              "keep = \"" + std::string(plane.side > 0.0 ? "-" : "+") + "\" keeps the other side");
  if (parts.size() == 1 && report.n_solids_left_out == 0) return model;
  if (parts.size() == 1) return std::move(parts.front());
  report.was_united = true;
  return unite(parts, {.time_limit = options.time_limit}, context).model;
}

Model half_space(const Plane& plane, const MeasureBox& box) {
  const double margin = k_margin * longest_side(box);
  Point low = box.min - Vec3{margin, margin, margin}, high = box.max + Vec3{margin, margin, margin};
  (plane.side > 0.0 ? low : high)[plane.axis] = plane.at;
  return make_box(std::string(k_half_space), low, high);
}

/// Sets the description of a defective cut, and its volume.
void judge_half(const std::vector<BooleanPart>& parts, BooleanTry& result, const RunContext& context) {
  UniteTry& outcome = result.outcome;
  std::vector<double> areas(parts.size(), 0.0);
  outcome.problem = measure_result(result, "half", areas, context);
  if (!outcome.problem.empty()) return;
  const double area = areas.front();
  const BooleanPart& whole = parts.front();
  const double least = (1.0 - whole.exposure.outside - whole.exposure.unsure - k_area_share) * whole.area,
               most = (1.0 - whole.exposure.outside + k_area_share) * whole.area;
  if (!(result.volume > 0.0) || result.volume > whole.volume * (1.0 + k_volume_share))
    outcome.problem = "the half has a volume of " + number_text(result.volume) + " m^3, the whole model of " + number_text(whole.volume);
  else if (area < least || area > most)
    outcome.problem = number_text(area) + " m^2 of faces are left, expected " + number_text(least) + " to " + number_text(most);
}

/// Returns the corner that is nearest to the plane but not in it, as the location of a cut that fails without one: faces there touch the plane, or run along
/// it.
ErrorLocation nearest_to(const Plane& plane, const Model& model) {
  double least = std::numeric_limits<double>::infinity();
  Point nearest;
  for (const ModelCorner& corner : model.corners)
    if (const double off = std::abs(plane.height(corner.point)); off > plane.tolerance && off < least) {
      least = off;
      nearest = corner.point;
    }
  return {nearest, "the corner nearest to the plane, " + number_text(least) + " m off"};
}

/// Returns the part of a closed model in the half space, without the faces that close it in the plane.
Model cut_at(const Model& model, const Plane& plane, const MeasureBox& box, const HalfModelOptions& options, const RunContext& context) {
  const std::vector<Model> models = {model, half_space(plane, box)};
  std::vector<BooleanPart> parts;
  const ContactReport contacts = find_contacts(models, context);
  for (std::size_t i = 0; i < models.size(); ++i) {
    parts.push_back(boolean_part(models[i], k_half_attempt, context));
    parts.back().exposure = contacts.exposures[i];
  }
  const BooleanTask task{
      .operation = BooleanOperation::common, .attempted = k_half_attempt, .stage = "half", .tolerance = k_automatic, .time_limit = options.time_limit};
  std::vector<UniteTry> tries;
  std::optional<BooleanTry> result = climb(
      task, parts, cad::longest_side(parts.front().shape->content().shape), [&](BooleanTry& t) { judge_half(parts, t, context); }, tries, context);
  if (!result) {
    std::vector<ErrorLocation> locations = tries.back().locations;
    if (locations.empty()) locations.push_back(nearest_to(plane, model));
    fail_half(
        ErrorCode::geometry_failed,
        "the cut of \"" + part_name(model) + "\" at " + plane.name() + " fails: " + tries.back().problem + "; tried up to a tolerance of " +
            std::to_string(tries.back().tolerance) + " m",
        std::move(locations),
        "faces that touch the plane without crossing it, or run nearly along it, are hard to cut: move the plane a little, or cut the triangulated surface");
  }
  const std::vector<FaceOrigin>& origins = result->origin_of_face;
  return select_faces(result->model, [&](FaceId f) { return origins[f.index()].part == 0; });
}

/// As cut_at. OpenCASCADE fails if the seam of a closed face lies in the plane: such faces are then split into halves, each of which may be on one side.
Model cut_or_split(const Model& model, const Plane& plane, const MeasureBox& box, const HalfModelOptions& options, HalfModelReport& report,
                   const RunContext& context) {
  try {
    return cut_at(model, plane, box, options, context);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::geometry_failed) throw;
    std::optional<Model> split = split_closed_faces(model, context);
    if (!split) throw;
    report.n_faces_split = split->faces.size() - model.faces.size();
    const std::vector<Side> sides = sides_of(*split, plane, context);
    report.n_faces_cut = static_cast<std::size_t>(std::count(sides.begin(), sides.end(), Side::across));
    return report.n_faces_cut == 0 ? std::move(*split) : cut_at(*split, plane, box, options, context);
  }
}

/// Moves free edges and their corners into the plane. \pre they are within the tolerance
void flatten_border(Model& model, const Plane& plane, HalfModelReport& report) {
  std::map<const Curve*, CurvePtr> curves;
  const auto flatten_corner = [&](CornerId c) {
    ModelCorner& corner = model.corners[c];
    const double shift = std::abs(corner.point[plane.axis] - plane.at);
    corner.point[plane.axis] = plane.at;
    corner.tolerance += shift;
    report.largest_shift = std::max(report.largest_shift, shift);
  };
  for (const EdgeId e : free_edges(model)) {
    ModelEdge& edge = model.edges[e];
    const double off = distance_of(edge, plane).first;
    edge.tolerance += off;
    report.largest_shift = std::max(report.largest_shift, off);
    report.border_length += length_of(edge);
    ++report.n_border_edges;
    CurvePtr& curve = curves[edge.curve.get()];
    if (!curve) curve = std::make_shared<FlattenedCurve>(edge.curve, plane.axis, plane.at);
    edge.curve = curve;
    flatten_corner(edge.start);
    flatten_corner(edge.end);
  }
  model.shape.reset();
}

}  // namespace

HalfModel half_model(const Model& given, const HalfModelOptions& options, const RunContext& context) {
  if (given.faces.empty()) fail_half(ErrorCode::bad_argument, "the model has no faces", {}, "");
  const StageTimer timer(context, "half");
  HalfModel half;
  std::vector<MeasureBox> boxes = boxes_of(given, context);
  const Plane plane = plane_of(options, boxes);
  const auto count = [](const std::vector<Side>& sides, Side side) { return static_cast<std::size_t>(std::count(sides.begin(), sides.end(), side)); };
  std::vector<Side> sides = sides_of(given, plane, context);
  half.report.was_half = count(sides, Side::across) + count(sides, Side::beyond) == 0;
  const bool is_open = !free_edges(given).empty();
  if (half.report.was_half && count(sides, Side::kept) == 0) fail_half(ErrorCode::bad_argument, "all of the model is in the plane " + plane.name(), {}, "");
  if (is_open && count(sides, Side::across) > 0)
    fail_half(ErrorCode::open_surface, "the model is open and cannot be cut", open_locations(given),
              "close it first: read_cad{ ..., cap = true } closes flat openings");
  half.model = is_open || half.report.was_half ? given : without_other_half(given, plane, options, half.report, context);
  boxes = boxes_of(half.model, context);
  sides = sides_of(half.model, plane, context);
  half.report.n_faces_cut = count(sides, Side::across);
  if (half.report.n_faces_cut > 0) half.model = cut_or_split(half.model, plane, hull(boxes), options, half.report, context);
  sides = sides_of(half.model, plane, context);
  half.report.n_flat_faces = count(sides, Side::in_plane);
  // After a cut, borders may deviate from the plane by the tolerance of the cut, but no face is beyond.
  half.model = select_faces(half.model, [&](FaceId f) { return sides[f.index()] == Side::kept || sides[f.index()] == Side::across; });
  require_border_in_plane(half.model, plane,
                          half.report.was_half ? "close these edges: a half model may be open only at its plane of symmetry"
                                               : "cut along another plane (axis, at), or use a larger tolerance");
  flatten_border(half.model, plane, half.report);
  if (half.report.n_border_edges == 0)
    fail_half(ErrorCode::bad_argument, "the model does not reach the plane " + plane.name(), {},
              "set the plane with axis and at; mesh a model without a plane of symmetry as a whole");
  return half;
}

}  // namespace sterna::cad
