#include "io/mesh/orientation.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "geom/base/parallel.h"
#include "geom/math/measures.h"

namespace sterna::io {
namespace {

/// Returns the exact volume of a cell with bilinear faces. If sides were split along one diagonal, a valid but warped prism could have a negative volume.
template <std::size_t N>
double signed_volume(const HybridMesh& mesh, const std::array<NodeId, N>& nodes) {
  std::array<Point, N> p;
  for (std::size_t k = 0; k < N; ++k) p[k] = mesh.points[nodes[k]];
  if constexpr (N == 4) return tet_volume(p[0], p[1], p[2], p[3]);
  if constexpr (N == 5) return pyramid_volume(p);
  if constexpr (N == 6) return wedge_volume(p);
  if constexpr (N == 8) return hexahedron_volume(p);
}

template <std::size_t N>
void flip(std::array<NodeId, N>& nodes) {
  if constexpr (N == 4) std::swap(nodes[1], nodes[2]);
  if constexpr (N == 5) std::swap(nodes[1], nodes[3]);
  if constexpr (N == 6) {
    std::swap(nodes[1], nodes[2]);
    std::swap(nodes[4], nodes[5]);
  }
  if constexpr (N == 8) {
    std::swap(nodes[1], nodes[3]);
    std::swap(nodes[5], nodes[7]);
  }
}

template <std::size_t N>
std::int64_t flip_cells(const HybridMesh& mesh, std::vector<std::array<NodeId, N>>& cells, const RunContext& context) {
  return parallel_reduce(
      context, cells.size(), std::int64_t{0},
      [&](std::size_t begin, std::size_t end) {
        std::int64_t n = 0;
        for (std::size_t i = begin; i < end; ++i) {
          if (signed_volume(mesh, cells[i]) >= 0.0) continue;
          flip(cells[i]);
          ++n;
        }
        return n;
      },
      [](std::int64_t a, std::int64_t b) { return a + b; });
}

/// Table of boundary faces by their lowest node. Triangles are numbered first, then quads.
class FaceTable {
 public:
  explicit FaceTable(const HybridMesh& mesh) : mesh_(mesh), first_(mesh.points.size() + 1, 0) {
    const std::size_t n_faces = mesh.boundary_triangles.size() + mesh.boundary_quads.size();
    for (std::size_t f = 0; f < n_faces; ++f) ++first_[lowest(nodes(f)) + 1];
    for (std::size_t i = 0; i + 1 < first_.size(); ++i) first_[i + 1] += first_[i];
    std::vector<std::uint64_t> next(first_.begin(), first_.end() - 1);
    faces_.resize(n_faces);
    for (std::size_t f = 0; f < n_faces; ++f) faces_[next[lowest(nodes(f))]++] = f;
  }

  std::span<const NodeId> nodes(std::size_t face) const {
    const std::size_t n = mesh_.boundary_triangles.size();
    if (face < n) return mesh_.boundary_triangles[face].nodes;
    return mesh_.boundary_quads[face - n].nodes;
  }

  /// Calls f(face, is_reversed) for each boundary face with the nodes of a cell's face, given in outward orientation.
  template <class F>
  void find(std::span<const NodeId> outward, const F& f) const {
    const std::uint32_t key = lowest(outward);
    for (std::uint64_t i = first_[key]; i < first_[key + 1]; ++i) {
      const std::span<const NodeId> other = nodes(faces_[i]);
      if (other.size() != outward.size()) continue;
      const std::size_t n = other.size();
      const std::size_t shift = static_cast<std::size_t>(std::find(other.begin(), other.end(), outward[0]) - other.begin());
      if (shift == n) continue;
      bool is_same = true, is_reversed = true;
      for (std::size_t k = 1; k < n; ++k) {
        is_same = is_same && other[(shift + k) % n] == outward[k];
        is_reversed = is_reversed && other[(shift + n - k) % n] == outward[k];
      }
      if (is_same || is_reversed) f(faces_[i], is_reversed);
    }
  }

 private:
  static std::uint32_t lowest(std::span<const NodeId> nodes) { return std::min_element(nodes.begin(), nodes.end())->value(); }

