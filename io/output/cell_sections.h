// The cells of a mesh sorted by kind, for writers: random access to cell i of a kind without expanding the columns' cells.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/mesh/hybrid_mesh.h"
#include "io/output/layer_numbers.h"

namespace sterna::io {

/// Order of cell kinds in files: prisms first (the layers before the rest), tetrahedra last.
inline constexpr std::array<CellKind, 4> k_kinds_in_file = {CellKind::prism, CellKind::pyramid, CellKind::hexahedron, CellKind::tetrahedron};

/// View of a mesh. The cells of one kind are first those of the columns (column by column, layer by layer), then the explicit cells. A mesh of columns and its
/// explicit_cells() thus have the same sequence.
class CellSections {
 public:
  explicit CellSections(Borrowed<const HybridMesh> mesh);

  std::uint64_t count(CellKind kind) const;
  std::uint64_t total() const;

  /// Calls f(nodes in CGNS order, layer) for the cells [begin, end) of a kind; layer counts from 1 at the wall, 0 = an explicit cell.
  template <class F>
  void for_each(CellKind kind, std::uint64_t begin, std::uint64_t end, const F& f) const {
    const LayerNumbers& numbers = numbers_[static_cast<std::size_t>(kind)];
    const std::uint64_t n_in_columns = numbers.size();
    std::uint64_t i = begin;
    if (i < n_in_columns && i < end) {
      auto [column, layer] = numbers.at(i);
      for (; i < end && i < n_in_columns; ++i) {
        const std::size_t at = column_at(kind, column);
        const int j = static_cast<int>(layer) + (all_columns_are_prisms_ ? 0 : mesh_->layers.layers_of_kind(at, kind)[0]);
        const Cell cell = mesh_->layers.cell(at, j);
        f(cell.span(), j + 1);
        if (++layer == numbers.n_layers(column)) {
          layer = 0;
          ++column;
        }
      }
    }
    for (; i < end; ++i) f(explicit_cell(kind, i - n_in_columns), 0);
  }

 private:
  std::size_t column_at(CellKind kind, std::uint64_t i) const { return all_columns_are_prisms_ ? i : columns_[static_cast<std::size_t>(kind)][i]; }
  std::span<const NodeId> explicit_cell(CellKind kind, std::uint64_t i) const {
    switch (kind) {
      case CellKind::tetrahedron: return mesh_->tetrahedra[i];
      case CellKind::pyramid: return mesh_->pyramids[i];
      case CellKind::prism: return mesh_->prisms[i];
      case CellKind::hexahedron: return mesh_->hexahedra[i];
    }
    return {};
  }

  const HybridMesh* mesh_;
  bool all_columns_are_prisms_ = true;
  std::array<std::vector<std::uint32_t>, 4> columns_;  ///< columns with cells of each kind; empty if all columns consist of prisms
  std::array<LayerNumbers, 4> numbers_;                ///< numbering of the cells in columns, by kind
};

/// Boundary faces by patch, in mesh order within each patch, for marker-oriented formats.
class FacesByPatch {
 public:
  /// \throws Error(mesh_invalid) for a face whose patch does not exist.
  explicit FacesByPatch(const HybridMesh& mesh);
  std::span<const std::uint32_t> triangles(PatchId patch) const { return part(triangles_, first_triangle_, patch); }
  std::span<const std::uint32_t> quads(PatchId patch) const { return part(quads_, first_quad_, patch); }
  std::size_t count(PatchId patch) const { return triangles(patch).size() + quads(patch).size(); }

 private:
  static std::span<const std::uint32_t> part(const std::vector<std::uint32_t>& faces, const std::vector<std::size_t>& first, PatchId patch) {
    return {faces.data() + first[patch.index()], first[patch.index() + 1] - first[patch.index()]};
  }
  std::vector<std::uint32_t> triangles_, quads_;
  std::vector<std::size_t> first_triangle_, first_quad_;
};

}  // namespace sterna::io
