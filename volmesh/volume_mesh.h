// The driver: from a wall to a hybrid mesh. A list of steps, nothing else.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/check.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"
#include "volmesh/domain/split_needles.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/improve/improve.h"
#include "volmesh/layer/layer_report.h"
#include "volmesh/parts/makers.h"

namespace sterna::volmesh {

struct VolumeMeshResult {
  HybridMesh mesh;
  LayerReport layer;
  EnvelopeCertificate certificate;
  CheckReport check;
  ImproveReport improvement;
  std::string tetra_engine;                 ///< "tetgen", "tetgen in two passes", "hxt" or "sterna"
  std::vector<std::string> tetra_failures;  ///< of the attempts before it, in order
  std::string tetra_choice;                 ///< what choose_engine() compared and chose; empty where it did not have to
  std::int64_t n_split_triangles = 0;       ///< of wall and outer boundary, by which the mesh has more than were given
  NeedleReport needles;                     ///< what was done about them before
  bool is_reproducible = true;              ///< false when a time or memory limit decided what was done
  double tetra_engine_seconds = 0.0;        ///< inside the engine alone; log only
  double tetra_engine_peak_bytes = 0.0;     ///< log only
};

/// Steps: farfield, needles of the wall (split_needles.h), envelope (build_envelope.h), extrude and repair, certificate, tetrahedra, improve, assemble, check.
/// Where the tetrahedra's engine was to split triangles of its boundary (tetra.h), wall, envelope and farfield of the mesh are split with them (split_layer.h);
/// where all engines fail, the envelope is repaired and everything from the extrusion on is done again (repair_envelope.h), 3 times at most.
/// \pre wall closed, manifold, free of self-intersection, normals into the fluid.
/// \throws Error of the stages; mesh_invalid when the final check finds violations.
VolumeMeshResult volume_mesh(const TriMesh& wall, const MeshCase& options, const RunContext& context);

}  // namespace sterna::volmesh
