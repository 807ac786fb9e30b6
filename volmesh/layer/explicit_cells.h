// Cells of a layer that do not belong to columns. They lie around opened ridges and on wake sheets.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "geom/base/error.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna::volmesh {

/// Adds cells to a mesh and stores the growth lines of each cell.
class ExplicitCells {
 public:
  using Line = std::uint32_t;
  explicit ExplicitCells(HybridMesh& mesh) : mesh_(mesh) {}

  template <std::size_t N>
  void add_prism(const std::array<NodeId, 6>& nodes, const std::array<Line, N>& lines) {
    mesh_.prisms.push_back(nodes);
    prism_lines_.push_back(lines_of(lines));
  }
  template <std::size_t N>
  void add_pyramid(const std::array<NodeId, 5>& nodes, const std::array<Line, N>& lines) {
    mesh_.pyramids.push_back(nodes);
    pyramid_lines_.push_back(lines_of(lines));
  }
  template <std::size_t N>
  void add_tet(const std::array<NodeId, 4>& nodes, const std::array<Line, N>& lines) {
    mesh_.tetrahedra.push_back(nodes);
    tet_lines_.push_back(lines_of(lines));
  }
  template <std::size_t N>
  void add_hexahedron(const std::array<NodeId, 8>& nodes, const std::array<Line, N>& lines) {
    mesh_.hexahedra.push_back(nodes);
    hex_lines_.push_back(lines_of(lines));
  }
  /// Adds the cell of a triangle of growth lines in one layer. It is a prism, or the degenerate cell that remains if growth lines have the same node below and
  /// above (LayerBlock::cell).
  void add_cell(const std::array<NodeId, 3>& low, const std::array<NodeId, 3>& high, const std::array<Line, 3>& lines);

  /// Finds cells that are not valid by the exact test of their kind, or have a dual sub-volume that is not positive. Calls on_invalid(line) for every growth
  /// line of each such cell. Returns the locations of these cells. \pre all cells of the mesh outside its columns were added here
  ErrorInfo find_invalid(const std::function<void(Line)>& on_invalid) const;

 private:
  using Lines = std::array<Line, 4>;
  template <std::size_t N>
  static Lines lines_of(const std::array<Line, N>& lines) {
    return {lines[0], lines[1], lines[2], lines[N - 1]};
  }

  HybridMesh& mesh_;
  std::vector<Lines> prism_lines_, pyramid_lines_, hex_lines_, tet_lines_;
};

}  // namespace sterna::volmesh
