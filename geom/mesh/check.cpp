// The walker as its list of steps. Together they prove a tiling: positive cells that match face by face cover each point of the fluid equally often
// between two boundaries; the boundary does not cross itself, and its fluid side is covered once.
#include "geom/mesh/check.h"

#include "geom/mesh/cell_centred.h"
#include "geom/mesh/check_parts.h"

namespace sterna {

using namespace check_parts;

namespace {

/// \pre quality is measured
void judge_cell_centres(const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match,
                        std::span<const std::uint32_t> neighbours, const CheckOptions& options, LazyGivenLayer& given, const RunContext& context,
                        CheckReport& report) {
  if (!report.dual_checked) return;  // the mesh does not conform: said already
  if (options.cell_centred)
    return judge_cell_centred(scan_cell_centred(mesh, cells, slots, match, neighbours, options.limits, context), mesh, cells, slots, neighbours, options.limits,
                              given, report);
  for (GateResult& gate : report.gates)
    if (info_of(gate.measure).gate == "OF") gate.reason = "cell_centred = false";
}

}  // namespace

CheckReport check(const HybridMesh& mesh, const CheckOptions& options, const RunContext& context, const LayerCheck* ahead) {
  const LayerCheck::Parts* const known = ahead ? ahead->parts() : nullptr;
  CheckReport report;
  report.n_nodes = static_cast<std::int64_t>(mesh.points.size());
  report.n_boundary_triangles = static_cast<std::int64_t>(mesh.boundary_triangles.size());
  report.n_boundary_quads = static_cast<std::int64_t>(mesh.boundary_quads.size());

  Findings findings(options.findings_per_kind);
  const CellNumbers cells(mesh);
  report.is_complete = check_indices(mesh, cells, context, findings);
  if (report.is_complete) {
    report.cells = count_cells(mesh);
    if (report.cells.total() == 0) findings.add(Violation::no_cells, [&] { return std::pair(Point{}, std::string("the mesh has no cells")); });
    const bool with_cell_centres = options.quality && options.cell_centred;
    std::vector<std::uint32_t> neighbours;
    const FaceSlots slots(mesh, cells, find_open_sides(mesh.layers, context, with_cell_centres ? &neighbours : nullptr));
    const std::vector<double> volumes = options.quality ? tet_volumes(mesh, context) : std::vector<double>{};
    const FaceMatch match = match_faces(slots, mesh.points.size(), static_cast<std::uint64_t>(std::max<std::int64_t>(options.faces_at_a_time, 1)), volumes,
                                        with_cell_centres, options.limits, context);
    report_faces(mesh, slots, match, findings);
    context.progress(0.3);

    const CellScan scan = scan_explicit_cells(known ? known->columns : scan_columns(mesh, options.quality, options.limits, context), mesh, cells,
                                              options.quality, options.limits, context);
    for (const std::uint64_t number : scan.invalid)
      findings.add(Violation::invalid_cell, [&] {
        const Point center = cells.center(number);
        return std::pair(center, cells.name(number) + near_patch(mesh, center) + " is inverted or folded");
      });
    check_volumes(mesh, slots, match, scan, context, report, findings);
    check_symmetry(mesh, context, findings);
    check_periodic(mesh, report, findings);
    context.progress(0.5);

    std::optional<DualScan> dual;
    report.dual_checked = !findings.has_any_of("G1");
    if (report.dual_checked) {
      dual = check_dual(mesh, cells, known ? &known->lines : nullptr, options.limits, context, findings);
      report.dual_volume = dual->volume.value();
    }
    context.progress(0.7);
    if (options.quality) {
      report.quality = scan.quality.result();
      LazyGivenLayer given(mesh);
      judge_gates(mesh, cells, slots, match, scan, dual ? &*dual : nullptr, options.limits, given, context, report);
      judge_cell_centres(mesh, cells, slots, match, neighbours, options, given, context, report);
      report.quality_measured = true;
    }

    if (options.intersections) {
      check_crossings(mesh, slots, match, known && known->crossings ? &*known->crossings : nullptr, context, findings);
      check_cover(mesh, slots, context, findings);
      report.intersections_checked = true;
    }
  }
  findings.store(report);
  context.progress(1.0);
  return report;
}

LayerCheck::LayerCheck(std::unique_ptr<const Parts> parts) : parts_(std::move(parts)) {}
LayerCheck::LayerCheck(LayerCheck&&) noexcept = default;
LayerCheck& LayerCheck::operator=(LayerCheck&&) noexcept = default;
LayerCheck::~LayerCheck() = default;

LayerCheck check_ahead(const HybridMesh& mesh, const CheckOptions& options, const RunContext& context) {
  Findings unused(0);
  const CellNumbers cells(mesh);
  if (!check_indices(mesh, cells, context, unused)) return LayerCheck(nullptr);
  auto parts = std::make_unique<LayerCheck::Parts>(
      LayerCheck::Parts{scan_columns(mesh, options.quality, options.limits, context), scan_lines(mesh, options.limits, context), std::nullopt});
  if (options.intersections) {
    const FaceSlots slots(mesh, cells, {});
    CrossingCandidates candidates = crossing_candidates(mesh, slots, {}, slots.column_tops());
    CrossingPairs crossings = find_crossings(mesh.points.raw(), candidates.triangles, context);
    parts->crossings = CrossingTest{std::move(candidates.triangles), std::move(crossings)};
  }
  return LayerCheck(std::move(parts));
}

}  // namespace sterna
