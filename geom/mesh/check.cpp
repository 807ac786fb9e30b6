// The invariant walker as a list of steps. Together they prove a tiling. Positive cells that match face by face cover each point of the fluid equally often
// between two boundaries. The boundary does not cross itself, and its fluid side is covered once.
#include "geom/mesh/check.h"

#include "geom/mesh/cell_centred.h"
#include "geom/mesh/check_moved.h"
#include "geom/mesh/check_parts.h"
#include "geom/mesh/gate_items.h"
#include "geom/mesh/layer_scans.h"

namespace sterna {

using namespace check_parts;

struct LayerCheck::Parts {
  ScanChunks<CellScan> columns;
  ScanChunks<DualScan> lines;
  std::optional<ScanChunks<CellCentredScan>> centres;
  std::optional<CrossingTest> crossings;

  CellScan columns_joined(const GateTable& limits) const {
    return columns.joined(CellScan(limits), [](CellScan all, CellScan more) { return joined(std::move(all), std::move(more)); });
  }
  DualScan lines_joined(const GateTable& limits) const {
    return lines.joined(DualScan(limits), [](DualScan all, DualScan more) { return joined(std::move(all), std::move(more)); });
  }
  CellCentredScan centres_joined(const GateTable& limits) const {
    return centres->joined(CellCentredScan(limits), [](CellCentredScan all, const CellCentredScan& more) { return joined(std::move(all), more); });
  }
};

namespace {

/// \pre quality is measured
void judge_cell_centres(const LayerCheck::Parts* known, const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match,
                        std::span<const std::uint32_t> neighbours, const CheckOptions& options, LazyGivenLayer& given, const RunContext& context,
                        CheckReport& report) {
  if (!report.dual_checked) return;  // the mesh does not conform, which is already reported
  if (options.measures_cell_centres()) {
    CellCentredScan columns = known && known->centres ? known->centres_joined(options.limits) : scan_column_centres(mesh, neighbours, options.limits, context);
    return judge_cell_centred(scan_cell_centred(std::move(columns), mesh, cells, slots, match, neighbours, options.limits, context), mesh, cells, slots,
                              neighbours, options.limits, given, report);
  }
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
    const bool with_cell_centres = options.measures_cell_centres();
    std::vector<std::uint32_t> neighbours;
    const FaceSlots slots(mesh, cells, find_open_sides(mesh.layers, context, with_cell_centres ? &neighbours : nullptr));
    const std::vector<double> volumes = options.quality ? tet_volumes(mesh, context) : std::vector<double>{};
    const FaceMatch match = match_faces(slots, mesh.points.size(), static_cast<std::uint64_t>(std::max<std::int64_t>(options.faces_at_a_time, 1)), volumes,
                                        with_cell_centres, options.limits, context);
    report_faces(mesh, slots, match, findings);
    context.progress(0.3);

    const CellScan scan = scan_explicit_cells(known ? known->columns_joined(options.limits) : scan_columns(mesh, options.quality, options.limits, context),
                                              mesh, cells, options.quality, options.limits, context);
    report_cells(mesh, cells, scan, findings);
    check_volumes(mesh, slots, match, scan, context, report, findings);
    check_symmetry(mesh, context, findings);
    check_periodic(mesh, report, findings);
    context.progress(0.5);

    std::optional<DualScan> dual;
    report.dual_checked = !findings.has_any_of("G1");
    if (report.dual_checked) {
      const std::optional<DualScan> lines = known ? std::optional(known->lines_joined(options.limits)) : std::nullopt;
      dual = check_dual(mesh, cells, lines ? &*lines : nullptr, options.limits, context, findings);
      report.dual_volume = dual->volume.value();
    }
    context.progress(0.7);
    if (options.quality) {
      report.quality = scan.quality.result();
      LazyGivenLayer given(mesh);
      judge_gates(mesh, cells, slots, match, scan, dual ? &*dual : nullptr, options.limits, given, context, report);
      judge_cell_centres(known, mesh, cells, slots, match, neighbours, options, given, context, report);
      count_locations(mesh, cells, context, report);
      report.restrict_to(options.consumers);
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

namespace {

/// Scans the missing chunks.
void find_missing(LayerCheck::Parts& parts, const HybridMesh& mesh, const CellNumbers& cells, std::span<const std::uint32_t> neighbours,
                  const CheckOptions& options, const RunContext& context) {
  parts.columns.fill(context, [&](std::size_t begin, std::size_t end) { return scan_column_chunk(mesh, options.quality, options.limits, begin, end); });
  fill_lines(parts.lines, mesh, options.limits, context);
  if (parts.centres)
    parts.centres->fill(context, [&](std::size_t begin, std::size_t end) { return scan_centre_chunk(mesh, neighbours, options.limits, begin, end); });
  if (!options.intersections) return;
  const FaceSlots slots(mesh, cells, {});
  CrossingCandidates candidates = crossing_candidates(mesh, slots, {}, slots.column_tops());
  CrossingPairs crossings = find_crossings(mesh.points.raw(), candidates.triangles, context);
  parts.crossings = CrossingTest{std::move(candidates.triangles), std::move(crossings)};
}

std::vector<std::uint32_t> columns_beside(const HybridMesh& mesh, const CheckOptions& options, const RunContext& context) {
  std::vector<std::uint32_t> neighbours;
  if (options.measures_cell_centres()) find_open_sides(mesh.layers, context, &neighbours);
  return neighbours;
}

}  // namespace

LayerCheck check_ahead(const HybridMesh& mesh, const CheckOptions& options, const RunContext& context) {
  Findings unused(0);
  const CellNumbers cells(mesh);
  if (!check_indices(mesh, cells, context, unused)) return LayerCheck(nullptr);
  if (!mesh.prisms.empty() || !mesh.pyramids.empty() || !mesh.hexahedra.empty()) return LayerCheck(nullptr);  // scans of columns alone would miss these cells
  const std::size_t n_columns = mesh.layers.n_columns();
  auto parts =
      std::make_unique<LayerCheck::Parts>(LayerCheck::Parts{{n_columns, k_column_chunk}, {mesh.layers.n_lines(), k_line_chunk}, std::nullopt, std::nullopt});
  if (options.measures_cell_centres()) parts->centres.emplace(n_columns, k_centre_chunk);
  find_missing(*parts, mesh, cells, columns_beside(mesh, options, context), options, context);
  return LayerCheck(std::move(parts));
}

LayerCheck check_moved_lines(const LayerCheck& known, const HybridMesh& mesh, std::span<const std::uint32_t> lines, const CheckOptions& options,
                             const RunContext& context) {
  if (known.parts() == nullptr) return check_ahead(mesh, options, context);
  const std::vector<std::uint32_t> neighbours = columns_beside(mesh, options, context);
  std::vector<std::uint8_t> has_moved(mesh.layers.n_lines(), 0);
  for (const std::uint32_t line : lines) has_moved[line] = 1;
  std::vector<std::uint32_t> columns, columns_and_beside, lines_around;
  for (std::uint32_t c = 0; c < mesh.layers.n_columns(); ++c) {
    const auto& base = mesh.layers.base[c];
    if (!has_moved[base[0]] && !has_moved[base[1]] && !has_moved[base[2]]) continue;
    columns.push_back(c);
    lines_around.insert(lines_around.end(), base.begin(), base.end());
    columns_and_beside.push_back(c);
    for (std::size_t k = 0; k < 3 && !neighbours.empty(); ++k)
      if (neighbours[3 * c + k] != k_no_slot) columns_and_beside.push_back(neighbours[3 * c + k]);
  }
  auto parts = std::make_unique<LayerCheck::Parts>(*known.parts());
  parts->columns.forget(columns);
  parts->lines.forget(lines_around);
  if (parts->centres) parts->centres->forget(columns_and_beside);
  parts->crossings.reset();
  find_missing(*parts, mesh, CellNumbers(mesh), neighbours, options, context);
  return LayerCheck(std::move(parts));
}

}  // namespace sterna
