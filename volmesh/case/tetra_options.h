// Options of the engines that make tetrahedra (tetra/tetra.h).
#pragma once

#include <string>

#include "geom/base/schema.h"
#include "volmesh/case/mesh_step.h"

namespace sterna::volmesh {

struct TetraOptions {
  std::string engine = "automatic";
  double radius_edge = 1.2;
  bool two_pass = false;
  double hxt_improve_below = 0.0;
  double memory_limit = 20e9;
  double time_limit = k_automatic;
  double max_new_points = k_automatic;
  std::string boundary_splits = "ladder";
  bool try_other_engine = true;
  bool repair_boundary = true;
  bool fall_back_on_limits = false;
  std::string helper_folder = {};
};

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::TetraOptions> {
  using O = volmesh::TetraOptions;
  static constexpr std::string_view stage = "tetrahedra";
  static constexpr volmesh::MeshSteps steps = volmesh::k_tetrahedra_step;
  static constexpr std::array fields = {
      Field<O>{.name = "engine",
               .member = &O::engine,
               .help = "what makes the tetrahedra; automatic: sterna, our own, in the program itself, where few triangles are needles, else hxt, or tetgen "
                       "where that is not built in",
               .choices = "automatic tetgen hxt sterna"},
      Field<O>{.name = "radius_edge",
               .member = &O::radius_edge,
               .min = 1.01,
               .max = 10.0,
               .help = "largest circumradius over shortest edge of a tetrahedron (tetgen only)"},
      Field<O>{.name = "two_pass",
               .member = &O::two_pass,
               .help = "TetGen makes a coarse mesh first (radius-edge ratio 1.5), whose smoothed edge lengths are sizes for the mesh itself"},
      Field<O>{.name = "hxt_improve_below",
               .member = &O::hxt_improve_below,
               .min = 0.0,
               .max = 1.0,
               .help = "HXT improves tetrahedra of a lower quality than this (1 = regular); 0: none"},
      Field<O>{.name = "memory_limit",
               .member = &O::memory_limit,
               .unit = Unit::byte,
               .min = 1e8,
               .help = "of the engine: address space of a helper process, or our own arrays"},
      Field<O>{.name = "time_limit",
               .member = &O::time_limit,
               .unit = Unit::second,
               .min = 0.1,
               .help = "the engine is stopped after this time",
               .automatic = "of a helper 60 s of processor time and 0.1 ms for each tetrahedron that boundary and sizes ask for, seven times of what is usual; "
                            "of our own none: its work is bounded by boundary and sizes"},
      Field<O>{.name = "max_new_points",
               .member = &O::max_new_points,
               .min = 0.0,
               .max = 1e9,
               .help = "a result with more points inside the volume is a failure",
               .automatic = "no limit"},
      Field<O>{.name = "boundary_splits",
               .member = &O::boundary_splits,
               .help = "whether TetGen may split triangles on top of the layer and of the farfield; the wall's are split with them. ladder: by points on "
                       "edges that it cannot take back, and after other failures where it cannot keep them; always: also for better tetrahedra",
               .choices = "never ladder always"},
      Field<O>{
          .name = "try_other_engine", .member = &O::try_other_engine, .help = "when the engine fails in a way that it will repeat, the other one is tried"},
      Field<O>{.name = "repair_boundary",
               .member = &O::repair_boundary,
               .help = "when all that fails in a way that it will repeat, the layer is made lower and smoother around slivers, folds and gaps of its top, and "
                       "everything is tried again"},
      Field<O>{.name = "fall_back_on_limits",
               .member = &O::fall_back_on_limits,
               .help = "the other engine is tried after a time or memory limit too; such a result is marked as not reproducible"},
      Field<O>{
          .name = "helper_folder", .member = &O::helper_folder, .help = "where sterna-tet-tetgen and sterna-tet-hxt are; empty: beside the sterna executable"},
  };
};

}  // namespace sterna
