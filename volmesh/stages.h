// The steps of volume_mesh() by hand: the value of each holds all that the rest needs, so that a run can be stopped behind any of them, written, and continued
// to the same mesh, to the bit.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "volmesh/envelope/envelope.h"
#include "volmesh/layer/assemble.h"
#include "volmesh/second_engine.h"
#include "volmesh/site/site.h"
#include "volmesh/tetra/tetra.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {

/// Fans of opened ridges that had no valid cells (close_fans.h), and stay closed.
struct ClosedFans {
  std::vector<VertexId> feet;  ///< of the wall with layers, as it is before its ridges are opened
  int n_rounds = 0;            ///< how often fans had to be closed; after k_fan_rounds all are
};
inline constexpr int k_fan_rounds = 5;

/// The envelope of a wall.
struct EnvelopeStage {
  Envelope envelope;
  double feature_angle = 0.0;  ///< rad, the user's or the one found
  ClosedFans closed = {};      ///< on the wall that it is of
};

/// The layer under the envelope, and the tetrahedra that an engine has made around it.
struct FilledStage {
  std::optional<TriMesh> split_wall;  ///< nullopt: the wall as it was given, but for its needles
  EnvelopeStage envelope;             ///< of that wall, as the layer ends now
  HybridMesh layers;                  ///< of assemble_layers(): lines of the layer, then the outer boundary; no tetrahedra. Columns, on opened walls, too
  TetraResult tets;                   ///< fill boundary_of(layers); not improved, without splits
  std::vector<std::string> tetra_failures;
  std::array<std::int64_t, 5> curving_shares{};  ///< Extrusion::curving_shares
  std::int64_t n_split_triangles = 0;
  NeedleReport needles;    ///< of the wall, before all this
  bool is_opened = false;  ///< ridges are opened or wakes have sheets: finish_mesh() makes the given wall's cells of `layers`
};

/// Called when a step of volume_mesh() has ended; any may be empty.
struct StageWatch {
  /// Makes the envelope by calling its argument, or has it from elsewhere: that of this wall and these options. It is proved like any other.
  std::function<EnvelopeStage(const std::function<EnvelopeStage()>&)> envelope;
  std::function<void(const EnvelopeStage&)> enveloped;
  std::function<void(const FilledStage&)> filled;
};

/// volume_mesh() with someone who looks on.
VolumeMeshResult volume_mesh(const TriMesh& wall, const MeshCase& options, const Makers& makers, const StageWatch& watch, const RunContext& context);

/// The first step.
/// \pre,
/// \throws as volume_mesh()
EnvelopeStage make_envelope(const TriMesh& wall, const MeshCase& options, const Makers& makers, const RunContext& context);
/// The second. Everything that the envelope is made of is proved again. Where fans have no valid cells, they are closed and the first step is done again.
/// \pre `envelope` of make_envelope() on this wall
/// \throws Error(bad_argument) for an envelope of another size, else of the stages
FilledStage make_tetrahedra(const TriMesh& wall, const EnvelopeStage& envelope, const MeshCase& options, const Makers& makers, const RunContext& context);
/// The last: improves, joins, checks. What the stage holds is proved again; options of earlier steps have no effect but in the report, and for the tetrahedra
/// of a second engine (second_engine.h). \throws Error(bad_argument) for parts that do not belong together, else of the stages
VolumeMeshResult finish_mesh(const TriMesh& wall, FilledStage filled, const MeshCase& options, const RunContext& context);

// ---- The same for a driver that does not want to prove anything twice ---------------------------------------------------------------------

/// What is known of a layer beside its mesh.
struct LayerKnowledge {
  LayerReport report;
  EnvelopeCertificate certificate;
  std::optional<LayerCheck> check;
  std::optional<HybridMesh> closed;         ///< the given wall's cells of a layer on an opened one
  FillBoundary boundary;                    ///< that the tetrahedra fill around `closed`
  std::optional<SecondEngine> second = {};  ///< where another engine may fill the boundary, too
};

/// The first two steps, from an envelope on where there is one.
FilledStage make_filled(const TriMesh& wall, const MeshCase& options, const Makers& makers, const StageWatch& watch, std::optional<EnvelopeStage> envelope,
                        LayerKnowledge& knowledge, const RunContext& context);
/// The case with what is known of its ridges: when so many rounds were in vain, none is opened.
MeshCase with_closed_fans(MeshCase options, const ClosedFans& closed);
EnvelopeStage make_envelope(MeshingSite& site, const Makers& makers, const RunContext& context);
/// The layer under the envelope, which may get lower, and the tetrahedra around it. \throws Error(bad_argument) for an envelope of another size
FilledStage make_tetrahedra(MeshingSite& site, EnvelopeStage envelope, const Makers& makers, LayerKnowledge& knowledge, const RunContext& context);
/// \throws Error(bad_argument) where an envelope has not one height for each vertex
void require_envelope_of(const LayerBase& base, const EnvelopeStage& stage);
SecondEngine second_engine(const MeshCase& options, std::vector<Point> holes, bool has_wakes);
VolumeMeshResult finish_mesh(FilledStage filled, LayerKnowledge knowledge, const ImproveOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
