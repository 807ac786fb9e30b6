// Node positions on one growth line of the layer (docs/method/prisms.md, "Line nodes"; [ET15 eqs. (10)-(12)]).
#pragma once

#include <vector>

#include "geom/base/borrowed.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::volmesh {

/// Nodes p_0 .. p_n of a growth line: p_j = p + t_j (s_j h_n n + (1 - s_j)(e - p)) with envelope point e, wall normal n, h_n = normal_height, and t_j from eq.
/// (11) for h_n. The first node is then at the distance h0 from the wall along its normal. Eq. (10) has h instead of h_n. With h_n the distance of every node
/// along n is t_j h_n, and curving moves nodes only along the wall. s_j = s(t_j) of eq. (12), normalised: 1 at the wall, 0 at the top. Growth lines of
/// multi-normal fans are straight.
class LinePlacer {
 public:
  LinePlacer(Borrowed<const LayerBase> base, const EnvelopeScale& scale);
  /// Writes n + 1 nodes, or only the wall point if the vertex is collapsed. Nodes satisfy the vertex's constraint; the last node equals envelope.point()
  /// bit-exactly.
  void place(const Envelope& envelope, VertexId v, int n, double c_t, Point* nodes);
  /// Places the nodes of all layers, whose number is scale.n(v).
  void place(const Envelope& envelope, VertexId v, double c_t, Point* nodes) { place(envelope, v, scale_.n(v), c_t, nodes); }

 private:
  double least_curving(VertexId v, double aside, double height) const;

  const LayerBase& base_;
  EnvelopeScale scale_;
  std::vector<double> t_;
};

}  // namespace sterna::volmesh
