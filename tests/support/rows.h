// Rows: bodies that pass through both sides of a duct, for periodic sides.
#pragma once

#include <span>
#include <string>

#include "geom/model/model.h"

namespace sterna::test {

/// Returns a duct of 4 x 1 x 2 m around the x axis, starting at x = -1.
Model duct();

/// Returns the fluid in the duct around the bodies. \p kind: patch kind of the duct's side walls
Model through_duct(std::span<const Model> bodies, PatchKind kind = PatchKind::wall);

/// Returns a wing of constant section across the duct: chord 0.8 m, cut off at both ends, trailing edge of the given thickness (m; 0: sharp), twist in rad.
Model blade(double trailing_edge, const std::string& naca_digits, double twist);

}  // namespace sterna::test
