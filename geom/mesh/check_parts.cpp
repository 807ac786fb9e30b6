#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {
namespace {

template <class Nodes>
Point mean_of(const HybridMesh& mesh, const Nodes& nodes, std::size_t n) {
  Point sum;
  for (std::size_t k = 0; k < n; ++k) sum += mesh.points[nodes[k]];
  return sum / static_cast<double>(n);
}

/// Returns the number of cells of a kind in the columns before `end`.
std::uint64_t n_cells_of_kind(const LayerBlock& layers, std::size_t end, CellKind kind) {
  std::uint64_t n = 0;
  for (std::size_t c = 0; c < end; ++c) {
    const auto [first, last] = layers.layers_of_kind(c, kind);
    n += static_cast<std::uint64_t>(last - first);
  }
  return n;
}

}  // namespace

bool Findings::has_any_of(std::string_view gate) const {
  for (std::size_t k = 0; k < k_n_violations; ++k)
    if (counts_[k] > 0 && gate_of(static_cast<Violation>(k)) == gate) return true;
  return false;
}

void Findings::store(CheckReport& report) {
  for (std::size_t k = 0; k < k_n_violations; ++k)
    if (counts_[k] > 0) report.counts.emplace_back(static_cast<Violation>(k), counts_[k]);
  std::stable_sort(kept_.begin(), kept_.end(), [](const CheckFinding& a, const CheckFinding& b) { return a.violation < b.violation; });
  report.findings = std::move(kept_);
}

CellNumbers::CellNumbers(Borrowed<const HybridMesh> mesh) : mesh_(mesh) {
  first_[0] = std::uint64_t{mesh->layers.n_columns()} * static_cast<std::uint64_t>(std::max(mesh->layers.n_layers, 0));
  first_[1] = first_[0] + mesh->prisms.size();
  first_[2] = first_[1] + mesh->pyramids.size();
  first_[3] = first_[2] + mesh->hexahedra.size();
}

Cell CellNumbers::cell(std::uint64_t number) const {
  if (number < first_[0]) {
    const auto n = static_cast<std::uint64_t>(mesh_.layers.n_layers);
    return mesh_.layers.cell(number / n, static_cast<int>(number % n));
  }
  Cell cell;
  const auto take = [&](CellKind kind, const auto& nodes) {
    cell.kind = kind;
    std::copy(nodes.begin(), nodes.end(), cell.nodes.begin());
    return cell;
  };
  if (number < first_[1]) return take(CellKind::prism, mesh_.prisms[number - first_[0]]);
  if (number < first_[2]) return take(CellKind::pyramid, mesh_.pyramids[number - first_[1]]);
  if (number < first_[3]) return take(CellKind::hexahedron, mesh_.hexahedra[number - first_[2]]);
  return take(CellKind::tetrahedron, mesh_.tetrahedra[number - first_[3]]);
}

Point CellNumbers::center(std::uint64_t number) const {
  const Cell c = cell(number);
  return mean_of(mesh_, c.nodes, c.span().size());
}

std::string CellNumbers::name(std::uint64_t number) const {
  const auto of_kind = [](CellKind kind, std::uint64_t n) { return std::string(to_string(kind)) + " " + std::to_string(n); };
  const LayerBlock& layers = mesh_.layers;
  const auto n_layers = static_cast<std::uint64_t>(std::max(layers.n_layers, 0));
  const auto in_columns = [&](CellKind kind) { return n_cells_of_kind(layers, layers.n_columns(), kind); };
  if (number < first_[0]) {
    const std::uint64_t column = number / n_layers, layer = number % n_layers;
    const CellKind kind = layers.kind(column, static_cast<int>(layer));
    const std::uint64_t within = layer - static_cast<std::uint64_t>(layers.layers_of_kind(column, kind)[0]);
    return of_kind(kind, n_cells_of_kind(layers, column, kind) + within) + " (column " + std::to_string(column) + ", layer " + std::to_string(layer) + ")";
  }
  if (number < first_[1]) return of_kind(CellKind::prism, in_columns(CellKind::prism) + number - first_[0]);
  if (number < first_[2]) return of_kind(CellKind::pyramid, in_columns(CellKind::pyramid) + number - first_[1]);
  if (number < first_[3]) return of_kind(CellKind::hexahedron, number - first_[2]);
  return of_kind(CellKind::tetrahedron, in_columns(CellKind::tetrahedron) + number - first_[3]);
}

FaceSlots::FaceSlots(Borrowed<const HybridMesh> mesh, Borrowed<const CellNumbers> cells, std::vector<OpenSide> open_sides)
    : mesh_(mesh), cells_(cells), open_sides_(std::move(open_sides)) {
  const auto n_layers = static_cast<std::uint64_t>(std::max(mesh->layers.n_layers, 0));
  const std::array<std::uint64_t, k_n_blocks> sizes = {2 * mesh->layers.n_columns(),    open_sides_.size() * n_layers, 5 * mesh->prisms.size(),
                                                       5 * mesh->pyramids.size(),       6 * mesh->hexahedra.size(),    4 * mesh->tetrahedra.size(),
                                                       mesh->boundary_triangles.size(), mesh->boundary_quads.size()};
  std::uint64_t first = 0;
  for (std::size_t block = 0; block < k_n_blocks; ++block) {
    first += sizes[block];
    if (first >= (std::uint64_t{1} << 31)) throw_id_overflow(first);
    first_[block + 1] = static_cast<std::uint32_t>(first);
  }
}

