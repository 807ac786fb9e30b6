// Evaluates the QUALITY gates from the results of the walker's steps, in the order of Measure.
#include <optional>

#include "geom/mesh/forced.h"
#include "geom/mesh/forced_layer.h"
#include "geom/mesh/gate_items.h"

namespace sterna::check_parts {
namespace {

constexpr const char* k_not_conforming = "the mesh does not conform (G1)";
constexpr const char* k_no_model = "needs the model: mesh:check{ wall = wall } with the surface of surface_mesh, or sterna check mesh.su2 --model model.step";

}  // namespace

std::pair<Point, std::string> describe_node(const HybridMesh& mesh, std::uint64_t node) {
  std::string what = "node " + std::to_string(node);
  const LayerBlock& layers = mesh.layers;
  for (std::size_t k = 0; k < layers.n_lines(); ++k) {
    const std::uint64_t first = layers.first_node[k];
    if (node < first || node > first + static_cast<std::uint64_t>(layers.n_steps(k))) continue;
    what += " (line " + std::to_string(k) + ", layer " + std::to_string(node - first) + ")";
    break;
  }
  return {mesh.points.raw()[node], what};
}

void judge_gates(const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match, const CellScan& scan, const DualScan* dual,
                 const GateTable& limits, LazyGivenLayer& layer, const RunContext& context, CheckReport& report) {
  const NodeItems node{mesh};
  const CellItems cell{cells};
  const SlotItems face{slots, "face of "};
  for (const MeasureInfo& info : measures())
    report.gates.push_back(not_checked(info.measure, limits, dual == nullptr ? k_not_conforming : "the mesh has no items of this type"));
  for (const Measure measure : {Measure::cad_distance, Measure::cad_normal}) report.gates[static_cast<std::size_t>(measure)].reason = k_no_model;
  const auto put = [&](GateResult result) { report.gates[static_cast<std::size_t>(result.measure)] = std::move(result); };

  put(scan.scaled_jacobian.result(cell));
  std::optional<GivenBoundary> given;
  if (scan.min_dihedral.has_beyond_hard() || (dual != nullptr && dual->edge_ratio.has_beyond_hard())) given.emplace(mesh);
  put(scan.min_dihedral.result(cell, [&](std::uint64_t id, double) {
    if (dual == nullptr || id < cells.first_tetrahedron()) return std::optional<Forcing>();  // for cells of columns their own edges decide, not the boundary
    return given->min_dihedral(mesh.tetrahedra[id - cells.first_tetrahedron()], limits[Measure::min_dihedral].hard);
  }));
  put(scan.max_dihedral.result(cell));
  if (dual == nullptr) return;
  if (match.tet_growth) put(match.tet_growth->result(face));
  put(dual->orthogonality.result(node, [&](std::uint64_t id, double) { return layer.get().orthogonality(NodeId(id), limits[Measure::orthogonality].hard); }));
  for (const GateScan* measure : {&dual->closure, &dual->sub_volume_ratio, &dual->face_area_ratio, &dual->relative_face_area_ratio}) put(measure->result(node));
  put(dual->edge_ratio.result(node, [&](std::uint64_t id, double) { return given->edge_ratio(NodeId(id), limits[Measure::edge_ratio].hard); }));
  if (mesh.layers.n_columns() == 0) report.gates[static_cast<std::size_t>(Measure::relative_face_area_ratio)].reason = "the mesh has no columns of layers";
  const std::vector<double> gaps = judge_layers(mesh, slots, match, limits, context, report);
  judge_interface(mesh, cells, slots, match, gaps, limits, layer, context, report);
}

}  // namespace sterna::check_parts
