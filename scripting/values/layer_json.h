// The outcome of the layer as JSON, which is the same for manifest and statistics.
#pragma once

#include "scripting/values/option_json.h"
#include "volmesh/volume_mesh.h"

namespace sterna::scripting {

/// Returns a JSON object: coverage in total and per patch, every collapsed vertex, the most compressed vertices, and warnings. Coverage has the shares of the
/// area at full height along the normal, at the height that the geometry permits, compressed and collapsed, and the lost area by reason.
Json layer_json(const volmesh::LayerReport& layer);
/// Returns a JSON object: number of sliver triangles of the wall, of edges flipped, of triangles before and after, and of remaining slivers.
Json slivers_json(const volmesh::SliverReport& slivers);
/// Returns a JSON object: tested properties, failures (none), and the worst elements with their locations.
Json certificate_json(const volmesh::EnvelopeCertificate& certificate);

}  // namespace sterna::scripting
