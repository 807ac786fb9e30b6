// Requirements of options and rules along leading and trailing edges.
#pragma once

#include <span>
#include <string>

#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// Requirements of a face along its leading or trailing edges. NaN: not given.
struct BandTarget {
  double chordwise = k_automatic;  ///< m, height of the first cell
  double stretch = k_automatic;    ///< ratio of the longest cell size along the edge to the first cell size across it
  double growth = 1.2;
  std::string rule;  ///< names of the rules that set the values; empty: the values come from the options for all faces
  bool is_any() const { return !is_automatic(chordwise) || !is_automatic(stretch); }

  /// Returns the first cell height in metres. If only a stretch is given, the height follows from the longest edge.
  double first_height(double max_edge) const;
  /// Returns the longest cell size along the edge in metres: not longer than max_edge.
  double longest(double max_edge) const;
};

/// Combines the requirements of the faces on both sides of an edge: the smaller value, or the only one given.
BandTarget both(const BandTarget& a, const BandTarget& b);

struct BandTargets {
  BandTarget leading, trailing;
};

/// Returns the requirements of a face (patch) with this name. Lengths and growth are those of the current member of the refinement family.
/// \param of_patch size options of the patch (resolve()) \param patches rules, one of which may have set its rows
BandTargets band_targets(const std::string& name, const SurfaceSizeOptions& of_patch, std::span<const Rule> patches);

}  // namespace sterna::surfmesh
