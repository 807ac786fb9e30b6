// Estimates of a turbulent flat-plate boundary layer for meshing: the first height for a target y+, and the thickness that the layers have to cover.
#pragma once

#include <string>

#include "geom/base/schema.h"
#include "volmesh/flow/flow_state.h"

namespace sterna::volmesh {

struct FirstHeightOptions {
  double y_plus = k_automatic;
  std::string at = "node";
  std::string law = "schlichting";
};

struct ThicknessOptions {
  double factor = 1.0;
  std::string thickness_law = "fifth_root";
};

/// Returns the skin friction coefficient tau_w / (rho U^2 / 2) of a turbulent flat plate in incompressible flow at this Reynolds number. The laws are:
///   schlichting          local, (2 lg Re - 0.65)^-2.3, Re up to 1e9 [H. Schlichting, Boundary-Layer Theory, 7th ed., ch. XXI]
///   seventh_root         local, 0.026 Re^(-1/7) [F. M. White, Viscous Fluid Flow, from the 1/7 power law of the velocity]
///   kays_crawford        local, 0.0574 Re^-0.2 (cf/2 = 0.0287 Re^-0.2), 5e5 .. 1e7 [W. M. Kays, M. E. Crawford, Convective Heat and Mass Transfer]
///   prandtl              local, 0.0592 Re^-0.2, 5e5 .. 1e7 [L. Prandtl; Schlichting, ch. XXI]
///   prandtl_schlichting  mean of the plate, 0.455 (lg Re)^-2.58, up to 1e9 [Schlichting, ch. XXI]
///   ittc57               mean with a form allowance, 0.075 (lg Re - 2)^-2, the ship-model correlation line of 1957 [8th ITTC, Madrid 1957]
/// The first two laws agree with the spacings of the DPW-4 gridding guidelines within 2 %.
/// \throws Error(bad_argument) for another name, and for Reynolds numbers below k_least_reynolds or above k_largest_reynolds, for which none of the formulas is
/// valid
double skin_friction(const std::string& law, double reynolds);
inline constexpr double k_least_reynolds = 1e4;
inline constexpr double k_largest_reynolds = 1e11;

struct FirstHeight {
  double height = 0.0;  ///< m: value for first_height
  double y_plus = 0.0;
  double wall_distance = 0.0;  ///< m, distance at which y+ has the target value: the first node, or half the height of the first cell
  double skin_friction = 0.0;
  double friction_velocity = k_automatic;  ///< m/s; automatic if the speed is not known
  FirstHeightOptions options;
  FlowState flow;
};
/// Returns the first height for a target y+: y = y+ nu / u_tau with u_tau = U sqrt(cf/2), so y = y+ (L/Re) / sqrt(cf/2). These are free-stream values: at an
/// adiabatic wall in compressible flow they give a y+ a little below the target. Cell-centred solvers measure y+ at the middle of the first cell, node-centred
/// solvers at its upper nodes.
/// \throws the errors of skin_friction
FirstHeight first_height(const FirstHeightOptions& options, const FlowState& flow);

/// Returns the thickness in metres (99 % of the speed) of a turbulent boundary layer at the end of the flow's length, times the factor. The laws are:
///   fifth_root    0.37 L Re^-0.2 [Schlichting, ch. XXI]
///   seventh_root  0.16 L Re^(-1/7) [White], better above Re 1e7
/// \throws the errors of skin_friction
double layer_thickness(const ThicknessOptions& options, const FlowState& flow);

/// Returns a line such as "y+ 1 at the first node: 2.31e-06 m (cf 0.00263 by schlichting, u_tau 8.35 m/s; Re ...)".
std::string describe(const FirstHeight& first);
/// Returns a line such as "turbulent boundary layer: 0.0123 m (fifth_root, times 1.3; Re ...)".
std::string describe_thickness(const ThicknessOptions& options, const FlowState& flow);

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::FirstHeightOptions> {
  using O = volmesh::FirstHeightOptions;
  static constexpr std::string_view stage = "y_plus";
  static constexpr std::array fields = {
      Field<O>{.name = "y_plus",
               .member = &O::y_plus,
               .min = 1e-6,
               .max = 1e5,
               .help = "target y+ (dimensionless wall distance); the same as the first entry",
               .automatic = "the first entry"},
      Field<O>{.name = "at",
               .member = &O::at,
               .help = "location of y+: node for node-centred solvers (first node), cell_centre for cell-centred solvers (middle of the first cell)",
               .choices = "node cell_centre"},
      Field<O>{.name = "law",
               .member = &O::law,
               .help = "law of skin friction on a flat plate: local value at the length, or (the last two) mean over the length",
               .choices = "schlichting seventh_root kays_crawford prandtl prandtl_schlichting ittc57"},
  };
};

template <>
struct Schema<volmesh::ThicknessOptions> {
  using O = volmesh::ThicknessOptions;
  static constexpr std::string_view stage = "boundary_layer";
  static constexpr std::array fields = {
      Field<O>{.name = "factor",
               .member = &O::factor,
               .min = 0.01,
               .max = 100.0,
               .help = "factor on the thickness: with 1.2 to 1.5 the edge of the boundary layer lies inside the prism layers"},
      Field<O>{.name = "thickness_law",
               .member = &O::thickness_law,
               .help = "law of the thickness: 0.37 L Re^-0.2 or 0.16 L Re^(-1/7)",
               .choices = "fifth_root seventh_root"},
  };
};

}  // namespace sterna
