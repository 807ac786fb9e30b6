// Data that the reference case of a series stores in its folder for the other cases: triangles and envelopes of parts. None of them depend on the order of
// earlier runs.
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
#include "volmesh/case/layer_rules.h"
#include "volmesh/parts/warm_start.h"

namespace sterna::scripting {

/// File in the folder of the reference case.
inline constexpr const char* k_kept_file = "reference.kept";

/// The surface of one part as meshed by the reference, in the part's own frame.
struct KeptPart {
  std::uint64_t call = 0;  ///< number of the call of surface_mesh in the case, from 0
  std::string name;        ///< name of its first component
  surfmesh::StructuredMesh mesh;
  ContentKey geometry;  ///< key of the points of its vertices on the model (carried_points); equal keys mean equal geometry
  surfmesh::SurfaceMeshOptions options;
  std::vector<Rule> patches;
  bool has_local_sizes = false;  ///< sources or a size function apply to the part
};

/// The envelope of a part alone, or of a whole wall.
struct KeptEnvelope {
  ContentKey wall;                   ///< connectivity_of() the envelope's wall
  volmesh::EnvelopeOptions options;  ///< options of the user, without values derived from the wall
  volmesh::StartingEnvelope start;
};

/// A part that took over the reference's triangles in this case.
struct CarriedPart {
  ContentKey triangles;  ///< triangles_key()
  std::string name;
  bool has_envelope = false;  ///< the outcome for its envelope has been reported
};

/// Returns the key of the triangles by the numbers of their vertices.
ContentKey triangles_key(const TriMesh& mesh);
/// Returns the key of the triangles with their patches, names and kinds.
ContentKey connectivity_of(const TriMesh& mesh);

/// The link between a running case and the reference of its series. The reference itself collects data; other cases read them. The object lives as long as the
/// case and is used by one thread.
class ReferenceUse {
 public:
  ReferenceUse(std::string name, std::filesystem::path file, bool is_this) : name_(std::move(name)), file_(std::move(file)), is_this_(is_this) {}

  const std::string& name() const { return name_; }  ///< name of the reference case
  bool is_this() const { return is_this_; }          ///< the running case is the reference

  /// Returns the key of the reference data on which the results of this case depend, in addition to the case's own inputs. This is the content of the kept
  /// file. In the reference itself the key is a constant.
  /// \throws Error(file_not_found, file_malformed) if the file is missing or damaged
  ContentKey key(const RunContext& context);
  const std::vector<KeptPart>& parts(const RunContext& context);          ///< \throws as key()
  const std::vector<KeptEnvelope>& envelopes(const RunContext& context);  ///< \throws as key()

  /// Marks the begin of a call of surface_mesh.
  void begin_surface() { n_surfaces_ += 1; }
  std::uint64_t surface() const { return n_surfaces_ - 1; }  ///< number of the current call

  void keep(KeptPart part);
  void keep(KeptEnvelope envelope);  ///< once for each wall and options
  void note_carried(const TriMesh& mesh, const std::string& name);
  /// Returns a part with these triangles that took over the reference's triangles, preferably one whose envelope outcome has not been reported. Null if there
  /// is none.
  CarriedPart* carried(const ContentKey& triangles);
  std::vector<CarriedPart>& all_carried() { return carried_; }

  /// Reports a line to the log, and adds it to the list of what the case reused.
  void report(const std::string& line, const Reuse& reuse, const RunContext& context);

  /// Writes the kept file, atomically.
  /// \pre is_this()
  /// \throws Error(write_failed)
  void save(const RunContext& context) const;

  /// Data that a stage stored here beside its result, so that a result from the cache restores the same data.
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
  std::optional<ContentKey> seal_;  ///< seal of the file that was read
  std::vector<KeptPart> parts_;     ///< stored by this case, or read
  std::vector<KeptEnvelope> envelopes_;
  std::vector<CarriedPart> carried_;
  std::vector<std::string> lines_;
  std::uint64_t n_surfaces_ = 0;
};

}  // namespace sterna::scripting
