// What options and rules ask for along leading and trailing edges.
#pragma once

#include <span>
#include <string>

#include "surfmesh/model/surface_mesh.h"

namespace sterna::surfmesh {

/// What a face asks for along its leading or trailing edges; not a number: not said.
struct BandWish {
  double chordwise = k_automatic;  ///< m, first cell
  double stretch = k_automatic;    ///< longest cell along : first cell across
  double growth = 1.2;
  std::string rule;  ///< names that asked; empty: the options for all
  bool is_any() const { return !is_automatic(chordwise) || !is_automatic(stretch); }

  /// m, where one is asked for: what a stretch alone asks for comes from the longest edge.
  double first_height(double max_edge) const;
  /// m, of cells along: no longer than max_edge.
  double longest(double max_edge) const;
};

/// Of faces on both sides of an edge: the lesser, or what one of them asks for.
BandWish both(const BandWish& a, const BandWish& b);

struct BandWishes {
  BandWish leading, trailing;
};

/// Of faces (patches) with this name: rules overrule the options for all, member by member; lengths and growth are those of the family's member.
template <class Options>
BandWishes band_wishes(const std::string& name, const Options& options, std::span<const PatchSurfaceOptions> patches);

/// The same of two wishes. \param refinement of the family's member
BandWishes band_wishes(const std::string& name, BandWishes wishes, double refinement, std::span<const PatchSurfaceOptions> patches);

template <class Options>
BandWishes band_wishes(const std::string& name, const Options& options, std::span<const PatchSurfaceOptions> patches) {
  return band_wishes(name,
                     {{options.leading_edge_chordwise, options.leading_edge_stretch, options.leading_edge_growth, {}},
                      {options.trailing_edge_chordwise, options.trailing_edge_stretch, options.trailing_edge_growth, {}}},
                     options.refinement, patches);
}

}  // namespace sterna::surfmesh
