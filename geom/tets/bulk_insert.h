// Many points into a mesh of tetrahedra at once, in blocks of the curve that work beside each other: same mesh for any number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/tets/blocks.h"
#include "geom/tets/curve.h"
#include "geom/tets/insert.h"
#include "geom/tets/tet_mesh.h"

namespace sterna::tets {

/// A point that is to be inserted.
struct Seed {
  Vec3 position;
  std::uint32_t start = 0;  ///< a tetrahedron near to it
  Room room;
};

/// Inserts into one mesh, time after time. While it lives nobody else adds or removes tetrahedra. 34 bytes for each tetrahedron with the mesh's own.
class BulkInserter {
 public:
  /// \post the mesh is the same but for the order of corners within tetrahedra
  /// \p n_corners: the first points, those of the boundary, for Room::to_corners
  /// \p most_effort: as InsertTarget
  explicit BulkInserter(TetMesh& mesh, const RunContext& context, std::uint32_t n_corners = 0, std::size_t most_effort = k_largest_cavity);

  /// Seeds are taken along the curve. A pass in blocks, a fixed number whatever the threads; what another block bars waits for a pass with other blocks, the
  /// rest is inserted one by one. \return what became of each; never foreign
  /// \post mesh.points has one more for each seed, in no order; those that were not inserted are used by no tetrahedron
  std::vector<Insertion> insert(std::span<const Seed> seeds, const RunContext& context);
  /// The same in the order given. \pre neighbours in it are near to each other
  std::vector<Insertion> insert_in_order(std::span<const Seed> seeds, const RunContext& context);

  /// For seeds of which nothing is known: each begins at a tetrahedron that is near to it on the curve.
  void find_starts(std::span<Seed> seeds, const RunContext& context) const;
  /// Indices of seeds along the curve.
  std::vector<std::uint32_t> order_along_curve(std::span<const Seed> seeds, const RunContext& context) const;

  /// Room for so many tetrahedra.
  void reserve(std::size_t n);
  /// A mark of each place for the caller's use, 0 for each new tetrahedron. Places without tetrahedron may have any.
  std::vector<std::uint8_t>& state() { return state_; }
  const std::vector<std::uint8_t>& state() const { return state_; }
  /// Of each chunk of k_chunk places whether there may be new tetrahedra, for the caller to take back. All at first.
  std::vector<std::uint8_t>& is_changed() { return is_changed_; }
  std::int64_t n_serial() const { return n_serial_; }  ///< seeds that no block could take; for reports

 private:
  std::vector<Insertion> insert(std::span<const Seed> seeds, std::vector<std::uint32_t> order, const RunContext& context);
  std::vector<std::uint32_t> run_pass(std::span<const Seed> seeds, std::span<const std::uint32_t> order, const Blocks& blocks, std::uint32_t first_point,
                                      std::vector<Insertion>& results, const RunContext& context);
  std::uint32_t first_alive() const;
  void make_room(std::size_t n_places);
  std::vector<std::vector<std::uint32_t>> dealt_out(const Blocks& blocks, const RunContext& context);
  bool is_in(std::uint32_t t, const Block& block) const { return block.holds(mesh_.points[mesh_.nodes[t][3]]); }

  TetMesh& mesh_;
  std::uint32_t n_corners_;
  std::size_t most_effort_;
  Curve curve_;
  std::vector<std::uint8_t> mark_, state_, is_changed_;
  std::vector<std::uint32_t> free_;
  std::int64_t n_serial_ = 0;
};

}  // namespace sterna::tets
