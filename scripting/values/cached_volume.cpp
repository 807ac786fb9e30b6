#include "scripting/values/cached_volume.h"

#include <string>

#include "geom/base/error.h"
#include "scripting/values/start_from_reference.h"
#include "scripting/values/stored_types.h"
#include "scripting/values/summary.h"
#include "scripting/values/value_keys.h"
#include "volmesh/tetra/engine_process.h"

namespace sterna::scripting {
namespace {

/// Adds the engines to a key, because their programs are built separately from this one.
void add_engines(KeyMaker& maker, const volmesh::TetraOptions& options) {
  for (const char* name : {"sterna-tet-tetgen", "sterna-tet-hxt"}) {
    try {
      maker.add(hash_file(volmesh::find_helper(name, options.helper_folder)));
    } catch (const Error& error) {
      if (error.code() != ErrorCode::tetra_engine_missing) throw;
      maker.add("none");  // without this engine the other one may be used
    }
  }
}

/// Returns false if a time or memory limit affected the result. Another run may then produce another mesh, so the result must not be shared.
bool is_same_everywhere(const volmesh::FilledStage& filled) { return filled.tets.is_reproducible; }
bool is_same_mesh_everywhere(const volmesh::VolumeMeshResult& result) { return result.is_reproducible; }

ContentKey envelope_key(const TriMesh& wall, const volmesh::MeshCase& options, const RunContext& context) {
  return KeyMaker("make_envelope").add(key_of(wall)).add(envelope_options_key(options)).add(context.seed()).key();
}

std::string triangles_text(const TriMesh& wall) { return "of " + count_text(static_cast<std::int64_t>(wall.n_triangles())) + " triangles"; }

ContentKey part_envelope_key(const volmesh::PartEnvelopeTask& task, const RunContext& context) {
  volmesh::EnvelopeOptions named = task.options;
  return KeyMaker("envelope of a part").add(task.wall).add(sterna::options_of(named)).add(task.rules).add(task.smooth_angle).add(context.seed()).key();
}

/// Returns makers that know the true surface of the wall. Their envelopes come from the cache if present, or start from a reference if there is one.
volmesh::Makers makers_of(const SurfaceValue& wall, const volmesh::MeshCase& options, const Reuse& reuse) {
  volmesh::Makers makers;
  if (wall.true_surface.wall)
    makers.true_surface = [model_wall = wall.true_surface.wall](const Point& p, TriangleId triangle, const std::array<double, 3>& weights) {
      return model_wall->nearest(p, triangle, weights);
    };
  const volmesh::PartEnvelopeMaker ordinary = [reuse](const volmesh::PartEnvelopeTask& task, const RunContext& context) {
    const std::optional<ContentKey> key = reuse.cache ? std::optional(part_envelope_key(task, context)) : std::nullopt;
    return cached<volmesh::PartEnvelope>(reuse, "envelope", triangles_text(task.wall) + " in their own frame", key, context,
                                         [&] { return volmesh::part_envelope(task, context); });
  };
  if (reuse.reference) return starting_envelopes(std::move(makers), reuse, ordinary, part_envelope_key);
  if (reuse.cache && !options.parts.empty()) makers.part_envelope = ordinary;
  return makers;
}

/// Returns a key for the true surface of a wall; nothing if the inputs of that surface are unknown.
std::optional<ContentKey> true_surface_key(const SurfaceValue& wall) { return wall.true_surface.wall ? wall.true_surface.key : ContentKey{}; }

}  // namespace

volmesh::EnvelopeStage cached_envelope(const SurfaceValue& wall, const volmesh::MeshCase& options, const Reuse& reuse, const RunContext& context) {
  const std::optional<ContentKey> key = reuse.cache ? std::optional(envelope_key(wall.mesh, options, context)) : std::nullopt;
  return cached_with_reference<volmesh::EnvelopeStage>(reuse, "envelope", triangles_text(wall.mesh), key, context, [&] {
    volmesh::EnvelopeStage stage = volmesh::make_envelope(wall.mesh, options, makers_of(wall, options, reuse), context);
    report_other_envelopes(options.parts, reuse, context);
    return stage;
  });
}

volmesh::FilledStage cached_tetrahedra(const SurfaceValue& wall, const volmesh::EnvelopeStage& envelope, const volmesh::MeshCase& options, const Reuse& reuse,
                                       const RunContext& context) {
  const std::optional<ContentKey> true_surface = true_surface_key(wall);
  std::optional<ContentKey> key;
  if (reuse.cache && true_surface) {
    volmesh::MeshCase of_this_step = options;
    of_this_step.improve = {};
    KeyMaker maker("tetrahedra");
    maker.add(key_of(wall.mesh)).add(key_of(envelope)).add(volume_options_key(of_this_step)).add(*true_surface).add(context.seed());
    add_engines(maker, options.tetrahedra);
    key = maker.key();
  }
  return cached<volmesh::FilledStage>(
      reuse, "tetrahedra", triangles_text(wall.mesh), key, context,
      [&] { return volmesh::make_tetrahedra(wall.mesh, envelope, options, makers_of(wall, options, {}), context); }, is_same_everywhere);
}

volmesh::VolumeMeshResult cached_finish(const SurfaceValue& wall, const volmesh::FilledStage& filled, const volmesh::MeshCase& options, const Reuse& reuse,
                                        const RunContext& context) {
  std::optional<ContentKey> key;
  if (reuse.cache) key = KeyMaker("prisms").add(key_of(wall.mesh)).add(key_of(filled)).add(volume_options_key(options)).add(context.seed()).key();
  auto result = cached<volmesh::VolumeMeshResult>(
      reuse, "prisms", triangles_text(wall.mesh), key, context, [&] { return volmesh::finish_mesh(wall.mesh, filled, options, context); },
      is_same_mesh_everywhere);
  result.tetra_engine_seconds = filled.tets.engine_seconds;  // does not depend on the run that joined the parts
  result.tetra_engine_peak_bytes = filled.tets.engine_peak_bytes;
  return result;
}

volmesh::VolumeMeshResult cached_volume_mesh(const SurfaceValue& wall, const volmesh::MeshCase& options, const volmesh::StageWatch& watch, const Reuse& reuse,
                                             const RunContext& context) {
  if (!reuse.cache && !reuse.reference) return volmesh::watched_volume_mesh(wall.mesh, options, makers_of(wall, options, reuse), watch, context);
  volmesh::StageWatch with_envelope = watch;
  with_envelope.envelope = [&](const std::function<volmesh::EnvelopeStage()>& make) {
    const std::optional<ContentKey> key = reuse.cache ? std::optional(envelope_key(wall.mesh, options, context)) : std::nullopt;
    return cached_with_reference<volmesh::EnvelopeStage>(reuse, "envelope", triangles_text(wall.mesh), key, context, [&] {
      volmesh::EnvelopeStage stage = make();
      report_other_envelopes(options.parts, reuse, context);
      return stage;
    });
  };
  const auto make = [&] { return volmesh::watched_volume_mesh(wall.mesh, options, makers_of(wall, options, reuse), with_envelope, context); };
  if (watch.enveloped || watch.filled) return make();
  const std::optional<ContentKey> true_surface = true_surface_key(wall);
  std::optional<ContentKey> key;
  if (reuse.cache && true_surface) {
    KeyMaker maker("volume_mesh");
    maker.add(key_of(wall.mesh)).add(volume_options_key(options)).add(*true_surface).add(context.seed());
    add_engines(maker, options.tetrahedra);
    key = maker.key();
  }
  return cached_with_reference<volmesh::VolumeMeshResult>(reuse, "volume_mesh", triangles_text(wall.mesh), key, context, make, is_same_mesh_everywhere);
}

}  // namespace sterna::scripting
