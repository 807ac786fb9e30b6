// Steps: unite the solids of the bodies where they touch; determine how each lies relative to the container; subtract bodies that reach the container's faces
// in one boolean, and check its result; add the other bodies to the result; finally orient all normals into the fluid.
#include "geom/cad/fluid.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/cad/aircraft_union.h"
#include "geom/cad/find_contacts.h"
#include "geom/cad/try_boolean.h"
#include "geom/model/model_builder.h"
#include "geom/model/model_measures.h"

namespace sterna::cad {
namespace {

constexpr const char* k_fluid_attempt = "subtracting the bodies from their container";
/// A body with a smaller fraction of its area inside only touches the container from outside, to the accuracy of the samples.
constexpr double k_least_inside = 1e-3;

[[noreturn]] void fail_fluid(ErrorCode code, const std::string& problem, std::vector<ErrorLocation> locations, const std::string& hint) {
  ErrorInfo info{.code = code, .attempted = k_fluid_attempt, .problem = problem, .locations = std::move(locations), .hint = hint};
  info.n_locations = static_cast<std::int64_t>(info.locations.size());
  info.locations.resize(std::min(k_max_locations, info.locations.size()));
  throw Error(std::move(info));
}

/// Returns the container with its material outside, as a solid of the fluid's shape.
Model solid_container(const Model& container, const RunContext& context) {
  if (container.solids.size() != 1)
    fail_fluid(ErrorCode::bad_argument, "the container \"" + part_name(container) + "\" has " + std::to_string(container.solids.size()) + " solids", {},
               "give a container of one closed solid");
  Model solid = container;
  if (boolean_part(solid, k_fluid_attempt, context).volume < 0.0) turn_inside_out(solid);
  return solid;
}

/// Relation of the bodies to the container: part 0 is the container, part i is body i - 1.
struct Meeting {
  std::vector<std::size_t> cut, inside;  ///< numbers of the parts that reach the container's faces, and of those inside it
  ContactReport contacts;
};

Meeting look_at(const std::vector<Model>& parts, FluidReport& report, const RunContext& context) {
  const StageTimer timer(context, "fluid/contacts");
  Meeting meeting{.cut = {}, .inside = {}, .contacts = find_contacts(parts, context)};
  std::vector<ErrorLocation> outside;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const PartContact* contact = nullptr;
    for (const PartContact& c : meeting.contacts.contacts)
      if (std::minmax(c.first, c.second) == std::minmax(std::size_t{0}, i)) contact = &c;
    const std::string name = "\"" + part_name(parts[i]) + "\"";
    if (contact && contact->kind == ContactKind::inside && contact->first == 0)
      fail_fluid(ErrorCode::bad_argument, name + " fills the container \"" + part_name(parts[0]) + "\"",
                 {{contact->location, "the container lies inside " + name}}, "no volume is left for the fluid: scale or move the bodies or the container");
    const double share_inside = 1.0 - meeting.contacts.exposures[i].outside;
    const bool is_outside = !contact || contact->kind == ContactKind::apart || share_inside < k_least_inside;
    if (is_outside) outside.push_back({contact ? contact->location : parts[i].corners.raw().front().point, name + " lies outside"});
    else if (contact->kind == ContactKind::inside) meeting.inside.push_back(i);
    else meeting.cut.push_back(i);
    if (!contact || contact->kind != ContactKind::crossing || contact->angle >= k_tangent_angle) continue;
    report.doubts.push_back({contact->location, name + " and \"" + part_name(parts[0]) + "\" are nearly tangent where they cross"});
    context.warn("fluid: " + report.doubts.back().what + ", at " + format_point(contact->location));
  }
  if (!outside.empty())
    fail_fluid(
        ErrorCode::bad_argument,
        std::to_string(outside.size()) + (outside.size() == 1 ? " body lies" : " bodies lie") + " outside of the container \"" + part_name(parts[0]) + "\"",
        std::move(outside), "move the body into the container, or enlarge the container");
  return meeting;
}

/// \throws Error if bodies reach out of the container without permission
void require_leave(const std::vector<Model>& parts, const Meeting& meeting, const MayPass& may_pass, const RunContext& context) {
  if (!may_pass || meeting.cut.empty()) return;
  const StageTimer timer(context, "fluid/contacts");
  std::vector<Model> bodies;
  for (const std::size_t i : meeting.cut) bodies.push_back(parts[i]);
  // The farthest overhang of each component.
  std::vector<Overhang> worst;
  for (Overhang& overhang : find_overhangs(parts.front(), bodies, context)) {
    if (may_pass(overhang)) continue;
    const auto same = std::ranges::find(worst, overhang.component, &Overhang::component);
    if (same == worst.end()) worst.push_back(std::move(overhang));
    else if (same->distance < overhang.distance) *same = std::move(overhang);
  }
  if (worst.empty()) return;
  std::ranges::stable_sort(worst, std::greater(), &Overhang::distance);
  std::vector<ErrorLocation> locations;
  for (const Overhang& o : worst)
    locations.push_back({o.location, "\"" + o.component + "\"" + (o.face == o.component ? "" : " (face \"" + o.face + "\")") + " reaches " +
                                         number_text(o.distance) + " m out of the wall \"" + o.wall + "\""});
  const std::string problem = locations.front().what + " and would be cut off there" +
                              (worst.size() > 1 ? "; so would " + std::to_string(worst.size() - 1) + " more of its parts" : "");
  fail_fluid(ErrorCode::bad_argument, problem, std::move(locations),
             "move the model, or make the tunnel larger. Declare parts that pass through a wall (a sting, a strut, a wing on a side wall): test_section{ ..., "
             "through = { \"" +
                 worst.front().component + "\" } }; stings made by sting{} need no declaration");
}

/// Sets the description of a defective cut, and its volume.
void judge_cut(const std::vector<BooleanPart>& parts, BooleanTry& result, const RunContext& context) {
  if (result.model.faces.empty()) return;  // a body fills the container
  UniteTry& outcome = result.outcome;
  std::vector<double> areas(parts.size(), 0.0);
  outcome.problem = measure_result(result, "result", areas, context);
  if (!outcome.problem.empty()) return;
  double bodies = 0.0;
  for (std::size_t p = 1; p < parts.size(); ++p) bodies += parts[p].volume;
  const double all = parts.front().volume, slack = k_volume_share * all;
  if (result.volume < all - bodies - slack || result.volume > all + slack) {
    outcome.problem = "the fluid's volume, " + number_text(result.volume) + " m^3, is outside the limits " + number_text(all - bodies) +
                      " (container minus bodies) and " + number_text(all);
    return;
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const PartExposure& e = parts[p].exposure;
    const double least = p == 0 ? e.outside : 1.0 - e.outside - e.unsure, most = p == 0 ? e.outside + e.unsure : 1.0 - e.outside;
    if (areas[p] >= (least - k_area_share) * parts[p].area && areas[p] <= (most + k_area_share) * parts[p].area) continue;
    outcome.problem = number_text(areas[p]) + " m^2 of \"" + parts[p].name() + "\" border the fluid, expected " + number_text(least * parts[p].area) + " to " +
                      number_text(most * parts[p].area);
    return;
  }
}

/// Returns one corner per solid, on a face from a body if there is one, else on any face.
std::vector<ErrorLocation> pieces_of(const Model& model, const std::vector<SolidMeasures>& measures) {
  std::vector<ErrorLocation> locations;
  for (const SolidId s : model.solids.ids()) {
    const ModelFace& face = model.faces[model.solids[s].faces.front()];
    const ModelEdge& edge = model.edges[face.borders.front().front().edge];
    locations.push_back(
        {model.corners[edge.start].point, "fluid region of " + number_text(measures[s.index()].volume) + " m^3, at face \"" + face.name + "\""});
  }
  return locations;
}

/// \throws Error unless the fluid is in one piece
void require_one_piece(const BooleanTry& result, const std::vector<BooleanPart>& parts) {
  std::vector<BooleanPart> bodies(parts.begin() + 1, parts.end());
  if (result.model.faces.empty())
    fail_fluid(ErrorCode::bad_argument, names_of(bodies) + (bodies.size() == 1 ? " fills" : " fill") + " the container \"" + parts.front().name() + "\"", {},
               "no volume is left for the fluid: scale or move the bodies or the container");
  if (result.model.solids.size() == 1) return;
  std::vector<SolidMeasures> measures;
  for (const SolidId s : result.model.solids.ids()) measures.push_back(solid_measures(result.model, s));
  fail_fluid(ErrorCode::bad_argument,
             names_of(bodies) + (bodies.size() == 1 ? " cuts" : " cut") + " the fluid in \"" + parts.front().name() + "\" into " +
                 std::to_string(result.model.solids.size()) + " parts",
             pieces_of(result.model, measures), "the fluid must be one connected region: move the body off the walls, or let it end in one wall");
}

Model cut_off(const std::vector<Model>& models, const Meeting& meeting, const FluidOptions& options, FluidReport& report, const RunContext& context) {
  std::vector<BooleanPart> parts;
  const auto add = [&](std::size_t i) {
    parts.push_back(boolean_part(models[i], k_fluid_attempt, context));
    parts.back().exposure = meeting.contacts.exposures[i];
  };
  add(0);
  for (const std::size_t i : meeting.cut) add(i);
  const BooleanTask task{
      .operation = BooleanOperation::cut, .attempted = k_fluid_attempt, .stage = "fluid", .tolerance = options.tolerance, .time_limit = options.time_limit};
  std::optional<BooleanTry> result = climb(
      task, parts, size_of(parts), [&](BooleanTry& t) { judge_cut(parts, t, context); }, report.tries, context);
  if (!result) {
    const UniteTry& last = report.tries.back();
    std::vector<ErrorLocation> locations = last.locations;
    for (const PartContact& c : meeting.contacts.contacts)
      if (last.locations.empty() && c.first == 0 && c.kind != ContactKind::apart)
        locations.push_back({c.location, "\"" + part_name(models[c.second]) + "\" meets the container"});
    fail_fluid(ErrorCode::geometry_failed, names_of(parts) + ": " + last.problem + "; tried up to a tolerance of " + std::to_string(last.tolerance) + " m",
               std::move(locations), "move or turn a body a little, so that it neither ends in a wall nor touches it tangentially");
  }
  require_one_piece(*result, parts);
  return std::move(result->model);
}

}  // namespace

