// Keys of values by what they hold, see content_key.h.
#pragma once

#include <optional>

#include "geom/mesh/tri_mesh.h"
#include "scripting/cache/content_key.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
struct EnvelopeStage;
struct FilledStage;
}  // namespace sterna::volmesh

namespace sterna::scripting {

struct ComponentValue;
struct EnvelopeValue;
struct MeshValue;
struct SurfaceRecipe;
struct SurfaceValue;
struct TetrahedraValue;

/// Points, triangles, patches.
ContentKey key_of(const TriMesh& mesh);
/// What surface_mesh is asked for; not the function of place.
ContentKey key_of(const SurfaceRecipe& recipe);
/// Mesh, reports, options, inputs by hash, recipe, and, where there is one, the model behind it: nothing where that is not known.
std::optional<ContentKey> key_of(const SurfaceValue& surface);
/// The component as it is now.
ContentKey key_of(const ComponentValue& component);

/// What an envelope depends on beside its wall: options of envelope and farfield, rules of patches, discs, the farfield's surface, the smooth angle.
ContentKey envelope_options_key(const volmesh::MeshCase& options);
/// What a volume mesh depends on beside its wall: all of it, but for the true surface.
ContentKey volume_options_key(const volmesh::MeshCase& options);
ContentKey key_of(const volmesh::EnvelopeStage& stage);
ContentKey key_of(const volmesh::FilledStage& stage);
std::optional<ContentKey> key_of(const EnvelopeValue& envelope);
std::optional<ContentKey> key_of(const TetrahedraValue& tetrahedra);
ContentKey key_of(const MeshValue& mesh);

}  // namespace sterna::scripting
