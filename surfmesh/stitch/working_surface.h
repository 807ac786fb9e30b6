// Private to surfmesh/stitch: the surface during repair. It uses plain indices. Coordinates are in the file's unit until they are scaled.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geom/base/vec3.h"
#include "geom/mesh/surface_soup.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::surfmesh {

using Facet = std::array<std::uint32_t, 3>;

/// Origin of a facet, used in messages.
struct FacetOrigin {
  std::uint32_t soup = 0;
  std::uint32_t facet = 0;
};

struct WorkingSurface {
  std::vector<Vec3> points;
  std::vector<Facet> facets;
  std::vector<std::uint32_t> patch;        ///< for each facet: first_patch[soup] + patch number within the soup
  std::vector<FacetOrigin> origin;         ///< origin of each facet
  std::vector<std::uint32_t> first_patch;  ///< first patch number of each soup, and the total number at the end
  double to_metres = 1.0;                  ///< metres per unit of `points`
  bool is_single_precision = false;        ///< true if any file stores 32-bit floats
  std::vector<std::string> sources;        ///< file name of each soup

  std::size_t n_facets() const { return facets.size(); }
  /// Returns the box of the used vertices.
  Box box() const;
  Vec3 metres(const Vec3& p) const { return to_metres * p; }
  std::array<Vec3, 3> corners(std::size_t facet) const { return {points[facets[facet][0]], points[facets[facet][1]], points[facets[facet][2]]}; }
  /// Keeps the facets whose flag is set, in their order.
  void keep(const std::vector<char>& is_kept);
};

/// Formats a count, such as "3 facets" or "1 facet".
std::string count_of(std::int64_t n, const std::string& one, const std::string& many);
/// Formats lengths for messages with 4 significant digits.
std::string short_number(double value);

}  // namespace sterna::surfmesh
