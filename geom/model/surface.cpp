#include "geom/model/surface.h"

namespace sterna {

void Surface::points(std::span<const Uv> at, std::span<Point> points) const {
  for (std::size_t i = 0; i < at.size(); ++i) points[i] = point(at[i]);
}

}  // namespace sterna
