// Structured networks of points as quads: what LaWGS and PLOT3D share.
#pragma once

#include <cstdint>

#include "io/mesh/surface_builder.h"

namespace sterna::io {

/// Quads of a network of n_lines lines of n_points points each, which were added line by line from `first_point` on. A quad runs along its first line, then
/// back on the next.
void add_network(SurfaceBuilder& builder, std::uint32_t first_point, std::size_t n_points, std::size_t n_lines);

}  // namespace sterna::io
