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
  TriMesh mesh;                     ///< the facets of one edge-connected part are consistently oriented; no other requirement
  std::vector<std::uint32_t> part;  ///< per facet
  std::uint32_t n_parts = 0;
  std::vector<std::array<char, 3>> is_border;  ///< per facet and side: no other facet there
  std::vector<std::array<Vec3, 2>> lines;      ///< sharp edges and patch borders
  std::vector<char> is_border_of_patches;      ///< per line: not sharp
  std::vector<Vec3> corners;                   ///< where lines end, meet or bend
  double length = 0.0;                         ///< m, longest side of the box
  double area = 0.0;                           ///< m^2
  std::string half_axis;                       ///< the mesh holds both halves
  double half_at = 0.0;
  bool is_half_above = true;  ///< side of the given half
  double half_moved = 0.0;
};

/// \throws Error as wrap_surface
WrapInput read_wrap_input(const std::vector<SurfaceSoup>& soups, const WrapOptions& options, WrapReport& report, const RunContext& context);

/// Recognises a half model and mirrors it. `gap` (m): models with openings up to this size are not halves.
void mirror_half(WrapInput& input, double gap, WrapReport& report, const RunContext& context);

/// Fills borders, lines and corners from the mesh. `angle`, rad.
void find_lines(WrapInput& input, double angle);

/// Orients the parts so that their normals agree with the surface around them; parts for which that is not decisive are oriented by their volume.
void turn_parts(WrapInput& input, const TriMesh& around, double reach, const RunContext& context);

/// Formats a number: 1e-6 m -> "1e-06"
std::string wrap_number(double value);

}  // namespace sterna::surfmesh
