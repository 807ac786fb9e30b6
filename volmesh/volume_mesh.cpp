#include "volmesh/volume_mesh.h"

#include <utility>

#include "volmesh/stages.h"

namespace sterna::volmesh {

VolumeMeshResult volume_mesh(const TriMesh& wall, const VolumeMeshOptions& options, const RunContext& context) {
  return volume_mesh(wall, options, {}, context);
}

VolumeMeshResult volume_mesh(const TriMesh& wall, const VolumeMeshOptions& options, const StageWatch& watch, const RunContext& context) {
  MeshingSite site(wall, options, context);
  const auto make = [&] { return make_envelope(site, context); };
  EnvelopeStage envelope = watch.envelope ? watch.envelope(make) : make();
  if (watch.enveloped) watch.enveloped(envelope);
  LayerKnowledge knowledge;
  FilledStage filled = make_tetrahedra(site, std::move(envelope), knowledge, context);
  if (watch.filled) watch.filled(filled);
  return finish_mesh(std::move(filled), std::move(knowledge), options.improve, context);
}

}  // namespace sterna::volmesh
