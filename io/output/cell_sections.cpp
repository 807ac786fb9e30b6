#include "io/output/cell_sections.h"

#include <string>

#include "geom/base/error.h"

namespace sterna::io {
namespace {

/// Stable counting sort of face numbers by patch.
template <class Face>
void sort_by_patch(const std::vector<Face>& faces, std::size_t n_patches, std::string_view what, std::vector<std::uint32_t>& sorted,
                   std::vector<std::size_t>& first) {
  first.assign(n_patches + 1, 0);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const PatchId patch = faces[i].patch;
    if (patch.index() >= n_patches)
      throw Error({.code = ErrorCode::mesh_invalid,
                   .attempted = "sorting boundary faces by patch",
                   .problem = "boundary " + std::string(what) + " " + std::to_string(i) +
                              (patch.is_valid() ? " has patch " + std::to_string(patch.value()) + " of " + std::to_string(n_patches) : " has no patch")});
    ++first[patch.index() + 1];
  }
  for (std::size_t p = 0; p < n_patches; ++p) first[p + 1] += first[p];
  std::vector<std::size_t> next = first;
  sorted.resize(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) sorted[next[faces[i].patch.index()]++] = static_cast<std::uint32_t>(i);
}

}  // namespace

CellSections::CellSections(Borrowed<const HybridMesh> of) : mesh_(&of.get()) {
  const HybridMesh& mesh = of;
  const LayerBlock& layers = mesh.layers;
  for (std::size_t c = 0; c < layers.n_columns() && all_columns_are_prisms_; ++c) all_columns_are_prisms_ = layers.is_prismatic(c);
  if (all_columns_are_prisms_) {
    numbers_[static_cast<std::size_t>(CellKind::prism)] =
        LayerNumbers(layers, layers.n_columns(), [&](std::uint64_t c) { return static_cast<std::uint64_t>(layers.layers_of_column(c)); });
    return;
  }
  for (const CellKind kind : {CellKind::prism, CellKind::pyramid, CellKind::tetrahedron}) {
    const auto count = [&](std::size_t c) {
      const auto [first, last] = layers.layers_of_kind(c, kind);
      return static_cast<std::uint64_t>(last - first);
    };
    std::vector<std::uint32_t>& columns = columns_[static_cast<std::size_t>(kind)];
    for (std::size_t c = 0; c < layers.n_columns(); ++c)
      if (count(c) > 0) columns.push_back(static_cast<std::uint32_t>(c));
    numbers_[static_cast<std::size_t>(kind)] = LayerNumbers(layers, columns.size(), [&](std::uint64_t i) { return count(columns[i]); });
  }
}

std::uint64_t CellSections::count(CellKind kind) const {
  const std::uint64_t in_columns = numbers_[static_cast<std::size_t>(kind)].size();
  switch (kind) {
    case CellKind::tetrahedron: return in_columns + mesh_->tetrahedra.size();
    case CellKind::pyramid: return in_columns + mesh_->pyramids.size();
    case CellKind::prism: return in_columns + mesh_->prisms.size();
    case CellKind::hexahedron: return in_columns + mesh_->hexahedra.size();
  }
  return 0;
}

std::uint64_t CellSections::total() const {
  std::uint64_t n = 0;
  for (const CellKind kind : k_kinds_in_file) n += count(kind);
  return n;
}

FacesByPatch::FacesByPatch(const HybridMesh& mesh) {
  sort_by_patch(mesh.boundary_triangles, mesh.patches.size(), "triangle", triangles_, first_triangle_);
  sort_by_patch(mesh.boundary_quads, mesh.patches.size(), "quad", quads_, first_quad_);
}

}  // namespace sterna::io
