#include "volmesh/improve/improve.h"

#include "volmesh/improve/improver.h"
#include "volmesh/improve/remaining.h"
#include "volmesh/improve/survey.h"

namespace sterna::volmesh {

ImproveReport improve_tetrahedra(const TetraBoundary& boundary, TetraResult& tets, const ImproveOptions& options, const RunContext& context) {
  const QualityLimits limits = quality_limits(options.improve_min_angle, options.improve_max_angle);
  const AngleSurvey before = survey_angles(boundary, tets, limits, context);
  ImproveReport report{.n_bad_before = static_cast<std::int64_t>(before.bad.size()), .min_angle_before = before.smallest, .max_angle_before = before.largest};
  AngleSurvey after = before;
  if (!before.bad.empty() && options.improve_rounds > 0) {
    Improver improver(boundary, tets, limits, before.bad, context);
    report.rounds = improver.run(options.improve_rounds);
    improver.finish(tets);
    after = survey_angles(boundary, tets, limits, context);
  }
  report.n_bad_after = static_cast<std::int64_t>(after.bad.size());
  report.n_at_boundary = after.n_at_boundary;
  report.min_angle_after = after.smallest;
  report.max_angle_after = after.largest;
  list_remaining(boundary, tets, after.bad, options, report, context);
  return report;
}

}  // namespace sterna::volmesh
