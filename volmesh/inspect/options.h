// Limits of the pre-flight inspection. A finding is reported if a value exceeds its limit.
#pragma once

#include <numbers>

#include "geom/base/schema.h"

namespace sterna::volmesh {

struct InspectOptions {
  double min_angle = 1.0 * std::numbers::pi / 180.0;
  double fold_angle = 1.0 * std::numbers::pi / 180.0;
  double coarse_angle = 30.0 * std::numbers::pi / 180.0;
  double size_jump = 5.0;
  double short_edge = 1e-7;
  double contact = 0.01;
  double visibility_angle = 80.0 * std::numbers::pi / 180.0;
  double lowered_area = 0.05;
  double top_ratio = 3.0;
  double wanted_y_plus = 1.0;
  double base_ratio = 20.0;
  double least_length = 1e-3;
  double largest_length = 1e3;
  int max_places = 5;
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::InspectOptions> {
  using O = volmesh::InspectOptions;
  static constexpr std::string_view stage = "inspect";
  static constexpr std::array fields = {
      Field<O>{
          .name = "min_angle", .member = &O::min_angle, .unit = Unit::radian, .min = 0.0, .max = 1.0, .help = "a triangle with a smaller angle is a sliver"},
      Field<O>{.name = "fold_angle",
               .member = &O::fold_angle,
               .unit = Unit::radian,
               .min = 0.0,
               .max = 1.5,
               .help = "two neighbouring triangles with a smaller angle between them are folded onto each other"},
      Field<O>{.name = "coarse_angle",
               .member = &O::coarse_angle,
               .unit = Unit::radian,
               .min = 0.01,
               .max = 3.1,
               .help = "a smooth surface (below the feature angle) that turns by more at an edge is too coarse for its curvature"},
      Field<O>{
          .name = "size_jump", .member = &O::size_jump, .min = 1.5, .max = 1e6, .help = "largest ratio of the mean edge lengths of two neighbouring triangles"},
      Field<O>{.name = "short_edge", .member = &O::short_edge, .min = 0.0, .max = 0.1, .help = "shortest permitted edge, relative to the body length"},
      Field<O>{.name = "contact",
               .member = &O::contact,
               .min = 0.0,
               .max = 0.5,
               .help = "smallest distance between a vertex and an opposite wall, in edge lengths at the vertex; a closer vertex nearly touches the wall"},
      Field<O>{.name = "visibility_angle",
               .member = &O::visibility_angle,
               .unit = Unit::radian,
               .min = 0.1,
               .max = 1.57,
               .help = "largest angle between the best growth direction at a vertex and the normals of its facets; beyond 90 degrees there is no layer"},
      Field<O>{.name = "lowered_area",
               .member = &O::lowered_area,
               .min = 0.0,
               .max = 1.0,
               .help = "share of the wall area on which the layer may be lower than 0.9 of its target without a warning"},
      Field<O>{.name = "top_ratio",
               .member = &O::top_ratio,
               .min = 1.1,
               .max = 1000.0,
               .help = "largest height ratio (or inverse ratio) of the last layer and the tetrahedra above it (0.816 edge lengths)"},
      Field<O>{
          .name = "wanted_y_plus", .member = &O::wanted_y_plus, .min = 1e-3, .max = 1e4, .help = "target y+ of the first height; checked if the flow is given"},
      Field<O>{.name = "base_ratio",
               .member = &O::base_ratio,
               .min = 1.0,
               .max = 1e6,
               .help = "largest ratio of the layer height to the thickness of a blunt base below the layer"},
      Field<O>{
          .name = "least_length", .member = &O::least_length, .unit = Unit::metre, .min = 0.0, .help = "a shorter body is reported as a probable unit mistake"},
      Field<O>{.name = "largest_length",
               .member = &O::largest_length,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "a longer body is reported as a probable unit mistake"},
      Field<O>{.name = "max_places",
               .member = &O::max_places,
               .min = 0,
               .max = 100000,
               .help = "largest number of locations listed for each finding, the worst first"},
  };
};

}  // namespace sterna
