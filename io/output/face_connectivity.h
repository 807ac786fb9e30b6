// Face-to-cell connectivity for the formats that store faces with their two cells (OpenFOAM, Fluent).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/numbering.h"
#include "io/output/layer_numbers.h"

namespace sterna::io {

/// A face by value. The right-hand normal points out of the cell for which the face was requested.
struct CellFace {
  std::array<NodeId, 4> nodes{};
  std::uint32_t size = 0;       ///< 0: no face (both growth lines of a side have ended)
  std::uint32_t neighbour = 0;  ///< cell on the other side, or MeshFaces::k_boundary
  std::span<const NodeId> span() const { return {nodes.data(), size}; }
};

/// Faces of a mesh. Cells are numbered as in for_each_cell(): column by column, layer by layer, then prisms, pyramids, hexahedra, tetrahedra. order_cells()
/// changes these numbers. Inside the columns neighbours follow from the numbering; only the other faces are matched through a table: 12 bytes per face and 4
/// per node (0.7 GB for 25 M nodes, 45 M prisms, 17 M tetrahedra). Based on: counting sort of faces by their lowest node.
class MeshFaces {
 public:
  static constexpr std::uint32_t k_boundary = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::size_t k_most_faces = 6;

  /// Matches the faces. Parallel, same result for any number of threads.
  /// \throws Error mesh_invalid for a face of only one cell that is not a boundary face, a face of three cells, a boundary face without a cell, or a node that
  /// does not exist; overflow for more than 2^32 - 2 cells or unmatched faces; cancelled
  MeshFaces(Borrowed<const HybridMesh> mesh, const RunContext& context);

  std::uint64_t n_cells() const { return n_column_cells_ + n_explicit_; }
  std::uint64_t n_column_cells() const { return n_column_cells_; }  ///< the first cells of for_each_cell()

  /// Renumbers the cells. `both`: columns as units (from the wall outwards) and the explicit cells are ordered by bandwidth_order; `bandwidth`: all cells are
  /// ordered by it; `lines`: the numbers are unchanged. Stores two more numbers per cell.
  void order_cells(Numbering numbering, const RunContext& context);
  /// Returns the number of a cell, given by its number in for_each_cell().
  std::uint32_t number_of(std::uint64_t cell) const { return new_of_old_.empty() ? static_cast<std::uint32_t>(cell) : new_of_old_[cell]; }
  /// Returns the graph of cells that share a face.
  NeighbourGraph cell_graph(const RunContext& context) const;
  CellKind kind(std::uint64_t cell) const;
  /// Computes the faces of a cell. \returns their number; some faces may have size 0
  std::size_t faces_of(std::uint64_t cell, std::array<CellFace, k_most_faces>& faces) const;
  /// Returns the cell of a boundary face.
  std::uint32_t cell_of_triangle(std::size_t i) const { return number_of(partner_[first_boundary_ + i]); }
  std::uint32_t cell_of_quad(std::size_t i) const { return number_of(partner_[first_boundary_ + mesh_->boundary_triangles.size() + i]); }

  std::uint64_t n_internal() const { return internal_before_.back().faces; }
  std::uint64_t n_internal_nodes() const { return internal_before_.back().nodes; }

  struct Count {
    std::uint64_t faces = 0;
    std::uint64_t nodes = 0;  ///< number of nodes of these faces
  };
  /// Counts the internal faces whose lower cell is below `cell`.
  Count internal_before(std::uint64_t cell) const;

  /// Calls f(cell, face) for the internal faces whose lower cell is in [begin, end), oriented as seen from that cell. The faces are ordered by lower cell, then
  /// by the other cell ("upper triangular").
  template <class F>
  void for_each_internal(std::uint64_t begin, std::uint64_t end, const F& f) const {
    std::array<CellFace, k_most_faces> faces;
    for (std::uint64_t cell = begin; cell < end; ++cell) {
      const std::size_t n = faces_of(cell, faces);
      const auto last = std::remove_if(faces.begin(), faces.begin() + n,
                                       [&](const CellFace& face) { return face.size == 0 || face.neighbour == k_boundary || face.neighbour <= cell; });
      std::sort(faces.begin(), last,
                [](const CellFace& a, const CellFace& b) { return a.neighbour != b.neighbour ? a.neighbour < b.neighbour : a.nodes < b.nodes; });
      for (auto face = faces.begin(); face != last; ++face) f(cell, *face);
    }
  }

 private:
  /// A face that is not between two cells of columns: a face of an explicit cell, the bottom, top or open side of a column, or a boundary face.
  using Slot = std::uint64_t;
  struct ExplicitBlock {
    CellKind kind;
    std::uint64_t first_cell, n_cells;
    Slot first_slot;
  };

  std::uint64_t old_of(std::uint64_t cell) const { return old_of_new_.empty() ? cell : old_of_new_[cell]; }
  /// Computes the faces of a cell in the numbering of for_each_cell().
  std::size_t given_faces_of(std::uint64_t cell, std::array<CellFace, k_most_faces>& faces) const;
  /// Returns the unit for ordering: a cell, or a whole column.
  std::uint64_t unit_of(std::uint64_t cell, bool is_by_column) const;
  NeighbourGraph unit_graph(bool is_by_column, const RunContext& context) const;
  CellFace side(std::size_t column, std::size_t k, int layer) const;
  CellFace cap(std::size_t column, int level, bool is_top) const;
  std::size_t column_of(std::uint64_t live) const { return live_.empty() ? live : live_[live]; }
  const ExplicitBlock& block_of(std::uint64_t cell) const;
  std::span<const NodeId> explicit_nodes(CellKind kind, std::uint64_t i) const;
  CellFace explicit_face(CellKind kind, std::uint64_t i, std::size_t k) const;
  /// Returns the nodes of a loose face; `neighbour` is the cell to which the face belongs (k_boundary: a boundary face).
  CellFace loose_face(Slot slot) const;
  void number_cells();
  void pair_sides();
  void match_loose_faces(const RunContext& context);
  void require_all_matched() const;
  void count_internal(const RunContext& context);

  const HybridMesh* mesh_;
  std::uint64_t n_live_ = 0;         ///< number of columns with cells ("live" columns)
  std::vector<std::uint32_t> live_;  ///< numbers of the live columns; empty if all columns are live
  LayerNumbers cells_;               ///< cells of live columns
  std::uint64_t n_column_cells_ = 0;
  std::uint64_t n_explicit_ = 0;
  std::array<ExplicitBlock, 4> blocks_{};
  std::vector<std::uint32_t> beside_;      ///< per live column and side: the live column beside it, n_live_ + number of an open side, or k_boundary for no face
  std::vector<std::uint64_t> open_sides_;  ///< 3 * live column + side
  LayerNumbers open_faces_;                ///< faces of open sides
  Slot first_open_ = 0, first_boundary_ = 0, n_slots_ = 0;
  std::vector<std::uint32_t> partner_;                  ///< per slot
  std::vector<Count> internal_before_;                  ///< per k_count_interval cells
  std::vector<std::uint32_t> old_of_new_, new_of_old_;  ///< from order_cells(); empty: unchanged numbering
};

}  // namespace sterna::io
