// Order of nodes and cells in files. It affects the speed of solvers, not the mesh.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

enum class Numbering {
  lines,      ///< as generated: wall-normal growth lines (columns of cells) first, then the rest
  bandwidth,  ///< neighbours get close numbers, whether or not they belong to one line
  both,       ///< lines and columns keep consecutive numbers, from the wall up; as units they are in one bandwidth order with the other nodes
};
/// \throws Error(bad_argument) for another name
Numbering numbering_of(std::string_view name);

/// Adjacency of vertices: the neighbours of i are neighbours[first[i]] .. neighbours[first[i + 1] - 1], ascending, each once, without i.
struct NeighbourGraph {
  std::vector<std::uint64_t> first = {0};
  std::vector<std::uint32_t> neighbours;
  std::size_t size() const { return first.size() - 1; }
};

/// Returns the reverse Cuthill-McKee order: the old number at each new position, so that neighbours get close numbers. Each component begins at a peripheral
/// vertex (George and Liu's pseudo-peripheral vertex); ties by degree, then by number, so the result is the same for any number of threads. Linear in the
/// number of neighbours, some 0.2 s for a million. Based on: E. Cuthill, J. McKee, Reducing the bandwidth of sparse symmetric matrices, ACM 1969; A. George,
/// J. W. Liu, 1979.
std::vector<std::uint32_t> bandwidth_order(const NeighbourGraph& graph);

/// Distances between the numbers of neighbours.
struct NumberingMeasure {
  std::uint64_t bandwidth = 0;  ///< largest difference between the numbers of neighbours
  double mean_profile = 0.0;    ///< mean over all vertices of the difference between a vertex's number and its lowest neighbour's: the width of a matrix row,
                                ///< or of memory accesses
};
/// Measures a numbering. \param new_number of each vertex; empty: current numbers
NumberingMeasure measure_numbering(const NeighbourGraph& graph, const std::vector<std::uint32_t>& new_number = {});

/// Returns the graph of nodes that share a cell; inside columns only nodes of a common edge.
NeighbourGraph node_graph(const HybridMesh& mesh, const RunContext& context);

/// Returns the same mesh with other numbers.
/// `both`: growth lines as units and the other nodes are in the order of bandwidth_order(); columns, cells and boundary faces are sorted by their lowest node.
/// In a mesh without columns, read from a file, the lines are those of the stacks of prisms on its walls, and prisms of a stack are consecutive.
/// `bandwidth`: all nodes are in the order of bandwidth_order(); the result has no columns. `lines`: the mesh is unchanged.
HybridMesh renumbered(const HybridMesh& mesh, Numbering numbering, const RunContext& context);

}  // namespace sterna
