// A volume mesh step by step. Intermediate values are stored in a .sterna file, so that a run can be stopped and continued to the same bytes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "scripting/cache/reuse.h"
#include "scripting/lua/handles.h"
#include "scripting/values/verbs.h"
#include "volmesh/envelope/steps.h"
#include "volmesh/stages.h"

namespace sterna::scripting {

/// The envelope of a wall, with all data that the rest of the run needs.
struct EnvelopeValue {
  SurfaceHandle wall;
  volmesh::MeshCase options;
  volmesh::EnvelopeStage stage;
  volmesh::EnvelopeStep step = volmesh::EnvelopeStep::finished;  ///< last step that was performed, if the steps are called one by one (envelope_steps.h)
  std::shared_ptr<const volmesh::Classification> classes = {};   ///< result of the step "classified", which makes no other data
};

/// Layer and tetrahedra, not yet combined to one mesh.
struct TetrahedraValue {
  SurfaceHandle wall;
  std::int64_t n_wall_triangles = 0;  ///< number of given triangles, before any splits
  volmesh::MeshCase options;
  volmesh::FilledStage stage;
};

/// Return the options of each of the three steps. The arguments must outlive the tables.
OptionTable envelope_options(volmesh::MeshCase& options);
OptionTable tetrahedra_options(volmesh::MeshCase& options);
OptionTable finish_options(volmesh::MeshCase& options);

/// Returns the options completed by properties of the wall itself: the largest turn where it is smooth, rules for its patches, its model.
volmesh::MeshCase with_wall_facts(const SurfaceValue& wall, volmesh::MeshCase options);

/// \throws Error of volmesh::make_envelope, make_tetrahedra, finish_mesh.
EnvelopeValue make_envelope(const SurfaceHandle& wall, const volmesh::MeshCase& options, const RunContext& context, const Reuse& reuse = {});
TetrahedraValue make_tetrahedra(const EnvelopeValue& envelope, const volmesh::MeshCase& options, const RunContext& context, const Reuse& reuse = {});
MeshValue finish_mesh(const TetrahedraValue& tetrahedra, const volmesh::MeshCase& options, const RunContext& context, const Reuse& reuse = {});

/// Makes a volume mesh. Stores surface, envelope, tetrahedra and finally the mesh, its manifest, certificate and quality in a .sterna file, which is replaced
/// as each step ends. Nothing is written without a name.
MeshValue make_volume_mesh(const SurfaceValue& wall, const volmesh::MeshCase& options, const std::filesystem::path& stages, const RunContext& context,
                           const Reuse& reuse = {});

/// The content of a .sterna file; null for missing parts. In a file with tetrahedra, the envelope is that of their layer, and its wall may have been split.
struct StageContent {
  SurfaceHandle surface;
  EnvelopeHandle envelope;
  TetrahedraHandle tetrahedra;
  MeshHandle mesh;
};
/// \throws Error of io; file_malformed if parts do not belong together or options are missing.
StageContent read_stages(const InputPath& file, const RunContext& context);

/// Writes a step's value to a .sterna file.
/// \throws Error of io; bad_argument for another extension.
void write_stage(const EnvelopeValue& envelope, const std::filesystem::path& path, const RunContext& context);
void write_stage(const TetrahedraValue& tetrahedra, const std::filesystem::path& path, const RunContext& context);

/// \throws Error(bad_argument) unless steps can be written to a file of this name.
void require_stage_output(const std::filesystem::path& path);

/// Returns one line for the value.
std::string describe(const EnvelopeValue& envelope);
std::string describe(const TetrahedraValue& tetrahedra);

}  // namespace sterna::scripting
