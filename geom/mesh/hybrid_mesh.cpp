#include "geom/mesh/hybrid_mesh.h"

namespace sterna {
namespace {

constexpr std::array<LocalFace, 4> k_tet_faces = {{{{0, 2, 1, 0}, 3}, {{0, 1, 3, 0}, 3}, {{1, 2, 3, 0}, 3}, {{2, 0, 3, 0}, 3}}};
constexpr std::array<LocalFace, 5> k_pyramid_faces = {{{{0, 3, 2, 1}, 4}, {{0, 1, 4, 0}, 3}, {{1, 2, 4, 0}, 3}, {{2, 3, 4, 0}, 3}, {{3, 0, 4, 0}, 3}}};
constexpr std::array<LocalFace, 5> k_prism_faces = {{{{0, 1, 4, 3}, 4}, {{1, 2, 5, 4}, 4}, {{2, 0, 3, 5}, 4}, {{0, 2, 1, 0}, 3}, {{3, 4, 5, 0}, 3}}};
constexpr std::array<LocalFace, 6> k_hex_faces = {
    {{{0, 3, 2, 1}, 4}, {{0, 1, 5, 4}, 4}, {{1, 2, 6, 5}, 4}, {{2, 3, 7, 6}, 4}, {{0, 4, 7, 3}, 4}, {{4, 5, 6, 7}, 4}}};

}  // namespace

std::string_view to_string(CellKind kind) {
  switch (kind) {
    case CellKind::tetrahedron: return "tetrahedron";
    case CellKind::pyramid: return "pyramid";
    case CellKind::prism: return "prism";
    case CellKind::hexahedron: return "hexahedron";
  }
  return "";
}

std::span<const LocalFace> cell_faces(CellKind kind) {
  switch (kind) {
    case CellKind::tetrahedron: return k_tet_faces;
    case CellKind::pyramid: return k_pyramid_faces;
    case CellKind::prism: return k_prism_faces;
    case CellKind::hexahedron: return k_hex_faces;
  }
  return {};
}

Cell LayerBlock::cell(std::size_t column, int layer) const {
  const auto& lines = base[column];
  const int n_down = n_collapsed(column);
  Cell result;
  if (n_down == 0) {
    result.kind = CellKind::prism;
    for (std::size_t i = 0; i < 3; ++i) {
      result.nodes[i] = node(lines[i], layer);
      result.nodes[i + 3] = node(lines[i], layer + 1);
    }
    return result;
  }
  // Rotate so that a = the collapsed line of a pyramid, or the standing line of a tet; the cyclic sense (a, b, c) is kept.
  const std::uint8_t wanted = n_down == 1 ? 1 : 0;
  std::size_t first = 0;
  while (is_collapsed[lines[first]] != wanted) ++first;
  const std::uint32_t a = lines[first];
  const std::uint32_t b = lines[(first + 1) % 3];
  const std::uint32_t c = lines[(first + 2) % 3];
  if (n_down == 1) {
    // Base quad (b0, b1, c1, c0): its normal points towards a, because (a, b, c) is seen counter-clockwise from above.
    result.kind = CellKind::pyramid;
    result.nodes = {node(b, layer), node(b, layer + 1), node(c, layer + 1), node(c, layer), node(a, 0)};
    return result;
  }
  result.kind = CellKind::tetrahedron;
  result.nodes = {node(a, layer), node(b, 0), node(c, 0), node(a, layer + 1)};
  return result;
}

CellCounts count_cells(const HybridMesh& mesh) {
  CellCounts counts;
  for (std::size_t c = 0; c < mesh.layers.n_columns(); ++c) {
    const std::int64_t n = mesh.layers.layers_of_column(c);
    switch (mesh.layers.n_collapsed(c)) {
      case 0: counts.prisms += n; break;
      case 1: counts.pyramids += n; break;
      case 2: counts.tetrahedra += n; break;
      default: break;
    }
  }
  counts.prisms += static_cast<std::int64_t>(mesh.prisms.size());
  counts.pyramids += static_cast<std::int64_t>(mesh.pyramids.size());
  counts.hexahedra += static_cast<std::int64_t>(mesh.hexahedra.size());
  counts.tetrahedra += static_cast<std::int64_t>(mesh.tetrahedra.size());
  return counts;
}

HybridMesh explicit_cells(HybridMesh mesh) {
  HybridMesh flat;
  const auto store = [](auto& cells, const Cell& cell) {
    auto& nodes = cells.emplace_back();
    std::copy_n(cell.nodes.begin(), nodes.size(), nodes.begin());
  };
  for_each_cell(mesh, [&](const Cell& cell) {
    switch (cell.kind) {
      case CellKind::tetrahedron: store(flat.tetrahedra, cell); break;
      case CellKind::pyramid: store(flat.pyramids, cell); break;
      case CellKind::prism: store(flat.prisms, cell); break;
      case CellKind::hexahedron: store(flat.hexahedra, cell); break;
    }
  });
  flat.points = std::move(mesh.points);
  flat.boundary_triangles = std::move(mesh.boundary_triangles);
  flat.boundary_quads = std::move(mesh.boundary_quads);
  flat.patches = std::move(mesh.patches);
  return flat;
}

}  // namespace sterna
