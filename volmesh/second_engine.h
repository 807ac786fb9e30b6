// Runs a second engine for the tetrahedra if the mesh of the first engine misses hard limits that the boundary does not force.
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

/// Input with which another engine can fill the same boundary.
struct SecondEngine {
  TetraOptions tetrahedra;
  std::vector<SizeSource> sources;
  SizeFieldOptions sizes;
  std::vector<Vec3> holes;  ///< these members as in TetraBoundary
  ClearProof clear;
  BoundaryTraits traits;
};
/// Returns the input of the case for another engine. \p clear proof for the boundary
SecondEngine second_engine(const MeshCase& options, std::vector<Vec3> holes, ClearProof clear, BoundaryTraits traits);

/// Tetrahedra beyond the hard limits of gates G14 and G15.
struct HardMisses {
  /// Number of tetrahedra with a dihedral angle beyond the limits of G14, except those that the boundary provably forces (remaining.h).
  std::int64_t n_angles = 0;
  std::int64_t n_growth = 0;  ///< number of faces between volumes whose ratio is beyond the limit of G15
  double smallest = 0.0;      ///< rad, smallest dihedral angle of all tetrahedra
  double largest = 0.0;       ///< rad, largest dihedral angle of all tetrahedra
  double growth = 1.0;        ///< largest ratio of volumes at a face that is beyond the limit of G15; 1 if there is none

  std::int64_t n() const { return n_angles + n_growth; }
};
/// Counts the tetrahedra beyond the hard limits. \pre verify_tetrahedra() passes. Parallel, O(n).
HardMisses hard_misses(const TetraBoundary& boundary, const TetraResult& tets, const ImproveOptions& options, const RunContext& context);

/// Fills the boundary with the other engine (HXT after sterna's own engine, otherwise sterna's own) and improves that mesh. This is done only if the improved
/// tetrahedra miss hard limits, `automatic` has chosen the engine, and its first attempt succeeded. Keeps the mesh with fewer misses; if both have the same
/// number, the mesh with the larger smallest angle; if these are also equal, the first mesh. \p boundary the same as for improve_tetrahedra(). \p failures
/// failures of the attempts before `tets`
/// \post `tets` and `report` are those of the mesh that is kept
/// \return description of the comparison and the choice, for log and manifest; empty if no comparison was made
std::string choose_engine(const FillBoundary& boundary, const SecondEngine& second, const ImproveOptions& options, const std::vector<std::string>& failures,
                          TetraResult& tets, ImproveReport& report, const RunContext& context);

}  // namespace sterna::volmesh
