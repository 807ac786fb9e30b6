// An attempt finds the intersections, builds the result, finds the origins of its faces, makes the model and checks it.
#include "geom/cad/try_boolean.h"

#include <BRepAlgoAPI_BooleanOperation.hxx>
#include <Message_ProgressScope.hxx>
#include <TopTools_ListOfShape.hxx>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <span>
#include <sstream>

#include "geom/base/parallel.h"
#include "geom/cad/near_pairs.h"
#include "geom/cad/occt_call.h"
#include "geom/model/model_measures.h"

namespace sterna::cad {
namespace {

/// Fraction of an attempt's progress for finding intersections.
constexpr double k_intersect_share = 0.9;
/// Longest error text of OpenCASCADE, in characters.
constexpr std::size_t k_longest_error = 200;

TopTools_ListOfShape list_of(std::span<const BooleanPart> parts) {
  TopTools_ListOfShape list;
  for (const BooleanPart& part : parts) list.Append(part.shape->content().shape);
  return list;
}

BOPAlgo_Operation occt_operation(BooleanOperation operation) {
  switch (operation) {
    case BooleanOperation::fuse: return BOPAlgo_FUSE;
    case BooleanOperation::cut: return BOPAlgo_CUT;
    case BooleanOperation::common: return BOPAlgo_COMMON;
  }
  return BOPAlgo_UNKNOWN;
}

/// Returns ": BOPAlgo_AlertIntersectionFailed", OpenCASCADE's error text; empty if there is none.
std::string errors_of(const BRepAlgoAPI_BooleanOperation& operation) {
  std::ostringstream stream;
  operation.DumpErrors(stream);
  std::string text = stream.str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  text.resize(std::min(text.find_last_not_of(' ') + 1, k_longest_error));
  return text.empty() ? text : ": " + text;
}

/// Runs an operation whose intersections have been computed.
void run_operation(const BooleanTask& task, const std::vector<BooleanPart>& parts, double tolerance, const RunContext& context,
                   const Message_ProgressRange& progress, const std::function<void(BRepAlgoAPI_BooleanOperation&)>& take) {
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
    const StageTimer timer(context, task.stage + "/intersect");
    filler.Perform(steps.Next(k_intersect_share));
  }
  context.check_stop();
  const StageTimer timer(context, task.stage + "/build");
  BRepAlgoAPI_BooleanOperation operation(filler);
  operation.SetOperation(occt_operation(task.operation));
  operation.SetArguments(list_of(std::span(parts).first(1)));
  operation.SetTools(list_of(std::span(parts).subspan(1)));
  set_options(operation);
  operation.Build(steps.Next(1.0 - k_intersect_share));
  context.check_stop();
  take(operation);
}

BooleanTry try_once(const BooleanTask& task, const std::vector<BooleanPart>& parts, double tolerance, const Judge& judge, const RunContext& context) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  BooleanTry result;
  result.outcome.tolerance = tolerance;
  try {
    run_occt({.attempted = task.attempted, .time_limit = task.time_limit}, context, [&](const Message_ProgressRange& progress) {
      run_operation(task, parts, tolerance, context, progress, [&](BRepAlgoAPI_BooleanOperation& operation) {
        if (operation.HasErrors() || !operation.IsDone() || operation.Shape().IsNull()) {
          result.outcome.problem = "OpenCASCADE's boolean ended with an error" + errors_of(operation);
          return;
        }
        const StageTimer timer(context, task.stage + "/proof");
        const FaceOrigins origins = origins_of(operation, parts);
        result.model = model_of(labelled(operation.Shape(), origins, parts), task.attempted, context);
        result.outcome.problem = restore_origins(result.model, origins, parts, result.origin_of_face);
        if (result.outcome.problem.empty()) judge(result);
      });
    });
  } catch (const Error& error) {
    if (error.code() != ErrorCode::geometry_failed) throw;
    result.is_late = std::chrono::duration<double>(Clock::now() - start).count() > task.time_limit;
    result.outcome.problem = error.info().problem;  // a larger tolerance may succeed
    result.outcome.locations = error.info().locations;
  }
  return result;
}

std::vector<double> tolerances(const BooleanTask& task, double size) {
  if (!is_automatic(task.tolerance)) return {task.tolerance};
  std::vector<double> result;
  for (const double share : k_boolean_ladder) result.push_back(share * size);
  return result;
}

}  // namespace

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string names_of(const std::vector<BooleanPart>& parts) {
  std::string names;
  for (const BooleanPart& part : parts) names += (names.empty() ? "\"" : ", \"") + part.name() + "\"";
  return names;
}

std::string measure_result(BooleanTry& result, const std::string& what, std::vector<double>& areas, const RunContext& context) {
  result.outcome.locations = faults_of(*result.model.shape);
  if (!result.outcome.locations.empty()) return "the " + what + " is not valid: " + result.outcome.locations.front().what;
  if (!is_closed_model(result.model)) {
    result.outcome.locations = open_locations(result.model);
    return "the " + what + " is not closed";
  }
  std::vector<FaceMeasures> measures(result.model.faces.size());
  parallel_for(
      context, measures.size(), [&](std::size_t f) { measures[f] = face_measures(result.model, FaceId(static_cast<std::uint64_t>(f))); }, 1);
  for (std::size_t f = 0; f < measures.size(); ++f) {
    areas[result.origin_of_face[f].part] += measures[f].area;
    result.volume += measures[f].volume;
  }
  return {};
}

double size_of(const std::vector<BooleanPart>& parts) {
  double size = 0.0;
  for (const BooleanPart& part : parts) size = std::max(size, longest_side(part.shape->content().shape));
  return size;
}

std::optional<BooleanTry> climb(const BooleanTask& task, const std::vector<BooleanPart>& parts, double size, const Judge& judge, std::vector<UniteTry>& tries,
                                const RunContext& context) {
  for (const double tolerance : tolerances(task, size)) {
    BooleanTry result = try_once(task, parts, tolerance, judge, context);
    tries.push_back(result.outcome);
    if (result.outcome.problem.empty()) return result;
    context.debug(task.attempted + " with tolerance " + std::to_string(tolerance) + " m: " + result.outcome.problem);
    // A larger tolerance is not faster.
    if (result.is_late)
      throw Error({.code = ErrorCode::geometry_failed,
                   .attempted = task.attempted + " (" + names_of(parts) + ")",
                   .problem = result.outcome.problem,
                   .hint = "set a larger time_limit"});
  }
  return std::nullopt;
}

}  // namespace sterna::cad
