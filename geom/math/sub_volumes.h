// The sign of a dual sub-volume: the tet of a cell's corner, an edge's midpoint, a face's centroid and the cell's centroid (means of their nodes).
#pragma once

#include <array>
#include <span>

#include "geom/math/measures.h"

namespace sterna {

/// Sign of the volume of (corner, midpoint of corner-next, centroid of the face, centroid of the cell) for a face that runs corner, next, others..., its
/// right-hand normal out of the cell; `rest` are the cell's nodes off the face. The sub-tet at `next` has the same volume. Only the node sums count: 48 V =
/// -det(next, sum of others, sum of rest) relative to the corner, times positive factors. Exact: floating point with a forward error bound, undecided cases by
/// expansions.
/// \pre 1 or 2 others, 1 to 4 rest; finite coordinates, range as for orient3d.
int sub_volume_sign(const Vec3& corner, const Vec3& next, std::span<const Vec3> others, std::span<const Vec3> rest);

/// Whether all 36 sub-tets of a wedge (CGNS order), all 32 of a pyramid are positive. Neither implies nor follows from is_wedge_valid: a wedge that leans or
/// warps enough has its centroid outside of one of its faces' cones. Exact; floating point first, about 10 M wedges/s/core.
bool are_sub_volumes_positive(const WedgePoints& p);
bool are_sub_volumes_positive(const std::array<Vec3, 5>& p);

}  // namespace sterna
