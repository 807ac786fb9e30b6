// Values on a triangulated surface, with the names for their display in pictures.
#pragma once

#include <string>
#include <vector>

namespace sterna {

/// One value per vertex or per triangle of a TriMesh; NaN for no value.
struct TriMeshField {
  std::string name;   ///< "height_share": name of the array in a file
  std::string title;  ///< "predicted height over target"
  std::string unit;   ///< "m", "deg"; empty for a ratio
  bool is_at_vertices = false;
  std::vector<float> values;
};

}  // namespace sterna
