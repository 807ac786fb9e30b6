// The half of a triangulated surface on one side of a plane x, y or z = constant: its rim closed, and in the plane to the bit.
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

/// Vertices within the tolerance are moved into the plane, so that a half model stays as it is but for them; triangles across it are cut, new vertices are
/// shared by their neighbours; what is beyond it, and triangles in it (the flat side of a closed half model), are left out. Before the cut, vertices are moved
/// along an edge to where it meets the plane when that is near (`snap`) and no triangle turns by more than 20 degrees: there are no slivers beside the rim.
/// With snap = 0 the cut is exact. Kept vertices and triangles keep their order, the rim's new vertices follow them; patches that lost all triangles are left
/// out.
/// \pre edges with one triangle or two with opposite sense A surface that ends in other planes x, y or z = constant, as the half of which this is the quarter,
/// ends in them still, to the bit.
/// \post every edge with one triangle has both ends in the plane, exactly, or in such another one; such edges form closed loops; no other vertex is in the
/// plane
/// \throws Error(bad_argument) when the surface does not reach the plane; (open_surface) with places when it has rims elsewhere; (non_manifold_surface) where
/// the rim touches itself or the surface touches the plane beside it; (mesh_invalid) when moving vertices within the tolerance would turn a triangle over
/// \param is_image_expected whether what is left out should be the image of what is kept: a warning says where it is not
TriMesh half_of(const TriMesh& surface, const HalfOptions& options, const RunContext& context, bool is_image_expected = true);

/// The part of all triangles on the side of the plane that half_of keeps, cut exactly and without any repair: what half_of's result is compared with. Triangles
/// within the tolerance of the plane are left out; cut triangles have vertices of their own.
TriMesh beyond_plane(const TriMesh& surface, const HalfOptions& options);

template <>
struct Schema<HalfOptions> {
  using O = HalfOptions;
  static constexpr std::string_view stage = "half";
  static constexpr std::array fields = {
      Field<O>{.name = "axis", .member = &O::axis, .help = "the coordinate that is constant in the plane", .choices = "x y z"},
      Field<O>{.name = "at", .member = &O::at, .unit = Unit::metre, .help = "the value of this coordinate in the plane"},
      Field<O>{.name = "keep", .member = &O::keep, .help = "the side that is kept: of larger (+) or smaller (-) coordinates", .choices = "+ -"},
      Field<O>{.name = "tolerance",
               .member = &O::tolerance,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "vertices this near to the plane are moved into it",
               .automatic = "1e-6 of the longest side of the surface's box"},
      Field<O>{.name = "snap",
               .member = &O::snap,
               .min = 0.0,
               .max = 0.4,
               .help = "vertices this near to the plane, as a share of their shortest edge, are moved along an edge into it: no slivers; 0: an exact cut"},
  };
};

}  // namespace sterna
