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
               .help = "engine that makes the tetrahedra; automatic: sterna (built in) if few boundary triangles are slivers, else hxt, or tetgen if hxt is "
                       "not available",
               .choices = "automatic tetgen hxt sterna"},
      Field<O>{.name = "radius_edge",
               .member = &O::radius_edge,
               .min = 1.01,
               .max = 10.0,
               .help = "largest ratio of circumradius to shortest edge of a tetrahedron (tetgen only)"},
      Field<O>{.name = "two_pass",
               .member = &O::two_pass,
               .help = "TetGen first makes a coarse mesh (radius-edge ratio 1.5); its smoothed edge lengths are the target sizes of the final mesh"},
      Field<O>{.name = "hxt_improve_below",
               .member = &O::hxt_improve_below,
               .min = 0.0,
               .max = 1.0,
               .help = "HXT improves tetrahedra below this quality (1 = regular); 0: none"},
      Field<O>{.name = "memory_limit",
               .member = &O::memory_limit,
               .unit = Unit::byte,
               .min = 1e8,
               .help = "memory limit of the engine: address space of a helper process, or arrays of the built-in engine"},
      Field<O>{
          .name = "time_limit",
          .member = &O::time_limit,
          .unit = Unit::second,
          .min = 0.1,
          .help = "time after which the engine is stopped",
          .automatic =
              "helper process: 60 s of processor time plus 0.1 ms for each expected tetrahedron, about seven times the usual time; built-in engine: no limit"},
      Field<O>{.name = "max_new_points",
               .member = &O::max_new_points,
               .min = 0.0,
               .max = 1e9,
               .help = "largest number of new points inside the volume; more points are a failure of the engine",
               .automatic = "no limit"},
      Field<O>{.name = "boundary_splits",
               .member = &O::boundary_splits,
               .help =
                   "whether TetGen may split triangles on top of the layer and of the farfield; wall triangles are split with them. ladder: only where TetGen "
                   "cannot remove points on edges again, and, after failures of the engines, where TetGen cannot keep the triangles; always: also for better "
                   "tetrahedra",
               .choices = "never ladder always"},
      Field<O>{.name = "try_other_engine", .member = &O::try_other_engine, .help = "after a reproducible failure of the engine, another engine is tried"},
      Field<O>{.name = "repair_boundary",
               .member = &O::repair_boundary,
               .help = "after reproducible failures of all engines, the layer is lowered and smoothed around slivers, folds and gaps of its top, and the "
                       "engines are tried again"},
      Field<O>{.name = "fall_back_on_limits",
               .member = &O::fall_back_on_limits,
               .help = "another engine is also tried after a time or memory limit; such a result is marked as not reproducible"},
      Field<O>{.name = "helper_folder",
               .member = &O::helper_folder,
               .help = "folder of sterna-tet-tetgen and sterna-tet-hxt; empty: the folder of the sterna executable"},
  };
};

}  // namespace sterna
