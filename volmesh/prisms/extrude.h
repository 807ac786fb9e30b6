// Extrusion of the layer: nodes on curved lines between wall and envelope, and the repair of invalid prisms (method.md §8, [ET15 §3.4]).
#pragma once

#include <vector>

#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/prisms/options.h"

namespace sterna::volmesh {

struct Extrusion {
  LayerBlock layers;           ///< line k stands on wall vertex k; base triangle = wall triangle
  std::vector<Point> points;   ///< nodes of all lines, line by line from the wall up
  std::int64_t n_straightened = 0;  ///< lines whose curvature was reduced
};

/// Nodes by eqs. (10)-(12) with the normalised s(t). Invalid cells (exact tests of the cell and of its dual sub-volumes) are repaired: c_t to zero at their lines and reduced around them; where this
/// does not help, heights are made equal over the cell's corners and then lowered (through `unwarp`), down to collapse. Changes `envelope` accordingly.
/// \post every cell of the layer is valid with positive dual sub-volumes; top nodes are envelope.point() to the bit.
Extrusion extrude_prisms(const LayerBase& base, const EnvelopeOptions& envelope_options, const PrismOptions& options, Envelope& envelope,
                         const RunContext& context);

}  // namespace sterna::volmesh
