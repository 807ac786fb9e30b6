// What the reference case of a series keeps for the other cases, in its folder, and what these take from it: triangles and envelopes of parts, never anything
// from history.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "scripting/cache/archive.h"
#include "scripting/cache/provenance.h"
#include "scripting/cache/reuse.h"
#include "surfmesh/model/carry_mesh.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/case/patch_rule.h"
#include "volmesh/parts/warm_start.h"

namespace sterna::scripting {

/// In the folder of the reference case.
inline constexpr const char* k_kept_file = "reference.kept";

/// The surface of one part as the reference meshed it, in the part's own frame.
struct KeptPart {
  std::uint64_t call = 0;  ///< which call of surface_mesh in the case, from 0
  std::string name;        ///< of its first component
  surfmesh::StructuredMesh mesh;
  ContentKey geometry;  ///< of its vertices' points as the model gives them (carried_points): equal where the geometry is
  surfmesh::SurfaceMeshOptions options;
  std::vector<surfmesh::PatchSurfaceOptions> patches;
  bool has_sizes_by_place = false;  ///< sources or a size function
};

/// The envelope of a part alone, or of a whole wall.
struct KeptEnvelope {
  ContentKey wall;                   ///< connectivity_of() its wall
  volmesh::EnvelopeOptions options;  ///< as they were asked for, without what was found for the wall
  volmesh::StartingEnvelope start;
};

/// A part that took over the reference's triangles here.
struct CarriedPart {
  ContentKey triangles;  ///< triangles_key()
  std::string name;
  bool has_envelope = false;  ///< it was told what became of its envelope
};

/// Triangles by the numbers of their vertices.
ContentKey triangles_key(const TriMesh& mesh);
/// The same with their patches, names and kinds.
ContentKey connectivity_of(const TriMesh& mesh);

/// What a running case has to do with the reference of its series: in the reference itself it collects, in others it reads. Lives as long as the case; used by
/// one thread.
class ReferenceUse {
 public:
  ReferenceUse(std::string name, std::filesystem::path file, bool is_this) : name_(std::move(name)), file_(std::move(file)), is_this_(is_this) {}

  const std::string& name() const { return name_; }  ///< of the reference case
  bool is_this() const { return is_this_; }          ///< the case that runs is the reference

  /// What the results of this case depend on beside their own inputs: the content of the kept file; in the reference itself a constant.
  /// \throws Error(file_not_found, file_malformed) where there is none, or it is damaged
  ContentKey key(const RunContext& context);
  const std::vector<KeptPart>& parts(const RunContext& context);          ///< \throws as key()
  const std::vector<KeptEnvelope>& envelopes(const RunContext& context);  ///< \throws as key()

  /// A call of surface_mesh begins.
  void begin_surface() { n_surfaces_ += 1; }
  std::uint64_t surface() const { return n_surfaces_ - 1; }  ///< its number

  void keep(KeptPart part);
  void keep(KeptEnvelope envelope);  ///< once for each wall and options
  void note_carried(const TriMesh& mesh, const std::string& name);
  /// The part with these triangles that took over the reference's, first one that nothing was told of yet; null: there is none.
  CarriedPart* carried(const ContentKey& triangles);
  std::vector<CarriedPart>& all_carried() { return carried_; }

  /// To the log and to the lines of what the case reused.
  void tell(const std::string& line, const Reuse& reuse, const RunContext& context);

  /// Writes the kept file, whole or not at all.
  /// \pre is_this()
  /// \throws Error(write_failed)
  void save(const RunContext& context) const;

  /// What a stage left here beside its result, so that one from the cache leaves the same.
  struct Beside {
    std::vector<KeptPart> parts;
    std::vector<KeptEnvelope> envelopes;
    std::vector<CarriedPart> carried;
    std::vector<std::string> lines;
  };
  struct Mark {
    std::size_t n_parts = 0, n_envelopes = 0, n_carried = 0, n_lines = 0;
  };
  Mark mark() const { return {parts_.size(), envelopes_.size(), carried_.size(), lines_.size()}; }
  Beside since(const Mark& mark) const;
  void take(Beside beside, const Reuse& reuse, const RunContext& context);

 private:
  void read(const RunContext& context);

  std::string name_;
  std::filesystem::path file_;
  bool is_this_;
  std::optional<ContentKey> seal_;  ///< of the file that was read
  std::vector<KeptPart> parts_;     ///< kept here, or read
  std::vector<KeptEnvelope> envelopes_;
  std::vector<CarriedPart> carried_;
  std::vector<std::string> lines_;
  std::uint64_t n_surfaces_ = 0;
};

}  // namespace sterna::scripting
