#include "volmesh/layer/explicit_cells.h"

#include <algorithm>
#include <string>

#include "geom/math/measures.h"
#include "geom/mesh/dual_metrics.h"

namespace sterna::volmesh {
namespace {

template <std::size_t N>
std::array<Vec3, N> points_of(const HybridMesh& mesh, const std::array<NodeId, N>& nodes) {
  std::array<Vec3, N> points;
  for (std::size_t k = 0; k < N; ++k) points[k] = mesh.points[nodes[k]];
  return points;
}

}  // namespace

void ExplicitCells::add_cell(const std::array<NodeId, 3>& low, const std::array<NodeId, 3>& high, const std::array<Line, 3>& lines) {
  std::array<bool, 3> is_down;
  for (std::size_t k = 0; k < 3; ++k) is_down[k] = low[k] == high[k];
  const int n_down = is_down[0] + is_down[1] + is_down[2];
  if (n_down == 3) return;
  if (n_down == 0) return add_prism({low[0], low[1], low[2], high[0], high[1], high[2]}, lines);
  std::size_t a = 0;
  while (is_down[a] != (n_down == 1)) ++a;
  const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
  if (n_down == 1) add_pyramid({low[b], high[b], high[c], low[c], low[a]}, lines);
  else add_tet({low[a], low[b], low[c], high[a]}, lines);
}

ErrorInfo ExplicitCells::find_invalid(const std::function<void(Line)>& on_invalid) const {
  ErrorInfo info;
  const auto look_at = [&](const auto& cells, const std::vector<Lines>& lines_of_cells, CellKind kind, const auto& is_valid) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      Cell cell{kind, {}};
      std::ranges::copy(cells[i], cell.nodes.begin());
      if (is_valid(points_of(mesh_, cells[i])) && (kind == CellKind::tetrahedron || are_sub_volumes_positive(mesh_, cell))) continue;
      info.add_location(mesh_.points[cells[i][0]], std::string(to_string(kind)) + " " + std::to_string(i));
      for (const Line line : lines_of_cells[i]) on_invalid(line);
    }
  };
  look_at(mesh_.prisms, prism_lines_, CellKind::prism, [](const WedgePoints& p) { return is_wedge_valid(p); });
  look_at(mesh_.pyramids, pyramid_lines_, CellKind::pyramid, [](const std::array<Vec3, 5>& p) { return is_pyramid_valid(p); });
  look_at(mesh_.hexahedra, hex_lines_, CellKind::hexahedron, [](const std::array<Vec3, 8>& p) { return is_hexahedron_valid(p); });
  look_at(mesh_.tetrahedra, tet_lines_, CellKind::tetrahedron, [](const std::array<Vec3, 4>& p) { return is_tet_valid(p); });
  return info;
}

}  // namespace sterna::volmesh
