// Outer boundary: an icosahedral sphere around the body.
#pragma once

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

struct FarfieldOptions {
  double farfield_radius = k_automatic;
  double farfield_edge = k_automatic;
};

/// Icosahedral sphere (20 * f^2 triangles, f chosen from the edge length) about the centre of the wall's box; one patch "farfield"; normals INTO the fluid.
/// Default: 500 triangles at 50 body lengths; the tetrahedra grow towards them geometrically, so that the farfield costs a few thousand.
/// \throws Error(bad_argument) when the sphere does not enclose the wall with a margin of a quarter of the body length, or would have more than
/// 20 million triangles; Error(empty_surface) for a wall without triangles.
TriMesh farfield_sphere(const TriMesh& wall, const FarfieldOptions& options, const RunContext& context);

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::FarfieldOptions> {
  using O = volmesh::FarfieldOptions;
  static constexpr std::string_view stage = "farfield";
  static constexpr std::array fields = {
      Field<O>{.name = "farfield_radius", .member = &O::farfield_radius, .unit = Unit::metre, .min = 1e-9, .help = "radius of the sphere about the centre of the wall's box", .automatic = "50 body lengths"},
      Field<O>{.name = "farfield_edge", .member = &O::farfield_edge, .unit = Unit::metre, .min = 1e-9, .help = "edge length of the sphere's triangles", .automatic = "about a fifth of the radius"},
  };
};

}  // namespace sterna
