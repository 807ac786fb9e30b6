// Periodic sides declared by the mesh: each pair must match.
#include <string>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/mesh/check_parts.h"
#include "geom/mesh/periodic.h"

namespace sterna::check_parts {

void check_periodic(const HybridMesh& mesh, CheckReport& report, Findings& findings) {
  const double tolerance = mesh.periodic.empty() ? 0.0 : periodic_tolerance(mesh);
  for (const PeriodicSides& sides : mesh.periodic) {
    if (sides.first.index() >= mesh.patches.size() || sides.second.index() >= mesh.patches.size()) {
      findings.add(Violation::bad_index, [&] {
        return std::pair(
            Point{}, "periodic sides " + std::to_string(sides.first.value()) + " and " + std::to_string(sides.second.value()) + " are not patches of the mesh");
      });
      continue;
    }
    try {
      const PeriodicMatch match = match_periodic(mesh, sides.first, sides.second, tolerance);
      const double off = distance(match.translation, sides.translation);
      if (!(off <= tolerance)) {
        findings.add(Violation::periodic_mismatch, [&] {
          return std::pair(mesh.points[match.nodes.front()[0]], "periodic sides " + patch_name(mesh, sides.first) + " and " + patch_name(mesh, sides.second) +
                                                                    " are " + format_point(match.translation) + " m apart, not " +
                                                                    format_point(sides.translation) + " m: " + number_text(off, 3) + " m off");
        });
        continue;
      }
      report.periodic.push_back({mesh.patches[sides.first].name, mesh.patches[sides.second].name, sides.translation,
                                 static_cast<std::int64_t>(match.nodes.size()), static_cast<std::int64_t>(match.faces.size()), match.worst});
    } catch (const Error& error) {
      if (error.code() != ErrorCode::bad_argument) throw;
      const ErrorInfo& info = error.info();
      for (const ErrorLocation& location : info.locations)
        findings.add(Violation::periodic_mismatch, [&] {
          return std::pair(location.position,
                           "periodic sides " + patch_name(mesh, sides.first) + " and " + patch_name(mesh, sides.second) + ": " + location.what);
        });
      if (info.locations.empty()) findings.add(Violation::periodic_mismatch, [&] { return std::pair(Point{}, info.problem); });
      findings.add_more(Violation::periodic_mismatch, std::max<std::int64_t>(info.n_locations - static_cast<std::int64_t>(info.locations.size()), 0));
    }
  }
}

}  // namespace sterna::check_parts
