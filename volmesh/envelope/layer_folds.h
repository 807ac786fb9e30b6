// Edges of the envelope that may fold, in the optimiser: a barrier on the angle between their two triangles on the side of the fluid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "volmesh/envelope/edge_fold.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

class LayerFolds {
 public:
  using Corners = std::array<std::uint32_t, 4>;  ///< vertices, as FoldPoints

  LayerFolds() = default;
  /// Collects edges with a moving vertex at their triangles that are concave on the wall or the envelope, with an angle below 120 degrees on one of them.
  /// Envelopes fold where they are concave at the start; new folds are found by invalid_macros().
  LayerFolds(const LayerBase& base, const Envelope& start, const std::vector<std::uint8_t>& is_moving, const RunContext& context);

  std::size_t size() const { return corners_.size(); }
  const Corners& corners(std::size_t fold) const { return corners_[fold]; }
  const FoldLimit& limit(std::size_t fold) const { return limits_[fold]; }
  /// Returns the folds of which the vertex is a corner.
  std::span<const std::uint32_t> at(std::size_t vertex) const {
    return first_.empty() ? std::span<const std::uint32_t>{} : std::span(list_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
  }
  /// Drops folds that are too sharp at the start (by rounding); returns their corners, which must not move.
  std::vector<std::uint32_t> drop_infeasible(const LayerBase& base, const Envelope& start);

 private:
  void index(std::size_t n_vertices);
  std::vector<Corners> corners_;
  std::vector<FoldLimit> limits_;
  std::vector<std::uint32_t> first_, list_;
};

}  // namespace sterna::volmesh
