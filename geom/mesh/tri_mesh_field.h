// Numbers on a triangulated surface, with the names under which pictures show them.
#pragma once

#include <string>
#include <vector>

namespace sterna {

/// One number per vertex or per triangle of a TriMesh; NaN where there is none.
struct TriMeshField {
  std::string name;   ///< "height_share": of the array in a file
  std::string title;  ///< "predicted height over target"
  std::string unit;   ///< "m", "deg"; empty for a ratio
  bool is_at_vertices = false;
  std::vector<float> values;
};

}  // namespace sterna
