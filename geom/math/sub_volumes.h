// The sign of a dual sub-volume: the tet of a cell's corner, an edge's midpoint, a face's centroid and the cell's centroid (means of their nodes).
#pragma once

#include <array>
#include <span>

#include "geom/math/measures.h"

namespace sterna {

/// Returns the sign of the volume of (corner, midpoint of corner-next, centroid of the face, centroid of the cell). The face runs corner, next, others..., with
/// its right-hand normal out of the cell; `rest` are the cell's nodes off the face. The sub-tet at `next` has the same volume. The volume depends only on the
/// sums of nodes: relative to the corner, 48 V = -det(next, sum of others, sum of rest), times positive factors. The sign is exact: floating point with a
/// forward error bound decides most cases, expansions decide the others.
/// \pre 1 or 2 others, 1 to 4 rest; finite coordinates, range as for orient3d.
int sub_volume_sign(const Vec3& corner, const Vec3& next, std::span<const Vec3> others, std::span<const Vec3> rest);

/// Returns true if all 36 sub-tets of a wedge (CGNS order), or all 32 of a pyramid, are positive. This test and is_wedge_valid are independent: neither implies
/// the other, because the centroid of a strongly leaning or warped wedge lies outside the cone of one of its faces. Exact; floating point first, about 10 M
/// wedges/s/core.
bool are_sub_volumes_positive(const WedgePoints& p);
bool are_sub_volumes_positive(const std::array<Vec3, 5>& p);

}  // namespace sterna
