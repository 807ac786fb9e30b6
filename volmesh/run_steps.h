// The steps of a run of the driver, and the state between them. Only the driver uses this header; stages.h has the values at which a run can stop.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geom/base/borrowed.h"
#include "volmesh/lay_out.h"
#include "volmesh/layer_domain/layer_domain.h"
#include "volmesh/second_engine.h"
#include "volmesh/stages.h"

namespace sterna::volmesh {

/// The steps in their order. volume_mesh.cpp has the table of their functions.
enum class RunStep : std::uint8_t { domain, envelope, layer, tetrahedra, improvement, joining, proof };

/// Data about a layer that its mesh does not contain.
struct LayerKnowledge {
  LayerReport report;
  EnvelopeCertificate certificate;
  std::optional<LayerCheck> check;
  std::optional<HybridMesh> closed = {};    ///< cells of the given wall for a layer on an opened wall
  FillBoundary boundary = {};               ///< boundary that the tetrahedra fill around `closed`
  std::optional<SecondEngine> second = {};  ///< set if another engine may fill the boundary, too
};

/// Attempts with the same domain. They end when an engine has filled the boundary, or when multi-normal fans have to be closed.
struct RunRound {
  int n_repairs = 0;                       ///< number of repairs of the envelope after engines have failed
  std::vector<std::string> failures = {};  ///< failures of the engines before these repairs
  std::vector<std::string> reported = {};  ///< warnings of the layer that the log already has
};

/// State of a run. Each step reads the results of earlier steps, and frees what later steps do not need.
struct MeshRun {
  Borrowed<const TriMesh> surface;
  Borrowed<const MeshCase> options;  ///< options as the user gave them
  Borrowed<const Makers> makers;
  Borrowed<const StageWatch> watch;
  std::optional<EnvelopeStage> given = {};  ///< envelope of an earlier run for the first round

  ClosedMultiNormals closed = {};
  RunRound round = {};
  std::optional<LayerDomain> layer_domain = {};  ///< from the domain to the tetrahedra
  EnvelopeStage envelope = {};
  LaidLayer layer = {};
  FilledStage filled = {};  ///< result of the tetrahedra, or the given stage
  LayerKnowledge knowledge = {};
  FillBoundary boundary = {};            ///< boundary of the tetrahedra, from the improvement on
  std::vector<std::uint32_t> slid = {};  ///< growth lines whose ends the improvement has moved, ascending
  VolumeMeshResult result = {};
};

/// Builds wall and outer boundary. \throws the errors of LayerDomain
void domain_step(MeshRun& run, const RunContext& context);
/// Makes the envelope, or takes the given one. \throws Error(bad_argument) for a given envelope of another size
void envelope_step(MeshRun& run, const RunContext& context);
/// Makes the layer below the envelope, which may be lowered for this. \throws the errors of lay_out()
void layer_step(MeshRun& run, const RunContext& context);
/// Makes the tetrahedra around the layer, and proves the layer. The domain is freed. \throws FillError; the errors of split_layer()
void tetrahedra_step(MeshRun& run, const RunContext& context);
/// Improves the tetrahedra within their boundary, then with moved ends of growth lines.
void improvement_step(MeshRun& run, const RunContext& context);
/// Joins the tetrahedra with the layer.
void joining_step(MeshRun& run, const RunContext& context);
/// Proves the mesh. \throws Error(mesh_invalid)
void proof_step(MeshRun& run, const RunContext& context);

/// Logs the warnings of the layer that the log does not have yet.
void warn_of_layer(MeshRun& run, const RunContext& context);
/// Lowers and smooths the envelope after engines have failed. Returns false if nothing can be repaired or the limit of repairs is reached.
bool repair_for_engines(MeshRun& run, const FillError& error, const RunContext& context);
/// Restores what the run knows of a layer before the improvement, from the filled stage of an earlier run. All data is verified again.
/// \throws Error(bad_argument) for parts that do not belong together; the errors of the stages
void restore(MeshRun& run, const RunContext& context);

/// Returns the context of a step for its share of the progress.
RunContext part_of_run(RunStep step, const RunContext& context);

/// \throws Error(bad_argument) if two numbers of parts of a continued run differ
void require_same(std::size_t found, std::size_t expected, const std::string& what);

}  // namespace sterna::volmesh
