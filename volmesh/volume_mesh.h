// The driver, which makes a hybrid mesh from a wall in a sequence of steps.
#pragma once

#include <string>
#include <vector>

#include "geom/base/measured.h"
#include "geom/base/run_context.h"
#include "geom/mesh/check.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"
#include "volmesh/domain/split_slivers.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/improve/improve.h"
#include "volmesh/layer/layer_report.h"
#include "volmesh/parts/makers.h"

namespace sterna::volmesh {

/// How a volume mesh was made.
struct VolumeMeshReport {
  LayerReport layer;
  EnvelopeCertificate certificate;
  ImproveReport improvement;
  std::string tetra_engine;                 ///< engine: "tetgen", "tetgen in two passes", "hxt" or "sterna"
  std::vector<std::string> tetra_failures;  ///< failures of the previous attempts, in order
  std::string tetra_choice;                 ///< text on the comparison and choice of choose_engine(); empty if there was no comparison
  std::int64_t n_split_triangles = 0;       ///< number of triangles of wall and outer boundary that were added, compared with the input
  SliverReport slivers;                     ///< report of the sliver splitting, which comes before the mesh
  bool is_reproducible = true;              ///< false if a time or memory limit affected the result
  Measured tetra_engine_seconds;            ///< time inside the engine alone, for the log only
  Measured tetra_engine_peak_bytes;         ///< for the log only
};

struct VolumeMeshResult : VolumeMeshReport {
  HybridMesh mesh;
  CheckReport check;
};

/// Makes a volume mesh. Steps: farfield, sliver triangles of the wall (split_slivers.h), envelope (build_envelope.h), extrusion and repair, certificate,
/// tetrahedra, improvement, assembly, check. If the engine had to split boundary triangles (tetra.h), wall, envelope and farfield of the mesh are split in the
/// same way (split_layer.h). If all engines fail, the envelope is repaired, and all steps from the extrusion on are repeated (repair_envelope.h), at most 3
/// times.
/// \pre the wall is closed, manifold and free of self-intersection; its normals point into the fluid
/// \throws the errors of the stages; mesh_invalid if the final check finds violations
VolumeMeshResult volume_mesh(const TriMesh& wall, const MeshCase& options, const RunContext& context);

}  // namespace sterna::volmesh
