// The outcome of the layer as JSON, which is the same for manifest and statistics.
#pragma once

#include "scripting/values/option_json.h"
#include "volmesh/volume_mesh.h"

namespace sterna::scripting {

/// Returns a JSON object: coverage in total and per patch, every collapsed vertex, the most compressed vertices, and warnings. Coverage has the shares of the
/// area at full height along the normal, at the height that the geometry permits, compressed and collapsed, and the lost area by reason.
Json layer_json(const volmesh::LayerReport& layer);
/// Calls entry(name, member) for each entry of slivers_json(). The same list writes and reads.
template <class AnyReport, class F>
void sliver_entries(AnyReport& report, const F& entry) {
  entry("given_triangles", report.n_given);
  entry("triangles", report.n_triangles);
  entry("needles", report.n_slivers);
  entry("flipped_edges", report.n_flips);
  entry("left", report.n_left);
  entry("over_budget", report.is_over_budget);
  entry("first_left", report.first_left);
}
/// Returns a JSON object: number of sliver triangles of the wall, of edges flipped, of triangles before and after, and of remaining slivers.
Json slivers_json(const volmesh::SliverReport& slivers);
/// Returns a JSON object: tested properties, failures (none), and the worst elements with their locations.
Json certificate_json(const volmesh::EnvelopeCertificate& certificate);

}  // namespace sterna::scripting
