// Triangles as read from a file: unwelded, unoriented, possibly with unused vertices; with the patch names of the file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geom/base/vec3.h"

namespace sterna {

struct SurfaceSoup {
  std::vector<Vec3> points;                             ///< in the unit of the file
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into points
  std::vector<std::uint32_t> patch;                     ///< per triangle, index into patch_names; same size as triangles
  std::vector<std::string> patch_names;                 ///< not empty if there are triangles; names may be empty strings
  bool single_precision = false;                        ///< the coordinates were stored as 32-bit floats (binary STL, float PLY, ...)
  bool has_names = false;                               ///< the file itself named (or numbered) its patches
  std::uint64_t n_cells = 0;  ///< number of cells of the volume mesh in the file if the soup is its boundary; 0 if the file holds a surface
  std::string source;         ///< file name for messages
};

}  // namespace sterna
