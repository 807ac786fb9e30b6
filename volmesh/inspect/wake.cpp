// Checks if the wake of the body is refined, because its resolution affects the drag (docs/verification.md).
#include "volmesh/case/body_wake.h"
#include "volmesh/inspect/survey.h"

namespace sterna::volmesh {

void survey_wake(const Survey& survey) {
  if (!has_bare_wake(survey.mesh, survey.request.volume)) return;
  add_finding(
      survey.report,
      {.kind = FindingKind::wake,
       .severity = Severity::note,
       .text = "no source refines the mesh behind the body: only the growth of tetrahedra determines the resolution of the wake, and drag depends on it",
       .advice = "sources = { wake{ wall, length = 2 } }, or --wake length=2 of `sterna mesh`"},
      {});
}

}  // namespace sterna::volmesh
