#include "io/mesh/surface_grid.h"

#include <array>

namespace sterna::io {

void add_network(SurfaceBuilder& builder, std::uint32_t first_point, std::size_t n_points, std::size_t n_lines) {
  for (std::size_t line = 0; line + 1 < n_lines; ++line) {
    for (std::size_t i = 0; i + 1 < n_points; ++i) {
      const auto corner = [&](std::size_t l, std::size_t k) { return static_cast<std::uint32_t>(first_point + l * n_points + k); };
      builder.add_polygon(std::array{corner(line, i), corner(line, i + 1), corner(line + 1, i + 1), corner(line + 1, i)});
    }
  }
}

}  // namespace sterna::io
