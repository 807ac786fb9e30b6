// G4: tests that the dual mesh exists (every sub-volume is positive, by exact signs where rounding leaves the sign open) and is closed.
#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "geom/mesh/check_parts.h"
#include "geom/mesh/computed_volumes.h"

namespace sterna::check_parts {
namespace {

/// Result of the exact test of a suspect cell.
struct SubVolumeVerdict {
  bool is_negative = false;         ///< a sub-volume is not positive in exact arithmetic
  bool is_within_rounding = false;  ///< positive, but not above k_solver_margin in double precision
  double least = 0.0;               ///< least_computed_sub_volume()
};

SubVolumeVerdict judge_sub_volumes(const HybridMesh& mesh, const Cell& cell) {
  SubVolumeVerdict verdict;
  std::array<Vec3, 8> p;
  for (std::size_t k = 0; k < cell.span().size(); ++k) p[k] = mesh.points[cell.nodes[k]];
  // Each sub-volume of a tetrahedron is a 24th of its volume. If that is not positive the cell itself is invalid, which is a different violation.
  if (cell.kind == CellKind::tetrahedron) {
    if (!is_tet_valid({p[0], p[1], p[2], p[3]})) return verdict;
  } else if (!are_sub_volumes_positive(mesh, cell)) {
    verdict.is_negative = true;
    return verdict;
  }
  verdict.least = least_computed_sub_volume(cell.kind, std::span(p).first(cell.span().size()));
  verdict.is_within_rounding = !(verdict.least > k_solver_margin);
  return verdict;
}

}  // namespace

DualScan check_dual(const HybridMesh& mesh, const CellNumbers& cells, const DualScan* ahead, const GateTable& limits, const RunContext& context,
                    Findings& findings) {
  DualScan scan = scan_dual(mesh, limits, context, ahead);
  std::vector<SubVolumeVerdict> verdicts(scan.suspects.size());
  parallel_for(context, scan.suspects.size(), [&](std::size_t i) { verdicts[i] = judge_sub_volumes(mesh, cells.cell(scan.suspects[i])); });
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const SubVolumeVerdict& verdict = verdicts[i];
    if (!verdict.is_negative && !verdict.is_within_rounding) continue;
    findings.add(verdict.is_negative ? Violation::negative_sub_volume : Violation::sub_volume_within_rounding, [&] {
      const Point center = cells.center(scan.suspects[i]);
      return std::pair(center,
                       cells.name(scan.suspects[i]) + near_patch(mesh, center) +
                           (verdict.is_negative ? std::string(" has a dual sub-volume that is not positive")
                                                : " has a dual sub-volume of " + number_text(verdict.least, 2) +
                                                      " times the product of its edges in double precision; the limit is " + number_text(k_solver_margin, 2)));
    });
  }
  const GateResult closure = scan.closure.result([&](std::uint64_t node) { return describe_node(mesh, node); });
  std::int64_t n_open = closure.n_beyond_hard;
  for (const GateLocation& location : closure.locations) {
    if (n_open == 0) break;
    --n_open;
    findings.add(Violation::open_dual_cell, [&] {
      return std::pair(location.position, "the control volume of " + location.what + " is open by " + std::to_string(location.value) + " of its surface");
    });
  }
  findings.add_more(Violation::open_dual_cell, n_open);
  return scan;
}

}  // namespace sterna::check_parts
