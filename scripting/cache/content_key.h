// Keys of values by what they hold, never by how they came about: equal keys, equal results. Not for security.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "geom/base/hash.h"
#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"
#include "scripting/cache/archive.h"
#include "scripting/cache/provenance.h"
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

/// Collects what a key is made of.
class KeyMaker final : public ByteSink {
 public:
  /// \p what names the kind of thing: things of different kinds have different keys.
  explicit KeyMaker(std::string_view what);

  void put(const void* bytes, std::size_t n) override;
  /// Anything of archive.h.
  template <class T>
  KeyMaker& add(const T& value) {
    write_value(*this, value);
    return *this;
  }
  KeyMaker& add(const ContentKey& key) {
    put(key.bytes.data(), key.bytes.size());
    return *this;
  }
  KeyMaker& add(std::string_view text);
  KeyMaker& add(const char* text) { return add(std::string_view(text)); }
  /// Stage, name and value (17 digits) of each option; in the table's order.
  KeyMaker& add(const OptionTable& options);
  /// Only those of these stages.
  KeyMaker& add(const OptionTable& options, std::initializer_list<std::string_view> stages);
  ContentKey key() const;

 private:
  ContentHash hash_;
};

/// Of options alone.
ContentKey key_of(const OptionTable& options);
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
