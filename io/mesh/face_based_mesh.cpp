// Reconstructs cells from faces. The kind of a cell follows from the numbers of triangles and quads, its nodes from one face and the nodes opposite to it. Each
// reconstructed cell is compared with its faces, one by one.
#include "io/mesh/face_based_mesh.h"

#include <algorithm>
#include <array>
#include <span>

#include "geom/base/parallel.h"
#include "io/input/file_buffer.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_most_faces = 6;

/// A face as seen from the cell; the right-hand normal points out of the cell.
struct OutwardFace {
  std::array<std::uint32_t, 4> nodes{};
  std::size_t size = 0;
  std::span<const std::uint32_t> span() const { return {nodes.data(), size}; }
  bool has(std::uint32_t node) const { return std::find(nodes.begin(), nodes.begin() + size, node) != nodes.begin() + size; }
};

/// Returns true if both faces have the same nodes with the same orientation.
bool is_same_cycle(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  if (a.size() != b.size()) return false;
  const auto start = static_cast<std::size_t>(std::find(b.begin(), b.end(), a[0]) - b.begin());
  if (start == b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (a[k] != b[(start + k) % b.size()]) return false;
  return true;
}

/// A cell under construction. Node numbers are as in the file.
class CellBuilder {
 public:
  std::array<OutwardFace, k_most_faces> faces;
  std::size_t n_faces = 0;

  /// Reconstructs the cell. \returns the nodes in CGNS order; size 0 if the faces do not form a tetrahedron, pyramid, prism or hexahedron
  std::span<const std::uint32_t> build(CellKind& kind) {
    const auto n_quads = static_cast<std::size_t>(std::count_if(faces.begin(), faces.begin() + n_faces, [](const OutwardFace& f) { return f.size == 4; }));
    const std::size_t n_triangles = n_faces - n_quads;
    if (n_triangles == 4 && n_quads == 0) kind = CellKind::tetrahedron;
    else if (n_triangles == 4 && n_quads == 1) kind = CellKind::pyramid;
    else if (n_triangles == 2 && n_quads == 3) kind = CellKind::prism;
    else if (n_triangles == 0 && n_quads == 6) kind = CellKind::hexahedron;
    else return {};
    const bool has_apex = kind == CellKind::tetrahedron || kind == CellKind::pyramid;
    const bool stands_on_triangle = kind == CellKind::tetrahedron || kind == CellKind::prism;
    if (!build_over(lowest_face(stands_on_triangle ? 3 : 4), has_apex) || !agrees(kind)) return {};
    return {nodes_.data(), static_cast<std::size_t>(n_nodes(kind))};
  }

 private:
  /// Returns the face of that size with the lowest node, rotated so that this node is first.
  OutwardFace lowest_face(std::size_t size) {
    OutwardFace* found = nullptr;
    for (std::size_t f = 0; f < n_faces; ++f) {
      if (faces[f].size != size) continue;
      std::rotate(faces[f].nodes.begin(), std::min_element(faces[f].nodes.begin(), faces[f].nodes.begin() + size), faces[f].nodes.begin() + size);
      if (!found || faces[f].nodes < found->nodes) found = &faces[f];
    }
    return *found;
  }

  /// Builds the cell over a base. In the order of the cell's nodes, the base is the reversed outward face. Above it there is an apex, or one node over each
  /// base node.
  bool build_over(const OutwardFace& base, bool has_apex) {
    const std::size_t n = base.size;
    for (std::size_t k = 0; k < n; ++k) nodes_[k] = base.nodes[(n - k) % n];
    if (has_apex) {
      for (std::size_t f = 0; f < n_faces; ++f)
        for (const std::uint32_t node : faces[f].span())
          if (!base.has(node)) {
            nodes_[n] = node;
            return true;
          }
      return false;
    }
    for (std::size_t k = 0; k < n; ++k)
      if (!find_above(nodes_[k], base, nodes_[n + k])) return false;
    return true;
  }

  /// Finds the neighbour of `node` that is not in the base, in any face that contains both.
  bool find_above(std::uint32_t node, const OutwardFace& base, std::uint32_t& above) const {
    for (std::size_t f = 0; f < n_faces; ++f) {
      const std::span<const std::uint32_t> nodes = faces[f].span();
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (nodes[k] != node) continue;
        for (const std::size_t other : {(k + 1) % nodes.size(), (k + nodes.size() - 1) % nodes.size()}) {
          if (base.has(nodes[other])) continue;
          above = nodes[other];
          return true;
        }
      }
    }
    return false;
  }

  /// Returns true if each face of the cell is one of the given faces. Both have the same number of faces.
  bool agrees(CellKind kind) const {
    for (const LocalFace& local : cell_faces(kind)) {
      std::array<std::uint32_t, 4> nodes;
      for (std::size_t k = 0; k < local.size; ++k) nodes[k] = nodes_[local.nodes[k]];
      const std::span<const std::uint32_t> expected(nodes.data(), local.size);
      if (std::none_of(faces.begin(), faces.begin() + n_faces, [&](const OutwardFace& f) { return is_same_cycle(expected, f.span()); })) return false;
    }
    return true;
  }

  std::array<std::uint32_t, 8> nodes_{};
};

/// Faces of each cell, in ascending order. Bit 0 of an entry is set if the cell is the neighbour, so that the face points into it.
struct FacesOfCells {
  std::vector<std::uint64_t> first, entries;
};

