#include "surfmesh/stitch/working_surface.h"

#include <cstdio>

namespace sterna::surfmesh {

Box WorkingSurface::box() const {
  Box box;
  for (const Facet& facet : facets)
    for (const std::uint32_t v : facet) box.add(points[v]);
  return box;
}

void WorkingSurface::keep(const std::vector<char>& is_kept) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    if (!is_kept[i]) continue;
    facets[n] = facets[i];
    patch[n] = patch[i];
    origin[n] = origin[i];
    ++n;
  }
  facets.resize(n);
  patch.resize(n);
  origin.resize(n);
}

std::string count_of(std::int64_t n, const std::string& one, const std::string& many) { return std::to_string(n) + " " + (n == 1 ? one : many); }

std::string short_number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", value);
  return buffer;
}

}  // namespace sterna::surfmesh
