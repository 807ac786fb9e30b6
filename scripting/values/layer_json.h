// The outcome of the layer as JSON text: the same for manifest and statistics.
#pragma once

#include <string>

#include "volmesh/volume_mesh.h"

namespace sterna::scripting {

/// Returns an object: coverage in all and per patch (shares of area at full height along the normal, and where the geometry permits it, compressed, collapsed;
/// lost area by reason), every collapsed vertex, the most compressed ones, warnings.
std::string layer_json(const volmesh::LayerReport& layer);
/// Returns an object: sliver triangles of the wall, edges flipped, triangles before and after, remaining slivers.
std::string needles_json(const volmesh::NeedleReport& needles);
/// Returns an object: tested properties, failures (none), the worst elements with location.
std::string certificate_json(const volmesh::EnvelopeCertificate& certificate);

}  // namespace sterna::scripting
