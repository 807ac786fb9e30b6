// OpenCASCADE's general fuse with increasing tolerances, after a check of the contacts. An attempt finds the intersections, fuses the shapes, finds the origins
// of the faces, makes the model and verifies it. If no tolerance is sufficient, pairs that touch are tried one by one, to name the pair that fails.
#include "geom/cad/unite.h"

#include <BRepBndLib.hxx>
#include <Bnd_Box.hxx>

#include <algorithm>
#include <array>
#include <optional>

#include "geom/base/parallel.h"
#include "geom/cad/occt_shape.h"
#include "geom/cad/try_boolean.h"
#include "geom/model/model_measures.h"

namespace sterna::cad {
namespace {

constexpr const char* k_unite_attempt = "uniting the parts";

using Part = BooleanPart;

using Try = BooleanTry;

/// \returns description of a wrong volume; empty: none
std::string volume_objection(const std::vector<Part>& parts, double volume) {
  double sum = 0.0, largest = 0.0;
  for (const Part& part : parts) {
    sum += part.volume;
    largest = std::max(largest, part.volume);
  }
  if (volume >= largest - k_volume_share * sum && volume <= sum * (1.0 + k_volume_share)) return {};
  return "the volume of the result, " + number_text(volume) + " m^3, is not between the volume of the largest part, " + number_text(largest) +
         ", and the sum of all parts, " + number_text(sum);
}

/// Returns a description of the first part with too much or too little remaining area.
std::string area_objection(const std::vector<Part>& parts, const std::vector<double>& areas) {
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const PartExposure& exposure = parts[p].exposure;
    const double least = (exposure.outside - k_area_share) * parts[p].area, most = (exposure.outside + exposure.unsure + k_area_share) * parts[p].area;
    if (areas[p] < least || areas[p] > most)
      return number_text(areas[p]) + " m^2 of \"" + parts[p].name() + "\" are left, expected " + number_text(exposure.outside * parts[p].area) +
             " m^2, its area outside of the other parts";
  }
  return {};
}

/// Returns a description of a defective result; empty: none.
std::string objection(Try& result, const std::vector<Part>& parts, const RunContext& context) {
  std::vector<double> areas(parts.size(), 0.0);
  if (std::string unsound = measure_result(result, "result", areas, context); !unsound.empty()) return unsound;
  const std::string volume = volume_objection(parts, result.volume);
  return volume.empty() ? area_objection(parts, areas) : volume;
}

std::optional<Try> climb(const std::vector<Part>& parts, const UniteOptions& options, double size, std::vector<UniteTry>& tries, const RunContext& context) {
  const BooleanTask task{
      .operation = BooleanOperation::fuse, .attempted = k_unite_attempt, .stage = "unite", .tolerance = options.tolerance, .time_limit = options.time_limit};
  return climb(
      task, parts, size, [&](Try& result) { result.outcome.problem = objection(result, parts, context); }, tries, context);
}

bool is_near(const Part& a, const Part& b, double gap) {
  Bnd_Box box_a, box_b;
  BRepBndLib::Add(a.shape->content().shape, box_a, false);
  BRepBndLib::Add(b.shape->content().shape, box_b, false);
  box_a.Enlarge(gap);
  return !box_a.IsOut(box_b);
}

/// Returns two parts, each with its area outside of the other.
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
  std::vector<ErrorLocation> contacts;  // locations to report if OpenCASCADE gives none
  const auto add_contacts = [&](const auto& is_blamed) {
    for (const PartContact& contact : report.contacts)
      if (is_blamed(contact))
        contacts.push_back({contact.location, "\"" + parts[contact.first].name() + "\" and \"" + parts[contact.second].name() + "\" meet"});
  };
  std::vector<UniteTry> pair_tries;
  for (std::size_t a = 0; a < parts.size() && info.problem.empty() && parts.size() > 2; ++a)
    for (std::size_t b = a + 1; b < parts.size() && info.problem.empty(); ++b) {
      if (!is_near(parts[a], parts[b], k_boolean_ladder.back() * size)) continue;
      pair_tries.clear();
      if (climb(alone(parts[a], parts[b], context), options, size, pair_tries, context)) continue;
      blamed = &pair_tries.back();
      add_contacts([&](const PartContact& contact) { return std::minmax(contact.first, contact.second) == std::minmax(a, b); });
      info.problem = "\"" + parts[a].name() + "\" and \"" + parts[b].name() + "\" cannot be united: " + blamed->problem;
    }
  if (info.problem.empty()) {
    info.problem = names_of(parts) + " cannot be united: " + blamed->problem;
    add_contacts([](const PartContact& contact) { return contact.kind != ContactKind::apart; });
  }
  info.problem += "; tried up to a tolerance of " + std::to_string(blamed->tolerance) + " m";
  info.locations = blamed->locations.empty() ? contacts : blamed->locations;
  info.n_locations = static_cast<std::int64_t>(info.locations.size());
  info.locations.resize(std::min(k_max_locations, info.locations.size()));
  info.hint = "move or turn one of the parts a little, so that surfaces neither coincide nor touch tangentially";
  throw Error(std::move(info));
}

void look_at_contacts(std::span<const Model> models, std::vector<Part>& parts, UniteReport& report, const RunContext& context) {
  const StageTimer timer(context, "unite/contacts");
  ContactReport found = find_contacts(models, context);
  for (std::size_t p = 0; p < parts.size(); ++p) parts[p].exposure = found.exposures[p];
  for (const PartContact& contact : found.contacts) {
    const std::string doubt = doubt_of(contact, models);
    if (doubt.empty()) continue;
    context.warn("union: " + doubt + ", at " + format_point(contact.location));
    report.doubts.push_back({contact.location, doubt});
  }
  report.contacts = std::move(found.contacts);
}

}  // namespace

UniteResult unite(std::span<const Model> models, const UniteOptions& options, const RunContext& context) {
  std::vector<Part> parts;
  for (const Model& model : models) parts.push_back(boolean_part(model, k_unite_attempt, context));
  if (parts.empty()) throw Error({.code = ErrorCode::bad_argument, .attempted = k_unite_attempt, .problem = "no part was given"});
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