Face FaceSlots::column_cap(std::uint32_t i) const {
  const LayerBlock& layers = mesh_.layers;
  const std::size_t column = i / 2;
  if (layers.layers_of_column(column) < 1) return {};
  const auto& b = layers.base[column];
  if (i % 2 == 0) return {{layers.node(b[0], 0), layers.node(b[2], 0), layers.node(b[1], 0)}, 3};
  return {{layers.top(b[0]), layers.top(b[1]), layers.top(b[2])}, 3};
}

std::vector<std::uint32_t> FaceSlots::column_tops() const {
  std::vector<std::uint32_t> tops;
  for (std::uint32_t slot = 1; slot < first_[k_sides]; slot += 2)
    if (column_cap(slot).size > 0) tops.push_back(slot);
  return tops;
}

Face FaceSlots::column_side(std::uint32_t i) const {
  const LayerBlock& layers = mesh_.layers;
  const OpenSide side = open_sides_[i / static_cast<std::uint32_t>(layers.n_layers)];
  const int layer = static_cast<int>(i % static_cast<std::uint32_t>(layers.n_layers));
  const LayerBlock::Side face = layers.side(side.column, side.corner, layer);
  return {face.nodes, face.size};
}

Face FaceSlots::face(std::uint32_t slot) const {
  const auto of_cell = [&](CellKind kind, Block block, const auto& cells) {
    const auto local_faces = cell_faces(kind);
    const std::uint32_t i = slot - first_[block];
    const LocalFace& local = local_faces[i % local_faces.size()];
    Face face;
    face.size = local.size;
    for (std::size_t k = 0; k < local.size; ++k) face.nodes[k] = cells[i / local_faces.size()][local.nodes[k]];
    return face;
  };
  if (slot < first_[k_sides]) return column_cap(slot);
  if (slot < first_[k_prisms]) return column_side(slot - first_[k_sides]);
  if (slot < first_[k_pyramids]) return of_cell(CellKind::prism, k_prisms, mesh_.prisms);
  if (slot < first_[k_hexahedra]) return of_cell(CellKind::pyramid, k_pyramids, mesh_.pyramids);
  if (slot < first_[k_tetrahedra]) return of_cell(CellKind::hexahedron, k_hexahedra, mesh_.hexahedra);
  if (slot < first_[k_boundary_triangles]) return of_cell(CellKind::tetrahedron, k_tetrahedra, mesh_.tetrahedra);
  if (slot < first_[k_boundary_quads]) {
    const auto& n = mesh_.boundary_triangles[slot - first_[k_boundary_triangles]].nodes;
    return {{n[0], n[1], n[2]}, 3};
  }
  return {mesh_.boundary_quads[slot - first_[k_boundary_quads]].nodes, 4};
}

Point FaceSlots::center(std::uint32_t slot) const {
  const Face f = face(slot);
  return mean_of(mesh_, f.nodes, f.size);
}

std::uint64_t FaceSlots::owner(std::uint32_t slot) const {
  const auto n_layers = static_cast<std::uint64_t>(std::max(mesh_.layers.n_layers, 0));
  if (slot < first_[k_sides]) return (slot / 2) * n_layers + (slot % 2 == 0 ? 0 : static_cast<std::uint64_t>(mesh_.layers.layers_of_column(slot / 2)) - 1);
  if (slot < first_[k_prisms]) {
    const std::uint32_t i = slot - first_[k_sides];
    return open_sides_[i / n_layers].column * n_layers + i % n_layers;
  }
  if (slot < first_[k_pyramids]) return cells_.first_prism() + (slot - first_[k_prisms]) / 5;
  if (slot < first_[k_hexahedra]) return cells_.first_pyramid() + (slot - first_[k_pyramids]) / 5;
  if (slot < first_[k_tetrahedra]) return cells_.first_hexahedron() + (slot - first_[k_hexahedra]) / 6;
  return cells_.first_tetrahedron() + (slot - first_[k_tetrahedra]) / 4;
}

PatchId FaceSlots::patch(std::uint32_t slot) const {
  if (slot < first_[k_boundary_quads]) return mesh_.boundary_triangles[slot - first_[k_boundary_triangles]].patch;
  return mesh_.boundary_quads[slot - first_[k_boundary_quads]].patch;
}

std::string FaceSlots::name(std::uint32_t slot) const {
  if (!is_boundary(slot)) return cells_.name(owner(slot));
  const bool is_quad = slot >= first_[k_boundary_quads];
  const std::uint32_t number = slot - first_[is_quad ? k_boundary_quads : k_boundary_triangles];
  return (is_quad ? "boundary quad " : "boundary triangle ") + std::to_string(number) + ", patch " + patch_name(mesh_, patch(slot));
}

std::string patch_name(const HybridMesh& mesh, PatchId patch) {
  return patch.index() < mesh.patches.size() ? mesh.patches[patch].name : "number " + std::to_string(patch.value()) + " (which does not exist)";
}

std::string near_patch(const HybridMesh& mesh, const Point& p) {
  double nearest = std::numeric_limits<double>::infinity();
  PatchId patch;
  const auto look_at = [&](const auto& faces) {
    for (const auto& face : faces) {
      const double d = norm2(mean_of(mesh, face.nodes, face.nodes.size()) - p);
      if (d >= nearest) continue;
      nearest = d;
      patch = face.patch;
    }
  };
  look_at(mesh.boundary_triangles);
  look_at(mesh.boundary_quads);
  return patch.is_valid() ? ", near patch " + patch_name(mesh, patch) : "";
}

}  // namespace sterna::check_parts
