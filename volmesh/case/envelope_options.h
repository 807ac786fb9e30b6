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
               .help =
                   "number of prism layers; 0: none, tetrahedra alone; automatic: so many that cells that grow by max_growth get at least half as tall as a "
                   "regular tetrahedron on nine tenths of the walls' area",
               .automatic = "by max_growth and the edges of the walls"},
      Field<O>{.name = "first_height",
               .member = &O::first_height,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "height of the first cell at the wall; in scripts also a function of x, y, z",
               .required = true},
      Field<O>{.name = "max_growth",
               .member = &O::max_growth,
               .min = 1.0,
               .max = 3.0,
               .help = "ratio of heights of consecutive layers, the largest where they differ"},
      Field<O>{.name = "growth",
               .member = &O::growth,
               .help = "uniform: flat layers grow by max_growth on all lines, and the ratio bends to each line's total height where cells are taller than a "
                       "hundredth of their edges; local: each line grows by one ratio of its own",
               .choices = "uniform local"},
      Field<O>{.name = "total_height",
               .member = &O::total_height,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "height of all layers together; with it layers or max_growth is left out and follows",
               .automatic = "by the edges of the wall, so that the last cell is as tall as the edges of the tetrahedron above it"},
      Field<O>{.name = "solve_for",
               .member = &O::solve_for,
               .help = "which of layers and max_growth follows from total_height; where one of them is left out, it is that one",
               .choices = "none layers max_growth"},
      Field<O>{.name = "boundary_layer",
               .member = &O::boundary_layer,
               .unit = Unit::metre,
               .min = 1e-12,
               .help = "thickness of the boundary layer that the layers have to cover, but for patches with a total_height of their own: gate G12 FAILs where "
                       "they are lower; "
                       "heights do not depend on it",
               .automatic = "total_height, else that of the flow conditions that first_height is of, else none"},
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
               .help = "largest total height of the layers over the mean length of the wall's edges there",
               .automatic = "no limit"},
      Field<O>{.name = "feature_angle",
               .member = &O::feature_angle,
               .unit = Unit::radian,
               .min = 0.01,
               .max = 3.1,
               .help = "an edge that bends by more is a feature edge",
               .automatic = "20 to 60 deg, the gap in the histogram of dihedral angles"},
      Field<O>{.name = "height_gradient", .member = &O::height_gradient, .min = 0.05, .max = 2.0, .help = "largest tangential slope of the target height"},
      Field<O>{.name = "height_sweeps", .member = &O::height_sweeps, .min = 0, .max = 1000, .help = "smoothing sweeps of the heights"},
      Field<O>{.name = "direction_sweeps", .member = &O::direction_sweeps, .min = 0, .max = 1000, .help = "smoothing sweeps of the growth directions"},
      Field<O>{.name = "envelope_sweeps", .member = &O::envelope_sweeps, .min = 0, .max = 1000, .help = "smoothing sweeps of the envelope itself"},
      Field<O>{.name = "untangle_share",
               .member = &O::untangle_share,
               .min = 0.1,
               .max = 0.99,
               .help = "share of the height at which neighbouring growth lines would meet"},
      Field<O>{.name = "max_retract_sweeps",
               .member = &O::max_retract_sweeps,
               .min = 1,
               .max = 1000,
               .help = "sweeps of collision retraction before colliding places collapse"},
      Field<O>{.name = "height_floor", .member = &O::height_floor, .min = 0.5, .max = 1.0, .help = "share of the target height to which smoothing may lower"},
      Field<O>{.name = "optimiser",
               .member = &O::optimiser,
               .help = "of the whole envelope: our block descent or L-BFGS, or NLopt's MMA or CCSAQ",
               .choices = "none descent lbfgs mma ccsaq"},
      Field<O>{.name = "optimiser_evaluations",
               .member = &O::optimiser_evaluations,
               .min = 1,
               .max = 1000000,
               .help = "largest number of evaluations (sweeps) of the optimiser"},
      Field<O>{.name = "height_weight",
               .member = &O::height_weight,
               .min = 0.0,
               .max = 1000.0,
               .help = "of full height against lines normal to the wall (our optimisers)"},
      Field<O>{.name = "top_weight",
               .member = &O::top_weight,
               .min = 0.0,
               .max = 1000.0,
               .help = "of lines normal to the envelope against lines normal to the wall (our optimisers)"},
      Field<O>{.name = "membrane_weight",
               .member = &O::membrane_weight,
               .min = 0.0,
               .max = 1000.0,
               .help = "of even heights, by their slope along edges, against lines normal to the wall (our optimisers)"},
      Field<O>{.name = "barrier_weight",
               .member = &O::barrier_weight,
               .min = 1e-9,
               .max = 1000.0,
               .help = "of the barrier around invalid elements (our optimisers)"},
  };
};

}  // namespace sterna
