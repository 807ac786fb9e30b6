// Private to volmesh/domain: rims that lie nearly in a plane.
#pragma once

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// A rim within this of a plane x, y or z = constant is meant to lie in it, share of the body length: CAD systems sew with such gaps.
inline constexpr double k_flat_rim = 1e-4;

/// Moves vertices of rims that lie within k_flat_rim of a plane x, y or z = constant, but not all of them within k_rim_tolerance, exactly into it: to 0 where
/// that is between them, else to the coordinate that most of them have (their median where all differ). Tells how many, and the largest distance. Rims that lie
/// in no plane, and those of which a triangle would turn over, stay as they are.
/// \pre `topology` is that of `mesh`
void flatten_rims(const Topology& topology, TriMesh& mesh, const RunContext& context);

}  // namespace sterna::volmesh
