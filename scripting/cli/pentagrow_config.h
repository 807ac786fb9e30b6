// Configurations of pentagrow: every key of theirs as options of ours, so that a pipeline that writes them switches by changing one path.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "geom/mesh/tri_mesh.h"
#include "volmesh/volume_mesh.h"

namespace sterna::scripting {

struct PentagrowCase {
  volmesh::MeshCase options;
  std::string input_extension;                           ///< that InputFormat asks for, ".stl"; empty: any
  std::vector<std::filesystem::path> outputs;            ///< hybrid.bmsh ...
  bool is_half = false;                                  ///< Symmetry
  double cut = 0.0;                                      ///< m, YPlaneCut
  double nearfield_edge = 0.0;                           ///< m; 0: none, below 0: by the wall's edges
  double nearfield_size = 3.5;                           ///< of half the wall's box, where there are no semi-axes
  std::vector<double> nearfield_center, nearfield_axes;  ///< x y z, or empty
  std::vector<std::string> notes;                        ///< what works differently here, each a sentence with key and line
};

/// Reads "Key = value" lines (# comments, vectors blank-separated, booleans y yes true n no false). Angles in degrees, lengths in those of the surface. Keys
/// that are not there keep pentagrow's defaults.
/// \throws Error(file_malformed, bad_argument) that names the file's line: misspelt keys with a suggestion, wrong values, what cannot be done and what to use
/// instead; all problems at once
PentagrowCase read_pentagrow_config(const std::string& text, const std::string& file_name);

/// The region around the wall that Nearfield... asks for, as a box of small tetrahedra; nothing without.
std::vector<volmesh::SizeSource> nearfield_sources(const PentagrowCase& given, const TriMesh& wall);

}  // namespace sterna::scripting
