// Options for sliver triangles of the input wall (domain/split_slivers.h).
#pragma once

#include <numbers>

#include "geom/base/schema.h"
#include "volmesh/case/mesh_step.h"

namespace sterna::volmesh {

struct SliverOptions {
  double split_needles = 5.0 * std::numbers::pi / 180.0;
  double needle_budget = 0.0;
  double flip_angle = 1.0 * std::numbers::pi / 180.0;
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::SliverOptions> {
  using O = volmesh::SliverOptions;
  static constexpr std::string_view stage = "needles";
  static constexpr volmesh::MeshSteps steps = volmesh::k_envelope_step;
  static constexpr std::array fields = {
      Field<O>{.name = "split_needles",
               .member = &O::split_needles,
               .unit = Unit::radian,
               .min = 0.0,
               .max = 0.35,
               .help = "sliver triangles: edges of wall triangles with a smaller angle are flipped, and split if needle_budget allows, before the layers are "
                       "made; only walls with layers; 0: never"},
      Field<O>{.name = "needle_budget",
               .member = &O::needle_budget,
               .min = 0.0,
               .max = 100.0,
               .help = "largest number of triangles that splitting adds, relative to the triangles of walls with layers; 0: edges are only flipped"},
      Field<O>{.name = "flip_angle",
               .member = &O::flip_angle,
               .unit = Unit::radian,
               .min = 0.0,
               .max = 0.35,
               .help = "edges of sliver triangles may be flipped if the wall turns by less than this angle; 0: no edge is flipped, and sliver triangles stay"},
  };
};

}  // namespace sterna
