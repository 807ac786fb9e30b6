// Inserts many points into a tetrahedral mesh at once, in parallel in blocks along the curve. The mesh is the same for any number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/tets/blocks.h"
#include "geom/tets/hilbert_curve.h"
#include "geom/tets/insert.h"
#include "geom/tets/tet_mesh.h"

namespace sterna::tets {

/// A point that is to be inserted.
struct Seed {
  Vec3 position;
  std::uint32_t start = 0;  ///< a tetrahedron near the point
  Room room;
};

/// Inserts into one mesh repeatedly. During its lifetime no other code may add or remove tetrahedra. 34 bytes per tetrahedron in addition to the mesh.
class BulkInserter {
 public:
  /// \post the mesh is unchanged except for the order of corners within tetrahedra
  /// \p n_corners: number of boundary points, which come first; Room::to_corners applies to them
  /// \p most_effort: as InsertTarget
  explicit BulkInserter(TetMesh& mesh, const RunContext& context, std::uint32_t n_corners = 0, std::size_t most_effort = k_largest_cavity);

  /// Inserts the seeds in the order along the curve. Runs a fixed number of passes in blocks, independent of the number of threads. Seeds blocked by another
  /// block's tetrahedra are deferred to a pass with other blocks; the rest is inserted one by one. \return the result for each seed; never foreign
  /// \post mesh.points has one more point for each seed, in no particular order; points that were not inserted are not used by any tetrahedron
  std::vector<Insertion> insert(std::span<const Seed> seeds, const RunContext& context);
  /// Inserts the seeds in the given order. \pre consecutive seeds are close together
  std::vector<Insertion> insert_in_order(std::span<const Seed> seeds, const RunContext& context);

  /// Sets start tetrahedra for seeds without one: a tetrahedron that is near on the curve.
  void find_starts(std::span<Seed> seeds, const RunContext& context) const;
  /// Returns the indices of seeds along the curve.
  std::vector<std::uint32_t> order_along_curve(std::span<const Seed> seeds, const RunContext& context) const;

  /// Reserves memory for n tetrahedra.
  void reserve(std::size_t n);
  /// Marks of each slot for the caller's use, 0 for each new tetrahedron. Slots without tetrahedron may have any value.
  std::vector<std::uint8_t>& state() { return state_; }
  const std::vector<std::uint8_t>& state() const { return state_; }
  /// One flag for each chunk of k_chunk slots: true if the chunk may contain new tetrahedra. All flags are true at first; the caller resets them.
  std::vector<std::uint8_t>& is_changed() { return is_changed_; }
  std::int64_t n_serial() const { return n_serial_; }  ///< seeds that no block could insert; for reports

 private:
  std::vector<Insertion> insert(std::span<const Seed> seeds, std::vector<std::uint32_t> order, const RunContext& context);
  std::vector<std::uint32_t> run_pass(std::span<const Seed> seeds, std::span<const std::uint32_t> order, const Blocks& blocks, std::uint32_t first_point,
                                      std::vector<Insertion>& results, const RunContext& context);
  std::uint32_t first_alive() const;
  void make_room(std::size_t n_locations);
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
