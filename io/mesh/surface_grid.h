// Converts structured networks of points to quads. Shared by LaWGS and PLOT3D.
#pragma once

#include <cstdint>

#include "io/mesh/surface_builder.h"

namespace sterna::io {

/// Adds the quads of a network of n_lines lines with n_points points each, which were added line by line from `first_point` on. The corners of a quad follow
/// the first line forwards, then the second line backwards.
void add_network(SurfaceBuilder& builder, std::uint32_t first_point, std::size_t n_points, std::size_t n_lines);

}  // namespace sterna::io
