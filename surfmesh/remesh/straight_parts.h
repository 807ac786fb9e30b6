// Straight parts of the given surface that curved parts continue tangentially, such as long edges beside finely cut arcs, and flat faces between fillets.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "surfmesh/remesh/reference.h"

namespace sterna::surfmesh {

struct StraightParts {
  Column<HalfedgeId, std::uint8_t> is_straight;  ///< flag of each edge, the same for both half-edges
  Column<HalfedgeId, double> most_rise;          ///< rad: largest rise of a curve over the edge, measured at the half-edge's first vertex
  Column<TriangleId, Vec3> plane;                ///< unit normal of the flat face that contains the triangle; zero if there is none
};

/// Finds straight edges and flat faces. An edge is straight if it carries none of the bend at its ends, because the adjacent parts carry all of it. A flat face
/// consists of coplanar triangles, or of one triangle much larger than its neighbours. Its triangles carry none of the bend along their border.
/// \pre lines and normals of `reference` are set; bulges are not used. \param is_sharp true for edges across which the surface is not smooth
StraightParts find_straight_parts(const Reference& reference, const Column<HalfedgeId, std::uint8_t>& is_sharp, const RunContext& context);

/// Corrects normals at the ends of straight edges and at the borders of flat faces. These normals are means that include the adjacent bends; they become normal
/// to the straight part.
void straighten_normals(Reference& reference, const Column<HalfedgeId, std::uint8_t>& is_sharp, const StraightParts& parts, const RunContext& context);

/// Returns a flag per segment of the line: true if the segment is straight.
std::vector<std::uint8_t> straight_segments(const TriMesh& mesh, const FeatureLine& line);

}  // namespace sterna::surfmesh
