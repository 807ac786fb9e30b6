#include "volmesh/improve/improve.h"

#include <algorithm>
#include <cmath>

#include "geom/mesh/gates.h"
#include "volmesh/improve/improver.h"
#include "volmesh/improve/remaining.h"
#include "volmesh/improve/survey.h"

namespace sterna::volmesh {
namespace {

constexpr int k_wish_failures = 3;  ///< wishes are many, and those that can be had are had soon

/// Of the pass after the one for the limits: the figures that gates wish for. Changes for their sake make no angle worse than they find it, or than the limits.
QualityLimits wished_limits(const ImproveOptions& options) {
  const GateTable gates;
  QualityLimits limits = quality_limits(options.improve_min_angle, std::min(options.improve_max_angle, gates[Measure::max_dihedral].target));
  limits.floor = limits.target;
  limits.max_failures = k_wish_failures;
  limits.size_step = gates[Measure::interface_volume].usual;
  return limits;
}

void improve_to(const TetraBoundary& boundary, TetraResult& tets, const ImproveOptions& options, const QualityLimits& limits, AngleSurvey& survey,
                ImproveReport& report, const RunContext& context) {
  Improver improver(boundary, tets, limits, context);
  if (std::isfinite(limits.size_step)) improver.work_on_all_but(survey.bad);
  else improver.work_on(survey.bad);
  report.rounds += improver.run(options.improve_rounds);
  improver.finish(tets);
  survey = survey_angles(boundary, tets, quality_limits(options.improve_min_angle, options.improve_max_angle), context);
}

}  // namespace

ImproveReport improve_tetrahedra(const TetraBoundary& boundary, TetraResult& tets, const ImproveOptions& options, const RunContext& context) {
  const QualityLimits limits = quality_limits(options.improve_min_angle, options.improve_max_angle);
  AngleSurvey survey = survey_angles(boundary, tets, limits, context);
  ImproveReport report{.n_bad_before = static_cast<std::int64_t>(survey.bad.size()), .min_angle_before = survey.smallest, .max_angle_before = survey.largest};
  if (options.improve_rounds > 0) {
    if (!survey.bad.empty()) improve_to(boundary, tets, options, limits, survey, report, context);
    improve_to(boundary, tets, options, wished_limits(options), survey, report, context);
  }
  report.n_bad_after = static_cast<std::int64_t>(survey.bad.size());
  report.n_at_boundary = survey.n_at_boundary;
  report.min_angle_after = survey.smallest;
  report.max_angle_after = survey.largest;
  list_remaining(boundary, tets, survey.bad, options, report, context);
  return report;
}

}  // namespace sterna::volmesh
