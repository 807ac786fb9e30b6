// Number of layers of each growth line where the envelope is too low for all requested layers.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/case/truncation.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Computes the number of layers of each growth line under the present envelope. Heights stay: with fewer layers in the same height each layer is taller, and
/// the height of the last one is closer to that of the tetrahedra above.
///
/// `automatic`: a growth line whose last cell has less than half the height of a regular tetrahedron on it gives up as many layers as are needed to reach
/// this height, as long as its heights grow by no more than max_growth (eq. (1)). If it reaches less than 0.12 of that height, the growth line would be a
/// thin step: it gets no more layers than its neighbours. Neighbours of a growth line with fewer layers give up some layers themselves, within max_growth and
/// as long as their last cell has no more than 1.5 times that height. `always`: as many layers as give the growth of a growth line of full height. `never`:
/// none.
///
/// Remaining steps larger than one are levelled by raising the lower number: this costs no height, while a full layer beside a gap would have to be lowered
/// over as many edges as it has more layers. Walls with their own setting use it (LayerBase::truncation). Growth lines of opened ridges and around them keep
/// all layers, and so do collapsed ones (nominally).
class LayerNumbers {
 public:
  /// `base` must outlive this.
  /// \post standing growth lines at a common edge differ by one at most; vertices that grow alike have equal numbers; at least 1, at most the requested
  /// number
  LayerNumbers(const LayerBase& base, const EnvelopeScale& scale, const Envelope& envelope, Truncation truncation, const RunContext& context);
  const std::vector<std::uint16_t>& layers() const { return layers_; }
  /// Raises the numbers to at least `least`, at most the requested number. \post as above
  void raise(const std::vector<std::uint16_t>& least);

 private:
  void close_downwards();
  void close_upwards();

  const LayerBase& base_;
  std::vector<std::uint16_t> layers_;
  std::vector<std::uint16_t> least_, thin_from_;  ///< smallest allowed number of a growth line; number from which on no neighbour may have fewer
  std::vector<std::uint16_t> asked_;              ///< on wake sheets the numbers of neighbours differ by one
  std::vector<std::uint8_t> is_fixed_;
};

}  // namespace sterna::volmesh
