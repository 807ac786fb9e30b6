// Edges of the envelope that may fold during the optimisation. There is a barrier on the angle between their two triangles, on the side of the fluid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "volmesh/envelope/edge_fold.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

class LayerFolds {
 public:
  using Corners = std::array<std::uint32_t, 4>;  ///< vertices, in the order of FoldPoints

  LayerFolds() = default;
  /// Collects edges at which the envelope may fold: at least one vertex of their two triangles moves, and the edge is concave with an angle below 120 degrees
  /// on the wall or on the envelope. Envelopes fold where they are concave at the start; invalid_macros() finds new folds.
  LayerFolds(const LayerBase& base, const Envelope& start, const std::vector<std::uint8_t>& is_moving, const RunContext& context);

  std::size_t size() const { return corners_.size(); }
  const Corners& corners(std::size_t fold) const { return corners_[fold]; }
  const FoldLimit& limit(std::size_t fold) const { return limits_[fold]; }
  /// Returns the folds that have the vertex as a corner.
  std::span<const std::uint32_t> at(std::size_t vertex) const {
    return first_.empty() ? std::span<const std::uint32_t>{} : std::span(list_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
  }
  /// Drops folds that are too sharp at the start because of rounding. Returns their corners, which must not move.
  std::vector<std::uint32_t> drop_infeasible(const LayerBase& base, const Envelope& start);

 private:
  void index(std::size_t n_vertices);
  std::vector<Corners> corners_;
  std::vector<FoldLimit> limits_;
  std::vector<std::uint32_t> first_, list_;
};

}  // namespace sterna::volmesh
