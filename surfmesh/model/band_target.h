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

/// Returns the requirements of faces (patches) with this name. Rules override the options for all, member by member. Lengths and growth are those of the
/// current member of the refinement family.
template <class Options>
BandTargets band_targets(const std::string& name, const Options& options, std::span<const Rule> patches);

/// Names the rules that set given requirements, and makes them those of the current member. \param refinement refinement factor of the current member
BandTargets band_targets(const std::string& name, BandTargets targets, double refinement, std::span<const Rule> patches);

template <class Options>
BandTargets band_targets(const std::string& name, const Options& options, std::span<const Rule> patches) {
  const Options own = resolve(options, patches, name);
  return band_targets(name,
                      {{own.leading_edge_chordwise, own.leading_edge_stretch, own.leading_edge_growth, {}},
                       {own.trailing_edge_chordwise, own.trailing_edge_stretch, own.trailing_edge_growth, {}}},
                      own.refinement, patches);
}

}  // namespace sterna::surfmesh
