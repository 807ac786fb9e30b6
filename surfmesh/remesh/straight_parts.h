// Parts of the given surface that are straight although curved parts continue them tangentially: long edges beside finely cut arcs, flat faces between fillets.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "surfmesh/remesh/reference.h"

namespace sterna::surfmesh {

struct StraightParts {
  Column<HalfedgeId, std::uint8_t> is_straight;  ///< of the edge, the same for both half-edges
  Column<HalfedgeId, double> most_rise;          ///< rad: largest rise of a curve over the edge at the half-edge's first vertex
  Column<TriangleId, Vec3> plane;                ///< unit normal of the flat face that the triangle is in; zero: none
};

/// Finds edges that carry none of the bend at their ends, because the parts that continue them carry all of it, and flat faces: coplanar triangles, or one
/// much larger than its neighbours, that carry none of the bend along their border.
/// \pre lines and normals of `reference` are there; bulges are not used. \param is_sharp edges across which the surface is not smooth
StraightParts find_straight_parts(const Reference& reference, const Column<HalfedgeId, std::uint8_t>& is_sharp, const RunContext& context);

/// Turns normals at ends of straight edges and at borders of flat faces, which are means with the bends beside them: normal to the straight part.
void straighten_normals(Reference& reference, const Column<HalfedgeId, std::uint8_t>& is_sharp, const StraightParts& parts, const RunContext& context);

/// Of each segment of the line whether it is straight.
std::vector<std::uint8_t> straight_segments(const TriMesh& mesh, const FeatureLine& line);

}  // namespace sterna::surfmesh