  const HybridMesh& mesh_;
  std::vector<std::uint64_t> first_;  ///< by node
  std::vector<std::uint64_t> faces_;
};

template <std::size_t N>
void find_reversed(CellKind kind, const std::vector<std::array<NodeId, N>>& cells, const FaceTable& table, std::vector<std::uint64_t>& reversed,
                   const RunContext& context) {
  const auto append = [](std::vector<std::uint64_t> a, std::vector<std::uint64_t> b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  const auto found = parallel_reduce(
      context, cells.size(), std::vector<std::uint64_t>{},
      [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint64_t> part;
        for (std::size_t i = begin; i < end; ++i) {
          for (const LocalFace& face : cell_faces(kind)) {
            std::array<NodeId, 4> nodes;
            for (std::size_t k = 0; k < face.size; ++k) nodes[k] = cells[i][face.nodes[k]];
            table.find({nodes.data(), face.size}, [&](std::uint64_t f, bool is_reversed) {
              if (is_reversed) part.push_back(f);
            });
          }
        }
        return part;
      },
      append);
  reversed.insert(reversed.end(), found.begin(), found.end());
}

std::int64_t turn_faces(HybridMesh& mesh, const RunContext& context) {
  const FaceTable table(mesh);
  std::vector<std::uint64_t> reversed;
  find_reversed(CellKind::tetrahedron, mesh.tetrahedra, table, reversed, context);
  find_reversed(CellKind::pyramid, mesh.pyramids, table, reversed, context);
  find_reversed(CellKind::prism, mesh.prisms, table, reversed, context);
  find_reversed(CellKind::hexahedron, mesh.hexahedra, table, reversed, context);
  std::sort(reversed.begin(), reversed.end());  // a face between two cells may have been found twice
  reversed.erase(std::unique(reversed.begin(), reversed.end()), reversed.end());
  const std::size_t n_triangles = mesh.boundary_triangles.size();
  for (const std::uint64_t f : reversed) {
    if (f < n_triangles) std::swap(mesh.boundary_triangles[f].nodes[1], mesh.boundary_triangles[f].nodes[2]);
    else std::swap(mesh.boundary_quads[f - n_triangles].nodes[1], mesh.boundary_quads[f - n_triangles].nodes[3]);
  }
  return static_cast<std::int64_t>(reversed.size());
}

/// Returns the number of flipped cells that were inverted. Prisms that were all flipped follow another convention, unless the whole mesh is mirrored.
std::int64_t n_inverted(const HybridMesh& mesh, const FlipCounts& counts) {
  const std::int64_t n_prisms = counts.cells[static_cast<std::size_t>(CellKind::prism)];
  const std::int64_t n_others = std::accumulate(counts.cells.begin(), counts.cells.end(), -n_prisms);
  const bool is_mirrored = n_others > 0 && n_others == static_cast<std::int64_t>(mesh.tetrahedra.size() + mesh.pyramids.size() + mesh.hexahedra.size());
  const bool is_convention = n_prisms == static_cast<std::int64_t>(mesh.prisms.size()) && !is_mirrored;
  return n_others + (is_convention ? 0 : n_prisms);
}

}  // namespace

FlipCounts orient_mesh(HybridMesh& mesh, const RunContext& context) {
  FlipCounts counts;
  const auto at = [&](CellKind kind) -> std::int64_t& { return counts.cells[static_cast<std::size_t>(kind)]; };
  at(CellKind::tetrahedron) = flip_cells(mesh, mesh.tetrahedra, context);
  at(CellKind::pyramid) = flip_cells(mesh, mesh.pyramids, context);
  at(CellKind::prism) = flip_cells(mesh, mesh.prisms, context);
  at(CellKind::hexahedron) = flip_cells(mesh, mesh.hexahedra, context);
  counts.inverted = n_inverted(mesh, counts);
  mesh.n_flipped_cells = counts.inverted;
  counts.faces = turn_faces(mesh, context);
  for (const CellKind kind : {CellKind::tetrahedron, CellKind::pyramid, CellKind::prism, CellKind::hexahedron})
    if (at(kind) > 0) context.info("cells with wrong orientation, flipped: " + std::to_string(at(kind)) + " of kind " + std::string(to_string(kind)));
  if (counts.faces > 0) context.info("boundary faces turned outwards: " + std::to_string(counts.faces));
  return counts;
}

}  // namespace sterna::io
