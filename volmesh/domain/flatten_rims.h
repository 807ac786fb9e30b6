// Private to volmesh/domain: open-boundary loops that are nearly plane.
#pragma once

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// An open-boundary loop within this distance of a plane x, y or z = constant is treated as lying in it, share of the body length: CAD systems sew with such
/// gaps.
inline constexpr double k_flat_rim = 1e-4;

/// Flattens open-boundary loops. Vertices of loops that lie within k_flat_rim of a plane x, y or z = constant, but not all within k_rim_tolerance, are moved
/// exactly into the plane. The coordinate is 0 if that is between them, otherwise the most frequent one (the median if all differ). The log reports the number
/// and the largest distance. Loops that lie in no plane, and loops of which a triangle would be inverted, stay unchanged.
/// \pre `topology` is that of `mesh`
void flatten_rims(const Topology& topology, TriMesh& mesh, const RunContext& context);

}  // namespace sterna::volmesh
