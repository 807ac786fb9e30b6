// The stages at which a run of volume_mesh() can be stopped, written, and continued to a bit-identical mesh. A stage holds all data that later steps need.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "volmesh/case/mesh_case.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/tetra/tetra.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {

/// Multi-normal fans of opened ridges that had no valid cells (close_multi_normals.h) and stay closed.
struct ClosedMultiNormals {
  std::vector<VertexId> base_vertices;  ///< ridge base vertices, numbered in the wall with layers before its ridges are opened
  int n_rounds = 0;                     ///< number of rounds in which fans had to be closed; after k_multi_normal_rounds all fans are closed
};
inline constexpr int k_multi_normal_rounds = 5;

/// The envelope of a wall.
struct EnvelopeStage {
  Envelope envelope;
  double feature_angle = 0.0;      ///< rad, given by the user or determined automatically
  ClosedMultiNormals closed = {};  ///< fans, with vertex numbers of the envelope's wall
};

/// The layer below the envelope, and the tetrahedra that an engine made around the layer.
struct FilledStage {
  std::optional<TriMesh> split_wall;  ///< nullopt: the wall is unchanged except for sliver splitting
  EnvelopeStage envelope;             ///< envelope of that wall, at the current layer heights
  /// Result of assemble_layers(): growth lines of the layer, then the outer boundary, without tetrahedra. Cells are columns, also on opened walls.
  HybridMesh layers;
  TetraResult tets;  ///< tetrahedra that fill boundary_of(layers); they are not improved yet and have no splits
  std::vector<std::string> tetra_failures;
  std::array<std::int64_t, 5> curving_shares{};  ///< as in Extrusion::curving_shares
  std::int64_t n_split_triangles = 0;
  SliverReport slivers;    ///< sliver report of the wall, which comes before all other steps
  bool is_opened = false;  ///< ridges are opened or wakes have sheets; finish_mesh() then converts `layers` to cells of the given wall
};

/// Observer callbacks at the ends of the stages of volume_mesh(). Any of them may be empty.
struct StageWatch {
  /// Returns the envelope for this wall and these options. It is computed by the argument or loaded from elsewhere. It is verified in either case.
  std::function<EnvelopeStage(const std::function<EnvelopeStage()>&)> envelope;
  std::function<void(const EnvelopeStage&)> enveloped;
  std::function<void(const FilledStage&)> filled;
};

/// Runs volume_mesh() with callbacks.
VolumeMeshResult watched_volume_mesh(const TriMesh& wall, const MeshCase& options, const Makers& makers, const StageWatch& watch, const RunContext& context);

/// Runs the steps to the envelope.
/// \pre the precondition of volume_mesh()
/// \throws the errors of volume_mesh()
EnvelopeStage make_envelope(const TriMesh& wall, const MeshCase& options, const Makers& makers, const RunContext& context);
/// Runs the steps to the tetrahedra with this envelope, all data of which is verified again. If multi-normal fans have no valid cells, they are closed, and
/// envelopes are made as for volume_mesh().
/// \pre `envelope` was returned by make_envelope() for this wall
/// \throws Error(bad_argument) for an envelope of another size; the errors of the stages
FilledStage make_tetrahedra(const TriMesh& wall, const EnvelopeStage& envelope, const MeshCase& options, const Makers& makers, const RunContext& context);
/// Runs the last steps: improves the tetrahedra, joins them with the layer, and checks the mesh. The data of the stage is verified again first. Options of
/// earlier steps affect only the report and the tetrahedra of a second engine (second_engine.h). \throws Error(bad_argument) for parts that do not belong
/// together; the errors of the stages
VolumeMeshResult finish_mesh(const TriMesh& wall, FilledStage filled, const MeshCase& options, const RunContext& context);

/// Returns the case with the known state of its ridges. After the largest number of failed rounds no ridge is opened.
MeshCase with_closed_multi_normals(MeshCase options, const ClosedMultiNormals& closed);

}  // namespace sterna::volmesh
