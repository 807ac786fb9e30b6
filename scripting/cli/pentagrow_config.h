// Configurations of pentagrow. Every key is mapped to options of sterna, so that a pipeline that writes such files only has to change one path.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geom/mesh/tri_mesh.h"
#include "volmesh/volume_mesh.h"

namespace sterna::scripting {

struct PentagrowCase {
  volmesh::MeshCase options;
  std::string input_extension;                           ///< required by InputFormat, ".stl"; empty: any
  std::vector<std::filesystem::path> outputs;            ///< hybrid.bmsh ...
  bool is_half = false;                                  ///< Symmetry
  double cut = 0.0;                                      ///< m, YPlaneCut
  double nearfield_edge = 0.0;                           ///< m; 0: no nearfield; below 0: the edge follows from the wall's edges
  double nearfield_size = 3.5;                           ///< as a multiple of half the wall's box, if there are no semi-axes
  std::vector<double> nearfield_center, nearfield_axes;  ///< x y z, or empty
  std::vector<std::string> notes;                        ///< differences from pentagrow, each a sentence with key and line
};

/// Reads "Key = value" lines: # begins a comment, vectors are separated by blanks, booleans are y, yes, true, n, no or false. Angles are in degrees, lengths in
/// the unit of the surface. Missing keys have pentagrow's defaults.
/// \throws Error(bad_argument) or Error(file_malformed) with the file's line for misspelt keys (with a suggestion), wrong values, and unsupported settings
/// (with their replacement); all problems are reported at once
PentagrowCase read_pentagrow_config(const std::string& text, const std::string& file_name);

/// Returns the region around the wall defined by Nearfield..., as a box of small tetrahedra; nothing if undefined.
std::vector<volmesh::SizeSource> nearfield_sources(const PentagrowCase& given, const TriMesh& wall);

}  // namespace sterna::scripting
