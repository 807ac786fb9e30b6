// A second engine for the tetrahedra where the first one's mesh misses hard limits that the boundary does not force.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"
#include "volmesh/case/mesh_case.h"
#include "volmesh/improve/improve.h"
#include "volmesh/layer/assemble.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// What another engine needs to fill the same boundary.
struct SecondEngine {
  TetraOptions tetrahedra;
  std::vector<SizeSource> sources;
  SizeFieldOptions sizes;
  std::vector<Vec3> holes;  ///< as TetraBoundary::hole_points
  bool has_sheets = false;
  bool has_wakes = false;
};

/// Tetrahedra beyond the hard limits of gates G14 and G15.
struct HardMisses {
  std::int64_t n_angles = 0;  ///< tetrahedra with a dihedral angle beyond the limits of G14 that the boundary is not proven to force (remaining.h)
  std::int64_t n_growth = 0;  ///< faces with volumes beside them beyond the limit of G15
  double smallest = 0.0;      ///< dihedral angle of all tetrahedra, rad
  double largest = 0.0;       ///< rad
  double growth = 1.0;        ///< largest ratio of volumes at a face that is beyond the limit of G15; 1 where none is

  std::int64_t n() const { return n_angles + n_growth; }
};
/// \pre verify_tetrahedra() passes. Parallel, O(n).
HardMisses hard_misses(const TetraBoundary& boundary, const TetraResult& tets, const ImproveOptions& options, const RunContext& context);

/// Where improved tetrahedra miss hard limits, `automatic` has chosen the engine and its first attempt had an answer: fills the boundary with the other engine
/// (HXT after our own, else our own), improves that mesh, and keeps the one with fewer misses; of equals the one with the larger least angle, then the first.
/// \p boundary: as for improve_tetrahedra(). \p failures: of the attempts before `tets`
/// \post `tets` and `report` are those of the mesh that is kept
/// \return what was compared and chosen, for log and manifest; empty where nothing had to be
std::string choose_engine(const FillBoundary& boundary, const SecondEngine& second, const ImproveOptions& options, const std::vector<std::string>& failures,
                          TetraResult& tets, ImproveReport& report, const RunContext& context);

}  // namespace sterna::volmesh
