// Cuts a triangulated surface at a plane x, y or z = constant and keeps one half. The boundary edges of the half form closed loops that lie exactly in the
// plane.
#pragma once

#include <string>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

struct HalfOptions {
  std::string axis = "y";
  double at = 0.0;
  std::string keep = "+";
  double tolerance = k_automatic;
  double snap = 0.1;
};

/// Cuts a surface at a symmetry plane.
/// Vertices within the tolerance are moved into the plane, so an existing half model stays unchanged except for these vertices. Triangles across the plane
/// are cut; new vertices are shared by neighbouring triangles. Everything beyond the plane, and triangles in the plane (the flat side of a closed half
/// model), are left out. Before the cut, vertices are moved along an edge to its intersection with the plane if that is near (`snap`) and no triangle turns
/// by more than 20 degrees; this avoids slivers beside the open boundary. With snap = 0 the cut is exact. Kept vertices and triangles keep their order; new
/// vertices on the open boundary follow them. Patches that lost all triangles are left out. If the surface already ends in other planes x, y or z = constant
/// (the result is then a quarter model), it still ends exactly in these planes.
/// \pre edges with one triangle, or with two of opposite sense
/// \post every edge with one triangle has both ends exactly in the plane, or exactly in another such plane; these edges form closed loops; no other vertex is
/// in the plane
/// \throws Error(bad_argument) if the surface does not reach the plane; (open_surface) with locations if the surface has other open boundaries;
/// (non_manifold_surface) if the open boundary touches itself or the surface touches the plane beside it; (mesh_invalid) if moving vertices within the
/// tolerance would invert a triangle
/// \param is_image_expected true if the removed part should be the mirror image of the kept part: a warning reports where it is not
TriMesh half_of(const TriMesh& surface, const HalfOptions& options, const RunContext& context, bool is_image_expected = true);

/// Returns the part of all triangles on the side of the plane that half_of() keeps, cut exactly and without any repair; the reference for the result of
/// half_of(). Triangles within the tolerance of the plane are left out; cut triangles do not share vertices.
TriMesh beyond_plane(const TriMesh& surface, const HalfOptions& options);

template <>
struct Schema<HalfOptions> {
  using O = HalfOptions;
  static constexpr std::string_view stage = "half";
  static constexpr std::array fields = {
      Field<O>{.name = "axis", .member = &O::axis, .help = "the coordinate that is constant in the plane", .choices = "x y z"},
      Field<O>{.name = "at", .member = &O::at, .unit = Unit::metre, .help = "the value of this coordinate in the plane"},
      Field<O>{.name = "keep", .member = &O::keep, .help = "the side that is kept: larger (+) or smaller (-) coordinates", .choices = "+ -"},
      Field<O>{.name = "tolerance",
               .member = &O::tolerance,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "vertices closer to the plane than this are moved into the plane",
               .automatic = "1e-6 of the longest side of the surface's box"},
      Field<O>{
          .name = "snap",
          .member = &O::snap,
          .min = 0.0,
          .max = 0.4,
          .help = "vertices closer to the plane than this share of their shortest edge are moved along an edge into the plane: no slivers; 0: an exact cut"},
  };
};

}  // namespace sterna
