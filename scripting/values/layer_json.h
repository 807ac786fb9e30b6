// What became of the layer, as JSON text: the same for manifest and statistics.
#pragma once

#include <string>

#include "volmesh/volume_mesh.h"

namespace sterna::scripting {

/// Object: coverage in all and per patch (shares of area at full height along the normal, and where the geometry permits it, compressed, collapsed; lost area
/// by reason), every collapsed vertex, the most compressed ones, warnings.
std::string layer_json(const volmesh::LayerReport& layer);
/// Object: needles of the wall, edges flipped, triangles before and behind, what is left.
std::string needles_json(const volmesh::NeedleReport& needles);
/// Object: what was tested, what failed (nothing), the worst elements with place.
std::string certificate_json(const volmesh::EnvelopeCertificate& certificate);

}  // namespace sterna::scripting