FluidDomain fluid_domain(const Model& container, std::span<const Model> bodies, const FluidOptions& options, const RunContext& context,
                         const MayPass& may_pass) {
  std::vector<Model> parts = {solid_container(container, context)};
  std::vector<Model> solids;
  for (const Model& body : bodies)
    for (Model& solid : split_solids(body)) solids.push_back(std::move(solid));
  for (Model& body : unite_touching(solids, {.tolerance = options.tolerance, .time_limit = options.time_limit}, context)) parts.push_back(std::move(body));
  if (parts.size() == 1) fail_fluid(ErrorCode::bad_argument, "no body was given", {}, "mesh a container without bodies directly");
  FluidDomain fluid;
  const Meeting meeting = look_at(parts, fluid.report, context);
  require_leave(parts, meeting, may_pass, context);
  fluid.report.container_volume = boolean_part(parts.front(), k_fluid_attempt, context).volume;
  for (const std::size_t i : meeting.cut) fluid.report.cut.push_back(part_name(parts[i]));
  fluid.model = meeting.cut.empty() ? parts.front() : cut_off(parts, meeting, options, fluid.report, context);
  turn_inside_out(fluid.model);
  for (const std::size_t i : meeting.inside) {
    fluid.report.inside.push_back(part_name(parts[i]));
    append(fluid.model, parts[i]);
  }
  for (const SolidId s : fluid.model.solids.ids()) fluid.report.volume -= solid_measures(fluid.model, s).volume;
  return fluid;
}

}  // namespace sterna::cad
