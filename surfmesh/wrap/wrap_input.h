// Private to surfmesh/wrap: the soups as one welded set of facets in metres, with its borders, sharp edges and half plane.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "geom/mesh/bvh.h"
#include "surfmesh/wrap/wrap_surface.h"

namespace sterna::surfmesh {

struct WrapInput {
  TriMesh mesh;                     ///< the facets of each edge-connected part are oriented consistently; there are no other requirements
  std::vector<std::uint32_t> part;  ///< part of each facet
  std::uint32_t n_parts = 0;
  std::vector<std::array<char, 3>> is_border;  ///< for each facet and side: true if no other facet is there
  std::vector<std::array<Vec3, 2>> lines;      ///< sharp edges and patch borders
  std::vector<char> is_border_of_patches;      ///< for each line: true if it is a patch border that is not sharp
  std::vector<Vec3> corners;                   ///< points where lines end, meet or bend
  double length = 0.0;                         ///< m, longest side of the box
  double area = 0.0;                           ///< m^2
  std::string half_axis;                       ///< axis of a half model; the mesh then contains both halves
  double half_at = 0.0;
  bool is_half_above = true;  ///< the given half is on the side of larger coordinates
  double half_moved = 0.0;
};

/// \throws Error like wrap_surface
WrapInput read_wrap_input(const std::vector<SurfaceSoup>& soups, const WrapOptions& options, WrapReport& report, const RunContext& context);

/// Recognises a half model and mirrors it. \p gap m: a surface whose openings are no larger than this is no half model
void mirror_half(WrapInput& input, double gap, WrapReport& report, const RunContext& context);

/// Finds borders, lines and corners of the mesh. \p angle rad
void find_lines(WrapInput& input, double angle);

/// Orients the parts so that their normals agree with the surface around them. Parts for which this comparison is not conclusive are oriented by their volume.
void turn_parts(WrapInput& input, const TriMesh& around, double reach, const RunContext& context);

/// Formats a number for messages, such as 1e-6 as "1e-06".
std::string wrap_number(double value);

}  // namespace sterna::surfmesh
