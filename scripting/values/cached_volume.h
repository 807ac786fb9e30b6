// Takes the stages of a volume mesh from a cache if present. Without a cache these are the stages of volmesh/stages.h.
#pragma once

#include <optional>

#include "geom/base/run_context.h"
#include "scripting/cache/provenance.h"
#include "scripting/cache/stage_cache.h"
#include "scripting/values/verbs.h"
#include "volmesh/stages.h"

namespace sterna::scripting {

/// Each function returns the result of one stage, from the cache if present. `options` are those of volmesh, with all known facts about the wall.
/// \throws as the functions of volmesh/stages.h
volmesh::EnvelopeStage cached_envelope(const SurfaceValue& wall, const volmesh::MeshCase& options, const Reuse& reuse, const RunContext& context);
volmesh::FilledStage cached_tetrahedra(const SurfaceValue& wall, const volmesh::EnvelopeStage& envelope, const volmesh::MeshCase& options, const Reuse& reuse,
                                       const RunContext& context);
volmesh::VolumeMeshResult cached_finish(const SurfaceValue& wall, const volmesh::FilledStage& filled, const volmesh::MeshCase& options, const Reuse& reuse,
                                        const RunContext& context);
/// Returns the result of all stages. If the whole mesh is cached, returns it; otherwise runs the stages, from the cached envelope on if there is one. With a
/// watch, whose observers must see every step, the cached whole mesh is never used.
volmesh::VolumeMeshResult cached_volume_mesh(const SurfaceValue& wall, const volmesh::MeshCase& options, const volmesh::StageWatch& watch, const Reuse& reuse,
                                             const RunContext& context);

}  // namespace sterna::scripting
