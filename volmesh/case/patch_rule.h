// Patch rules: settings that replace the options for all walls on patches whose names match. This file defines the options only;
// volmesh/envelope/patch_layers.h applies them.
#pragma once

#include <string>

#include "geom/base/schema.h"

namespace sterna::volmesh {

struct PatchRule {
  static constexpr int k_as_all = -1;
  std::string names;  ///< pattern for names, such as "tunnel*"
  std::string kind = "as_read";
  int layers = k_as_all;
  double first_height = k_automatic;
  double max_growth = k_automatic;
  double total_height = k_automatic;
  double max_thickness = k_automatic;
  double blend = k_automatic;
  std::string open_ridges = "as_all";
  std::string truncate = "as_all";
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::PatchRule> {
  using O = volmesh::PatchRule;
  static constexpr std::string_view stage = "patches";
  static constexpr std::string_view as_all = "value for all walls";
  static constexpr std::array fields = {
      Field<O>{.name = "names", .member = &O::names, .help = "pattern of the names of patches"},
      Field<O>{.name = "kind",
               .member = &O::kind,
               .help = "kind of these patches; only walls carry layers",
               .choices = "as_read wall slip symmetry inflow outflow farfield interface"},
      Field<O>{.name = "layers",
               .member = &O::layers,
               .min = -1,
               .max = 1000,
               .help = "number of prism layers; connected walls get the largest requested number; 0: none; -1: value for all walls"},
      Field<O>{.name = "first_height",
               .member = &O::first_height,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "height of the first cell at the wall",
               .automatic = as_all},
      Field<O>{.name = "max_growth",
               .member = &O::max_growth,
               .min = 1.0,
               .max = 3.0,
               .help = "largest ratio of heights of consecutive layers",
               .automatic = as_all},
      Field<O>{.name = "total_height",
               .member = &O::total_height,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "total height of the layers; max_growth follows, or layers if max_growth is given here",
               .automatic = as_all},
      Field<O>{.name = "max_thickness",
               .member = &O::max_thickness,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "largest total height of the layers",
               .automatic = as_all},
      Field<O>{.name = "blend",
               .member = &O::blend,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "blending distance from walls with other layer settings",
               .automatic = "3 times the height of the taller layer, at least 8 edges"},
      Field<O>{.name = "open_ridges",
               .member = &O::open_ridges,
               .help = "whether layers get several normals along sharp convex edges between such patches; as_all: value of the ridges options",
               .choices = "as_all never always"},
      Field<O>{.name = "truncate",
               .member = &O::truncate,
               .help = "whether growth lines below full height get fewer layers; as_all: value of the prisms options",
               .choices = "as_all never auto always"},
  };
};

}  // namespace sterna