FacesOfCells faces_of_cells(const FaceBasedMesh& faces) {
  FacesOfCells of;
  of.first.assign(faces.n_cells + 1, 0);
  const auto count = [&](std::uint32_t cell) { ++of.first[cell + 1]; };
  for (std::size_t f = 0; f < faces.n_faces(); ++f) {
    count(faces.owner[f]);
    if (faces.neighbour[f] != FaceBasedMesh::k_none) count(faces.neighbour[f]);
  }
  for (std::size_t c = 0; c < faces.n_cells; ++c) of.first[c + 1] += of.first[c];
  std::vector<std::uint64_t> next(of.first.begin(), of.first.end() - 1);
  of.entries.resize(of.first.back());
  for (std::size_t f = 0; f < faces.n_faces(); ++f) {
    of.entries[next[faces.owner[f]]++] = 2 * f;
    if (faces.neighbour[f] != FaceBasedMesh::k_none) of.entries[next[faces.neighbour[f]]++] = 2 * f + 1;
  }
  return of;
}

template <std::size_t N>
std::array<NodeId, N> ids(std::span<const std::uint32_t> nodes) {
  std::array<NodeId, N> result;
  for (std::size_t k = 0; k < N; ++k) result[k] = NodeId(nodes[k]);
  return result;
}

void add_cell(CellKind kind, std::span<const std::uint32_t> nodes, HybridMesh& mesh) {
  switch (kind) {
    case CellKind::tetrahedron: mesh.tetrahedra.push_back(ids<4>(nodes)); break;
    case CellKind::pyramid: mesh.pyramids.push_back(ids<5>(nodes)); break;
    case CellKind::prism: mesh.prisms.push_back(ids<6>(nodes)); break;
    case CellKind::hexahedron: mesh.hexahedra.push_back(ids<8>(nodes)); break;
  }
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void add_boundary(const FaceBasedMesh& faces, HybridMesh& mesh) {
  for (std::size_t f = 0; f < faces.n_faces(); ++f) {
    if (faces.neighbour[f] != FaceBasedMesh::k_none) continue;
    const std::span<const std::uint32_t> nodes(faces.nodes.data() + faces.first[f], faces.first[f + 1] - faces.first[f]);
    if (nodes.size() == 3) mesh.boundary_triangles.push_back({ids<3>(nodes), faces.patch[f]});
    else mesh.boundary_quads.push_back({ids<4>(nodes), faces.patch[f]});
  }
}

}  // namespace

void add_cells_and_boundary(const FaceBasedMesh& faces, HybridMesh& mesh, const std::string& source, const RunContext& context) {
  for (std::size_t f = 0; f < faces.n_faces(); ++f) {
    const std::uint64_t n = faces.first[f + 1] - faces.first[f];
    if (n != 3 && n != 4) throw_unsupported(source, "face " + std::to_string(f) + " has " + std::to_string(n) + " nodes", "faces of 3 and 4 nodes are read");
  }
  const FacesOfCells of = faces_of_cells(faces);
  constexpr std::size_t k_chunk = 4096;
  HybridMesh cells = parallel_reduce(
      context, faces.n_cells, HybridMesh{},
      [&](std::size_t begin, std::size_t end) {
        HybridMesh part;
        CellBuilder builder;
        for (std::size_t c = begin; c < end; ++c) {
          builder.n_faces = of.first[c + 1] - of.first[c];
          if (builder.n_faces < 4 || builder.n_faces > k_most_faces)
            throw_unsupported(source, "cell " + std::to_string(c) + " has " + std::to_string(builder.n_faces) + " faces",
                              "tetrahedra, pyramids, prisms and hexahedra are read");
          for (std::size_t k = 0; k < builder.n_faces; ++k) {
            const std::uint64_t entry = of.entries[of.first[c] + k], f = entry / 2;
            OutwardFace& face = builder.faces[k];
            face.size = faces.first[f + 1] - faces.first[f];
            std::copy_n(faces.nodes.begin() + static_cast<std::ptrdiff_t>(faces.first[f]), face.size, face.nodes.begin());
            if (entry % 2 == 1) std::reverse(face.nodes.begin(), face.nodes.begin() + static_cast<std::ptrdiff_t>(face.size));
          }
          CellKind kind{};
          const std::span<const std::uint32_t> nodes = builder.build(kind);
          if (nodes.empty())
            throw_malformed(source, "cell " + std::to_string(c),
                            "its " + std::to_string(builder.n_faces) +
                                " faces do not enclose a tetrahedron, pyramid, prism or hexahedron with normals from owner to neighbour");
          add_cell(kind, nodes, part);
        }
        return part;
      },
      [](HybridMesh all, HybridMesh part) {
        append(all.tetrahedra, part.tetrahedra);
        append(all.pyramids, part.pyramids);
        append(all.prisms, part.prisms);
        append(all.hexahedra, part.hexahedra);
        return all;
      },
      k_chunk);
  mesh.tetrahedra = std::move(cells.tetrahedra);
  mesh.pyramids = std::move(cells.pyramids);
  mesh.prisms = std::move(cells.prisms);
  mesh.hexahedra = std::move(cells.hexahedra);
  add_boundary(faces, mesh);
}

}  // namespace sterna::io
