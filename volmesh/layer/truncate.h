// How many layers each line gets where the envelope is too low for all that were asked for.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/case/truncation.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Layers of each line under the envelope as it is, whose heights stay: with fewer layers in the same height each is taller, and the last one nearer to the
/// tetrahedra above.
///
/// `automatic`: a line whose last cell has less than half the height of a regular tetrahedron on it gives up as many layers as it takes to get there, as long
/// as its heights grow by no more than max_growth (eq. (1)). Where less than 0.12 of that height is reached, a line would be a thin step: it has no more layers
/// than its neighbours. Neighbours of a line with fewer layers give up some themselves, within max_growth and as long as their last cell has no more than 1.5
/// times that height. `always`: as many as it takes to grow as a line of its full height would. `never`: none.
///
/// What is left of larger steps than one is levelled by raising the lower number: that costs no height, while a full layer beside a gap would have to get low
/// over as many edges as it has more layers. Walls that ask for their own have it (LayerBase::truncation). Lines of opened ridges and around them keep all
/// layers, and so do collapsed ones (in name).
class LayerNumbers {
 public:
  /// `base` must outlive this.
  /// \post standing lines at a common edge differ by one at most; vertices that grow alike have as many; at least 1, at most what was asked for
  LayerNumbers(const LayerBase& base, const EnvelopeScale& scale, const Envelope& envelope, Truncation truncation, const RunContext& context);
  const std::vector<std::uint16_t>& layers() const { return layers_; }
  /// At least as many as these, at most what was asked for. \post as above
  void raise(const std::vector<std::uint16_t>& least);

 private:
  void close_downwards();
  void close_upwards();

  const LayerBase& base_;
  std::vector<std::uint16_t> layers_;
  std::vector<std::uint16_t> least_, thin_from_;  ///< what a line may have; from where on no neighbour may have fewer
  std::vector<std::uint16_t> asked_;              ///< on wake sheets those of neighbours differ by one
  std::vector<std::uint8_t> is_fixed_;
};

}  // namespace sterna::volmesh
