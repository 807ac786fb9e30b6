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
  Cell result{kind(column, layer), {}};
  if (result.kind == CellKind::prism) {
    for (std::size_t i = 0; i < 3; ++i) {
      result.nodes[i] = node(lines[i], layer);
      result.nodes[i + 3] = node(lines[i], layer + 1);
    }
    return result;
  }
  // Rotate the corners so that a is the ended line of a pyramid, or the continuing line of a tet; the cyclic sense (a, b, c) is kept.
  const bool is_pyramid = result.kind == CellKind::pyramid;
  std::size_t first = 0;
  while ((n_steps(lines[first]) <= layer) != is_pyramid) ++first;
  const std::uint32_t a = lines[first];
  const std::uint32_t b = lines[(first + 1) % 3];
  const std::uint32_t c = lines[(first + 2) % 3];
  if (is_pyramid) {
    // The base is the quad (b0, b1, c1, c0). Its normal points towards a, because (a, b, c) is counter-clockwise as seen from above.
    result.nodes = {node(b, layer), node(b, layer + 1), node(c, layer + 1), node(c, layer), top(a)};
    return result;
  }
  result.nodes = {node(a, layer), top(b), top(c), node(a, layer + 1)};
  return result;
}

LayerBlock::Side LayerBlock::side(std::size_t column, std::size_t corner, int layer) const {
  const std::uint32_t u = base[column][corner], v = base[column][(corner + 1) % 3];
  const bool goes_on_u = layer < n_steps(u), goes_on_v = layer < n_steps(v);
  Side result;
  if (!goes_on_u && !goes_on_v) return result;
  const auto add = [&](NodeId n) { result.nodes[result.size++] = n; };
  add(node(u, layer));
  add(node(v, layer));
  if (goes_on_v) add(node(v, layer + 1));
  if (goes_on_u) add(node(u, layer + 1));
  return result;
}

CellCounts count_cells(const HybridMesh& mesh) {
  CellCounts counts;
  for (std::size_t c = 0; c < mesh.layers.n_columns(); ++c) {
    const std::array<int, 3> ends = mesh.layers.ends_of_column(c);
    counts.prisms += ends[0];
    counts.pyramids += ends[1] - ends[0];
    counts.tetrahedra += ends[2] - ends[1];
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
