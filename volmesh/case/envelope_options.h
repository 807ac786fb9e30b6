// Options of the envelope: user requirements for the prismatic layer.
#pragma once

#include <string>

#include "geom/base/schema.h"
#include "volmesh/case/mesh_step.h"

namespace sterna::volmesh {

struct EnvelopeOptions {
  int layers = k_automatic_count;
  double first_height = k_automatic;
  double max_growth = 1.25;
  std::string growth = "uniform";
  double total_height = k_automatic;
  std::string solve_for = "none";
  double boundary_layer = k_automatic;
  double max_thickness = k_automatic;
  double max_relative_height = k_automatic;
  double feature_angle = k_automatic;
  double height_gradient = 0.35;
  int height_sweeps = 20;
  int direction_sweeps = 50;
  int envelope_sweeps = 5;
  double untangle_share = 0.7;
  int max_retract_sweeps = 40;
  double height_floor = 0.938;
  std::string optimiser = "descent";
  int optimiser_evaluations = 30;
  double height_weight = 1.0;
  double top_weight = 0.4;
  double membrane_weight = 1.0;
  double barrier_weight = 0.02;
};

/// Returns true if flat cells grow by the same ratio on all growth lines (growth_law.h).
inline bool has_common_growth(const EnvelopeOptions& options) { return options.growth == "uniform"; }

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::EnvelopeOptions> {
  using O = volmesh::EnvelopeOptions;
  static constexpr std::string_view stage = "envelope";
  static constexpr volmesh::MeshSteps steps = volmesh::k_envelope_step;
  static constexpr std::array fields = {
      Field<O>{.name = "layers",
               .member = &O::layers,
               .min = 0,
               .max = 1000,
               .help = "number of prism layers; 0: no layers, tetrahedra only; automatic: with growth max_growth, as many layers as are "
                       "needed so that on nine tenths of the wall area the last cell is at least half as high as a regular tetrahedron",
               .automatic = "from max_growth and the edge lengths of the walls"},
      Field<O>{.name = "first_height",
               .member = &O::first_height,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "height of the first cell at the wall; in scripts also a function of x, y, z",
               .required = true},
      Field<O>{.name = "max_growth", .member = &O::max_growth, .min = 1.0, .max = 3.0, .help = "largest height ratio of consecutive layers"},
      Field<O>{.name = "growth",
               .member = &O::growth,
               .help = "uniform: flat cells grow by max_growth on all growth lines; where cells are taller than a hundredth of their edges, the ratio adapts "
                       "to the total height of the line; local: each growth line has its own constant ratio",
               .choices = "uniform local"},
      Field<O>{.name = "total_height",
               .member = &O::total_height,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "total height of the layers; give it with layers or with max_growth: the other option follows",
               .automatic = "from the edge lengths of the wall: the last cell is as tall as the edges of the tetrahedron above it"},
      Field<O>{.name = "solve_for",
               .member = &O::solve_for,
               .help = "option that follows from total_height: layers or max_growth; if one of the two is not given, this one follows",
               .choices = "none layers max_growth"},
      Field<O>{.name = "boundary_layer",
               .member = &O::boundary_layer,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "thickness of the boundary layer that the layers must cover, except on patches with their own total_height: gate G12 FAILs where the "
                       "layers are lower; layer heights do not depend on this value",
               .automatic = "total_height; else the boundary layer thickness of the flow conditions from which first_height was computed; else none"},
      Field<O>{.name = "max_thickness",
               .member = &O::max_thickness,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "largest total height of the layers",
               .automatic = "0.1 body lengths, or total_height"},
      Field<O>{.name = "max_relative_height",
               .member = &O::max_relative_height,
               .min = 0.01,
               .max = 1e6,
               .help = "largest ratio of the total layer height to the local mean edge length of the wall",
               .automatic = "no limit"},
      Field<O>{.name = "feature_angle",
               .member = &O::feature_angle,
               .unit = Unit::radian,
               .min = 0.01,
               .max = 3.1,
               .help = "an edge at which the wall turns by more than this angle is a feature edge",
               .automatic = "20 to 60 deg, the gap in the histogram of dihedral angles"},
      Field<O>{.name = "height_gradient", .member = &O::height_gradient, .min = 0.05, .max = 2.0, .help = "largest tangential slope of the target height"},
      Field<O>{.name = "height_sweeps", .member = &O::height_sweeps, .min = 0, .max = 1000, .help = "smoothing sweeps of the heights"},
      Field<O>{.name = "direction_sweeps", .member = &O::direction_sweeps, .min = 0, .max = 1000, .help = "smoothing sweeps of the growth directions"},
      Field<O>{.name = "envelope_sweeps", .member = &O::envelope_sweeps, .min = 0, .max = 1000, .help = "smoothing sweeps of the envelope itself"},
      Field<O>{.name = "untangle_share",
               .member = &O::untangle_share,
               .min = 0.1,
               .max = 0.99,
               .help = "largest layer height, as a share of the height at which neighbouring growth lines would meet"},
      Field<O>{.name = "max_retract_sweeps",
               .member = &O::max_retract_sweeps,
               .min = 1,
               .max = 1000,
               .help = "largest number of retraction sweeps at collisions; after them, colliding layers are collapsed"},
      Field<O>{.name = "height_floor",
               .member = &O::height_floor,
               .min = 0.5,
               .max = 1.0,
               .help = "lowest height that smoothing may produce, as a share of the target height"},
      Field<O>{.name = "optimiser",
               .member = &O::optimiser,
               .help = "global optimiser of the envelope: block descent (built in), MMA or CCSAQ (NLopt)",
               .choices = "none descent mma ccsaq"},
      Field<O>{.name = "optimiser_evaluations",
               .member = &O::optimiser_evaluations,
               .min = 1,
               .max = 1000000,
               .help = "largest number of evaluations (sweeps) of the optimiser"},
      Field<O>{.name = "height_weight",
               .member = &O::height_weight,
               .min = 0.0,
               .max = 1000.0,
               .help = "weight of full layer height relative to wall-normal growth lines (descent)"},
      Field<O>{.name = "top_weight",
               .member = &O::top_weight,
               .min = 0.0,
               .max = 1000.0,
               .help = "weight of envelope-normal growth lines relative to wall-normal growth lines (descent)"},
      Field<O>{.name = "membrane_weight",
               .member = &O::membrane_weight,
               .min = 0.0,
               .max = 1000.0,
               .help = "weight of even heights (small slope along edges) relative to wall-normal growth lines (descent)"},
      Field<O>{.name = "barrier_weight",
               .member = &O::barrier_weight,
               .min = 1e-9,
               .max = 1000.0,
               .help = "weight of the barrier that keeps elements valid (descent)"},
  };
};

}  // namespace sterna
