// The stages of a volume mesh, taken from a cache where they are there. Without a cache they are those of volmesh/stages.h.
#pragma once

#include <optional>

#include "geom/base/run_context.h"
#include "scripting/cache/provenance.h"
#include "scripting/cache/stage_cache.h"
#include "scripting/values/verbs.h"
#include "volmesh/stages.h"

namespace sterna::scripting {

/// `options` are those of volmesh, with all that is known of the wall.
/// \throws as the functions of volmesh/stages.h
volmesh::EnvelopeStage cached_envelope(const SurfaceValue& wall, const volmesh::MeshCase& options, const Reuse& reuse, const RunContext& context);
volmesh::FilledStage cached_tetrahedra(const SurfaceValue& wall, const volmesh::EnvelopeStage& envelope, const volmesh::MeshCase& options, const Reuse& reuse,
                                       const RunContext& context);
volmesh::VolumeMeshResult cached_finish(const SurfaceValue& wall, const volmesh::FilledStage& filled, const volmesh::MeshCase& options, const Reuse& reuse,
                                        const RunContext& context);
/// All of it: the whole mesh where it is there, else from the envelope on where that is there. With a watch, whose eyes want to see every step, never the whole
/// mesh.
volmesh::VolumeMeshResult cached_volume_mesh(const SurfaceValue& wall, const volmesh::MeshCase& options, const volmesh::StageWatch& watch, const Reuse& reuse,
                                             const RunContext& context);

}  // namespace sterna::scripting
