// Keys of values by their content, see content_key.h.
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

/// Returns the key of points, triangles and patches.
ContentKey key_of(const TriMesh& mesh);
/// Returns the key of all settings of surface_mesh except the function of the location.
ContentKey key_of(const SurfaceRecipe& recipe);
/// Returns the key of a surface: mesh, reports, options, inputs by hash, recipe, and the model behind the mesh if there is one. Returns nothing if the model's
/// inputs are unknown.
std::optional<ContentKey> key_of(const SurfaceValue& surface);
/// Returns the key of the component in its current state.
ContentKey key_of(const ComponentValue& component);

/// Returns the key of the inputs of an envelope besides its wall: options of envelope and farfield, rules of patches, discs, the farfield's surface, and the
/// smooth angle.
ContentKey envelope_options_key(const volmesh::MeshCase& options);
/// Returns the key of all inputs of a volume mesh besides its wall, except the true surface.
ContentKey volume_options_key(const volmesh::MeshCase& options);
ContentKey key_of(const volmesh::EnvelopeStage& stage);
ContentKey key_of(const volmesh::FilledStage& stage);
std::optional<ContentKey> key_of(const EnvelopeValue& envelope);
std::optional<ContentKey> key_of(const TetrahedraValue& tetrahedra);
ContentKey key_of(const MeshValue& mesh);

}  // namespace sterna::scripting
