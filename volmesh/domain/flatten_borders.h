// Private to volmesh/domain: flattens open-boundary loops that are nearly plane.
#pragma once

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// Fraction of the body length: an open-boundary loop within this distance of a plane x, y or z = constant is treated as lying in the plane, because CAD
/// systems sew faces with such gaps.
inline constexpr double k_flat_border = 1e-4;

/// Flattens open-boundary loops. Vertices of loops that lie within k_flat_border of a plane x, y or z = constant, but not all within k_border_tolerance, are
/// moved exactly into the plane. The coordinate of the plane is 0 if 0 is between the coordinates of the vertices. Otherwise it is the most frequent coordinate
/// (the median if all differ). The log reports the number and the largest distance. Loops that lie in no plane, and loops at which a triangle would be
/// inverted, stay unchanged. \pre `topology` is that of `mesh`
void flatten_borders(const Topology& topology, TriMesh& mesh, const RunContext& context);

}  // namespace sterna::volmesh
