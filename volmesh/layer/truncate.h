// Determines the number of layers of each growth line where the envelope is too low for all requested layers.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "volmesh/case/truncation.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Computes the number of layers of each growth line below the present envelope. Heights are unchanged. With fewer layers in the same height, each layer is
/// taller, and the height of the last one is closer to that of the tetrahedra above.
///
/// `automatic`: if the last cell of a growth line has less than half the height of a regular tetrahedron on it, the growth line loses as many layers as are
/// needed to reach this height, as long as its heights grow by no more than max_growth (eq. (1)). If the last cell remains below 0.12 of the height of the
/// tetrahedron, the growth line would be a thin step, and it gets no more layers than its neighbours. Neighbours of a growth line with fewer layers also lose
/// some layers, within max_growth and as long as their last cell has no more than 1.5 times the height of the tetrahedron. `always`: the number of layers gives
/// the growth of a growth line of full height. `never`: no layers are lost.
///
/// Remaining steps of more than one layer are levelled by raising the lower number. This costs no height, while a full layer beside a gap would have to be
/// lowered over as many edges as it has more layers. Walls with their own setting use that setting (LayerBase::truncation). Growth lines of opened ridges and
/// around them keep all layers. Collapsed growth lines nominally keep all layers, too.
class LayerNumbers {
 public:
  /// \post the numbers at both ends of an edge differ by at most one, unless a growth line is collapsed; vertices that grow alike have equal numbers; numbers
  /// are at least 1 and at most the requested number
  LayerNumbers(Borrowed<const LayerBase> base, const EnvelopeScale& scale, const Envelope& envelope, Truncation truncation, const RunContext& context);
  const std::vector<std::uint16_t>& layers() const { return layers_; }
  /// Raises the numbers to at least `least`, but at most to the requested number. \post the same as for the constructor
  void raise(const std::vector<std::uint16_t>& least);

 private:
  void close_downwards();
  void close_upwards();

  const LayerBase& base_;
  std::vector<std::uint16_t> layers_;
  std::vector<std::uint16_t> least_, thin_from_;  ///< smallest allowed number of each growth line, and number from which on no neighbour may have fewer
  std::vector<std::uint16_t> requested_;          ///< requested numbers; on wake sheets those of neighbours differ by one
  std::vector<std::uint8_t> is_fixed_;
};

}  // namespace sterna::volmesh
