// The sign of a dual sub-volume: the tet of a cell's corner, an edge's midpoint, a face's centroid and the cell's centroid (means of their nodes).
#pragma once

#include <span>

#include "geom/base/vec3.h"

namespace sterna {

/// Sign of the volume of (corner, midpoint of corner-next, centroid of the face, centroid of the cell) for a face that runs corner, next, others..., its
/// right-hand normal out of the cell; `rest` are the cell's nodes off the face. The sub-tet at `next` has the same volume. Only the node sums count:
/// 48 V = -det(next, sum of others, sum of rest) relative to the corner, times positive factors. Exact: floating point with a forward error bound,
/// undecided cases by expansions. \pre 1 or 2 others, 1 to 4 rest; finite coordinates, range as for orient3d.
int sub_volume_sign(const Vec3& corner, const Vec3& next, std::span<const Vec3> others, std::span<const Vec3> rest);

}  // namespace sterna
