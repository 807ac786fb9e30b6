// G9: measures how well the layer's last cell matches the tet above it. The ideal pair is a regular tet on a prism of 0.816 times its edge, whose volume is
// three times that of the tet.
#include <algorithm>
#include <cmath>
#include <optional>

#include "geom/math/measures.h"
#include "geom/mesh/forced_layer.h"
#include "geom/mesh/gate_items.h"
#include "geom/mesh/line_measures.h"

namespace sterna::check_parts {
namespace {

/// Ratio of the volume of a prism to that of a tet of the same base and height.
constexpr double k_regular_volumes = 3.0;

struct InterfaceScan {
  explicit InterfaceScan(const GateTable& limits)
      : height(info_of(Measure::interface_height), limits[Measure::interface_height]),
        volume(info_of(Measure::interface_volume), limits[Measure::interface_volume]) {}
  void add_height(double last_height, double mean_edge, std::uint64_t slot) {
    height.add(interface_jump(last_height, mean_edge), slot | (is_interface_low(last_height, mean_edge) ? GateScan::k_too_small : 0));
  }
  GateScan height, volume;  ///< ids are slots of the prism's face
};

/// Marks wall nodes at which multi-normal fans of opened ridges may begin: nodes that only have boundary triangles. (Where layers end on another wall, their
/// sides are quadrilaterals of that wall.) Empty without explicit prisms.
std::vector<std::uint8_t> possible_multi_normal_bases(const HybridMesh& mesh) {
  std::vector<std::uint8_t> is_base(mesh.prisms.empty() ? 0 : mesh.points.size(), 0);
  if (is_base.empty()) return is_base;
  for (const BoundaryTriangle& triangle : mesh.boundary_triangles)
    if (mesh.patches[triangle.patch].kind == PatchKind::wall)
      for (const NodeId node : triangle.nodes) is_base[node.index()] = 1;
  for (const BoundaryQuad& quad : mesh.boundary_quads)
    for (const NodeId node : quad.nodes) is_base[node.index()] = 0;
  return is_base;
}

/// Returns the mean edge of a triangle, m.
double edge_of(const HybridMesh& mesh, const Face& face) {
  const auto f = [&](std::size_t k) { return mesh.points[face.nodes[k]]; };
  return (distance(f(0), f(1)) + distance(f(1), f(2)) + distance(f(2), f(0))) / 3.0;
}

/// Returns the mean of the last steps of a column's lines, m, for the top of a column without collapsed lines.
std::optional<double> mean_last_height(const HybridMesh& mesh, const FaceSlots& slots, std::uint32_t slot) {
  const std::optional<std::uint32_t> column = slots.column_over(slot);
  if (!column || mesh.layers.n_collapsed(*column) > 0) return std::nullopt;
  double height = 0.0;
  for (const std::uint32_t line : mesh.layers.base[*column]) {
    const int n = mesh.layers.n_steps(line);
    height += distance(mesh.points[mesh.layers.node(line, n - 1)], mesh.points[mesh.layers.node(line, n)]) / 3.0;
  }
  return height;
}

}  // namespace

void judge_interface(const HybridMesh& mesh, const CellNumbers& cells, const FaceSlots& slots, const FaceMatch& match, std::span<const double> gaps,
                     const GateTable& limits, LazyGivenLayer& given, const RunContext& context, CheckReport& report) {
  const std::vector<std::uint8_t> possible_bases = possible_multi_normal_bases(mesh);
  const auto is_base = [&](NodeId node) { return possible_bases[node.index()] != 0; };
  const InterfaceScan scan = parallel_reduce(
      context, match.interface.size(), InterfaceScan(limits),
      [&](std::size_t begin, std::size_t end) {
        InterfaceScan part(limits);
        for (std::size_t i = begin; i < end; ++i) {
          const std::uint32_t slot = match.interface[i];
          const Face face = slots.face(slot);
          const Cell cell = cells.cell(slots.owner(slot));
          if (face.size != 3) continue;
          if (cell.kind != CellKind::prism) {  // the cell lies beside a line that ends one layer below the others
            if (const std::optional<double> height = mean_last_height(mesh, slots, slot)) part.add_height(*height, edge_of(mesh, face), slot);
            continue;
          }
          if (slots.prism_cap(slot) && std::any_of(face.nodes.begin(), face.nodes.begin() + 3, is_base))
            continue;  // the cell is in a multi-normal fan, beside
                       // its first cells
          WedgePoints p;
          for (std::size_t k = 0; k < 6; ++k) p[k] = mesh.points[cell.nodes[k]];
          const double edge = edge_of(mesh, face);
          const double height = (distance(p[0], p[3]) + distance(p[1], p[4]) + distance(p[2], p[5])) / 3.0;
          const auto& t = mesh.tetrahedra[slots.tet_of(match.interface_tets[i])];
          const double tet = tet_volume(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]);
          part.add_height(height, edge, slot);
          const double ratio = k_regular_volumes * tet / wedge_volume(p);
          part.volume.add(deviation(ratio), slot | (ratio < 1.0 ? GateScan::k_too_small : 0));
        }
        return part;
      },
      [](InterfaceScan all, const InterfaceScan& more) {
        all.height.merge(more.height);
        all.volume.merge(more.volume);
        return all;
      });
  const SlotItems face{slots, "top of "};
  const auto prove_height = [&](std::uint64_t id, double) {
    const std::uint64_t number = slots.owner(static_cast<std::uint32_t>(id));
    if (gaps.empty() || number >= cells.first_prism()) return std::optional<Forcing>();  // the face is not on a column, or the layer request is unknown
    return given.get().interface_height(number / static_cast<std::uint64_t>(mesh.layers.n_layers), gaps, limits[Measure::interface_height].hard);
  };
  const auto put = [&](GateResult result) {
    if (scan.height.empty()) result.reason = "no tetrahedron is adjacent to the top of the layer";
    report.gates[static_cast<std::size_t>(result.measure)] = std::move(result);
  };
  put(scan.height.result(face, prove_height));
  put(scan.volume.result(face));
}

}  // namespace sterna::check_parts
