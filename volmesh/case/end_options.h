// Options for the triangulation of adjacent patches, on which layers end (adjacent/adjacent_surface.h).
#pragma once

#include <numbers>

#include "geom/base/schema.h"
#include "volmesh/case/mesh_step.h"

namespace sterna::volmesh {

struct EndOptions {
  double size_growth = 1.3;                            ///< largest ratio of the edges of neighbouring triangles away from the loops
  double min_angle = 25.0 * std::numbers::pi / 180.0;  ///< rad: target for the smallest angle; smaller angles remain where the loops force them
  int max_triangles = 20'000'000;
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::EndOptions> {
  using O = volmesh::EndOptions;
  static constexpr std::string_view stage = "ends";
  static constexpr volmesh::MeshSteps steps = volmesh::k_tetrahedra_step;
  static constexpr std::array fields = {
      Field<O>{.name = "ends_growth",
               .member = &O::size_growth,
               .min = 1.02,
               .max = 2.0,
               .help = "edge length ratio of neighbouring triangles on adjacent patches (where layers end), with distance from the layers"},
      Field<O>{.name = "ends_min_angle",
               .member = &O::min_angle,
               .unit = Unit::radian,
               .min = 0.0,
               .max = 0.55,
               .help = "target of the smallest angle of triangles on adjacent patches"},
      Field<O>{.name = "ends_max_triangles",
               .member = &O::max_triangles,
               .min = 1,
               .max = 1e9,
               .help = "largest number of triangles of one adjacent patch; more triangles are an error"},
  };
};

}  // namespace sterna
