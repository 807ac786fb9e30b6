// The order of nodes and cells in files: solvers feel it, the mesh does not.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

enum class Numbering {
  lines,      ///< as meshes are made: wall-normal lines (columns of cells) first, then the rest
  bandwidth,  ///< neighbours near each other, whatever they belong to
  both,       ///< lines and columns consecutive, from the wall on, and these in one such order with the rest
};
/// \throws Error(bad_argument) for another name
Numbering numbering_of(std::string_view name);

/// Who is beside whom: the neighbours of i are neighbours[first[i]] .. neighbours[first[i + 1] - 1], ascending, each once, without i.
struct NeighbourGraph {
  std::vector<std::uint64_t> first = {0};
  std::vector<std::uint32_t> neighbours;
  std::size_t size() const { return first.size() - 1; }
};

/// Reverse Cuthill-McKee: the old number at each new place, so that neighbours are near each other. Each component begins at an end of it (George and Liu's
/// pseudo-peripheral vertex); ties by degree, then by number, so the same for any number of threads. Linear in the number of neighbours, some 0.2 s for a
/// million. Based on: E. Cuthill, J. McKee, Reducing the bandwidth of sparse symmetric matrices, ACM 1969; A. George, J. W. Liu, 1979.
std::vector<std::uint32_t> bandwidth_order(const NeighbourGraph& graph);

/// How far neighbours are from each other.
struct NumberingMeasure {
  std::uint64_t bandwidth = 0;  ///< largest difference of the numbers of neighbours
  double mean_profile = 0.0;    ///< mean, over all numbers, of the distance down to the lowest neighbour: what a row of a factor or a cache has to span
};
/// \param new_number of each vertex; empty: as it is
NumberingMeasure measure_numbering(const NeighbourGraph& graph, const std::vector<std::uint32_t>& new_number = {});

/// Nodes that share a cell, but inside of columns those of an edge.
NeighbourGraph node_graph(const HybridMesh& mesh, const RunContext& context);

/// The same mesh with other numbers. `both`: lines as wholes and the other nodes by bandwidth_order; columns, cells and boundary faces by their lowest node.
/// Of a mesh without columns, read from a file, the lines are those of the stacks of prisms on its walls, and prisms of a stack follow each other.
/// `bandwidth`: the same of all nodes, which leaves no columns. `lines`: as it is.
HybridMesh renumbered(const HybridMesh& mesh, Numbering numbering, const RunContext& context);

}  // namespace sterna
