// Checks if the body length is outside the range of aircraft. In that case the file most likely has another unit.
#include <array>

#include "geom/base/number_text.h"
#include "volmesh/inspect/survey.h"

namespace sterna::volmesh {

void survey_unit(const Survey& survey) {
  const InspectOptions& limits = survey.request.limits;
  if (survey.mesh.n_triangles() == 0) return;
  const double length = survey.report.length;
  if (length >= limits.least_length && length <= limits.largest_length) return;
  const bool is_long = length > limits.largest_length;
  Finding finding{.kind = FindingKind::unit,
                  .severity = Severity::warn,
                  .count = 1,
                  .value = length,
                  .limit = is_long ? limits.largest_length : limits.least_length,
                  .unit = "m"};
  finding.text = "the body is " + in_metres(length, k_text_digits) + " long, " + (is_long ? "more than " : "less than ") +
                 in_metres(finding.limit, k_text_digits) + ": is the file in metres?";
  finding.advice = is_long ? "unit = mm when reading the file (--unit mm) makes the body " + in_metres(1e-3 * length, k_text_digits) + " long"
                           : "give the unit of the file (--unit); without it, a length of 1 in the file means 1 m";
  Box box = bounding_box(survey.mesh);
  if (survey.n_locations() > 0) finding.locations.push_back({box.center(), {}, length, "middle of the body"});
  add_finding(survey.report, std::move(finding), {});
}

}  // namespace sterna::volmesh
