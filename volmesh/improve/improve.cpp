#include "volmesh/improve/improve.h"

#include <algorithm>
#include <cmath>

#include "geom/mesh/gates.h"
#include "volmesh/improve/angle_survey.h"
#include "volmesh/improve/improver.h"
#include "volmesh/improve/remaining.h"

namespace sterna::volmesh {
namespace {

constexpr double k_angles_end = 0.4;  ///< fraction of the time at the end of the first pass
constexpr int k_target_failures = 3;  ///< fewer attempts for the targets: many tetrahedra miss them, and those that can be improved are improved soon

/// Returns the limits of the second pass, which follows the pass for the hard limits: the target values of the gates. Changes in this pass make no angle worse
/// than the worst that they replace, or than the limits.
QualityLimits target_limits(const ImproveOptions& options) {
  const GateTable gates;
  QualityLimits limits = quality_limits(options.improve_min_angle, std::min(options.improve_max_angle, gates[Measure::max_dihedral].target));
  limits.floor = limits.target;
  limits.max_failures = k_target_failures;
  limits.size_step = gates[Measure::interface_volume].usual;
  return limits;
}

/// Returns the tetrahedra beyond the limits of the options.
AngleSurvey survey_of(const TetraBoundary& boundary, const TetraResult& tets, const ImproveOptions& options, const RunContext& context) {
  return survey_angles(boundary, tets, quality_limits(options.improve_min_angle, options.improve_max_angle), context);
}

void log_improvement(const TetraBoundary& boundary, const TetraResult& tets, const AngleSurvey& survey, const ImproveOptions& options, ImproveReport& report,
                     const RunContext& context) {
  report.n_bad_after = static_cast<std::int64_t>(survey.bad.size());
  report.n_at_boundary = survey.n_at_boundary;
  report.min_angle_after = survey.smallest;
  report.max_angle_after = survey.largest;
  list_remaining(boundary, tets, survey.bad, options, report, context);
}

}  // namespace

ImproveReport improve_tetrahedra(const TetraBoundary& boundary, TetraResult& tets, const ImproveOptions& options, const RunContext& context) {
  AngleSurvey survey = survey_of(boundary, tets, options, context);
  ImproveReport report{.n_bad_before = static_cast<std::int64_t>(survey.bad.size()), .min_angle_before = survey.smallest, .max_angle_before = survey.largest};
  const auto improve_to = [&](const QualityLimits& limits, const RunContext& part, const auto& choose) {
    Improver improver(boundary, tets, limits, part);
    choose(improver);
    report.rounds += improver.run(options.improve_rounds);
    improver.finish(tets);
    survey = survey_of(boundary, tets, options, context);
  };
  if (options.improve_rounds > 0) {
    if (!survey.bad.empty())
      improve_to(quality_limits(options.improve_min_angle, options.improve_max_angle), context.part("angles", 0.0, k_angles_end),
                 [&](Improver& improver) { improver.work_on(survey.bad); });
    improve_to(target_limits(options), context.part("shapes", k_angles_end, 1.0), [&](Improver& improver) { improver.work_on_all_but(survey.bad); });
  }
  log_improvement(boundary, tets, survey, options, report, context);
  return report;
}

void improve_around(const TetraBoundary& boundary, std::span<const std::uint32_t> around, TetraResult& tets, const ImproveOptions& options,
                    ImproveReport& report, const RunContext& context) {
  std::vector<std::uint8_t> is_around(boundary.points.size(), 0);
  for (const std::uint32_t v : around) is_around[v] = 1;
  std::vector<std::uint32_t> some;
  for (std::size_t t = 0; t < tets.tetrahedra.size(); ++t)
    if (std::ranges::any_of(tets.tetrahedra[t], [&](std::uint32_t v) { return v < is_around.size() && is_around[v]; }))
      some.push_back(static_cast<std::uint32_t>(t));
  // There is a single pass, because a pass for angles alone would undo the changes of volumes.
  Improver improver(boundary, tets, target_limits(options), context);
  improver.work_on_bad_of(some);
  report.rounds += improver.run(options.improve_rounds);
  improver.finish(tets);
}

void report_remaining(const TetraBoundary& boundary, const TetraResult& tets, const ImproveOptions& options, ImproveReport& report, const RunContext& context) {
  log_improvement(boundary, tets, survey_of(boundary, tets, options, context), options, report, context);
}

}  // namespace sterna::volmesh
