// G4: the dual mesh exists (every sub-volume positive, by exact signs where rounding leaves a doubt) and is closed.
#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {

DualScan check_dual(const HybridMesh& mesh, const CellNumbers& cells, const DualScan* ahead, const GateTable& limits, const RunContext& context,
                    Findings& findings) {
  DualScan scan = scan_dual(mesh, limits, context, ahead);
  std::vector<std::uint8_t> is_bad(scan.suspects.size(), 0);
  parallel_for(context, scan.suspects.size(), [&](std::size_t i) { is_bad[i] = !are_sub_volumes_positive(mesh, cells.cell(scan.suspects[i])); });
  for (std::size_t i = 0; i < is_bad.size(); ++i) {
    if (is_bad[i] == 0) continue;
    findings.add(Violation::negative_sub_volume, [&] {
      const Point center = cells.center(scan.suspects[i]);
      return std::pair(center, cells.name(scan.suspects[i]) + near_patch(mesh, center) + " has a dual sub-volume that is not positive");
    });
  }
  const GateResult closure = scan.closure.result([&](std::uint64_t node) { return describe_node(mesh, node); });
  std::int64_t n_open = closure.n_beyond_hard;
  for (const GatePlace& place : closure.places) {
    if (n_open == 0) break;
    --n_open;
    findings.add(Violation::open_dual_cell, [&] {
      return std::pair(place.position, "the control volume of " + place.what + " is open by " + std::to_string(place.value) + " of its surface");
    });
  }
  findings.add_more(Violation::open_dual_cell, n_open);
  return scan;
}

}  // namespace sterna::check_parts
