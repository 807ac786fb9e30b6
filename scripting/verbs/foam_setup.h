// The decisions of foam_case, made before it writes. They are shared by its fields (foam_fields.cpp) and its settings (foam_settings.cpp).
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "scripting/verbs/foam_case.h"

namespace sterna::scripting {

struct FoamSetup {
  FoamOptions options;
  CaseOptions common;
  volmesh::FlowState flow;  ///< flow, complete with speed and viscosity
  std::string model;        ///< "euler", "laminar", "SpalartAllmaras", "kOmegaSST"
  bool is_compressible = false;
  bool is_viscous = false;
  bool is_turbulent = false;
  double nu = 0.0;       ///< m^2/s, kinematic viscosity
  double density = 1.0;  ///< kg/m^3, used for the reported forces
  bool is_density_known = false;
  Vec3 velocity;                               ///< m/s, velocity of the free stream
  double nu_tilda = 0.0;                       ///< m^2/s, value of the free stream
  double k = 0.0;                              ///< m^2/s^2, value of the free stream
  double omega = 0.0;                          ///< 1/s, value of the free stream
  double area = k_automatic;                   ///< m^2, reference area; automatic: no coefficients
  double length = 0.0;                         ///< m, reference length
  Point moment_origin;                         ///< m
  std::vector<std::string> monitored;          ///< names of the patches whose forces are computed
  std::vector<std::string> inflows, outflows;  ///< openings of tunnels and ducts
  std::string application;
  std::string correction = "corrected";  ///< scheme for the correction of normal gradients
  std::string correction_reason;         ///< reason for that scheme, a sentence for fvSchemes
  int n_correctors = 0;                  ///< number of solutions for the pressure in addition to the first
  std::string settles_by;                ///< files below postProcessing whose values end a steady run when they settle; empty: only residuals end the run
  bool has_fast_openings = false;        ///< there are openings or discs where velocities far above the flow's are correct (contractions, jets)

  /// Returns the initial residuals at which a steady run ends; 0: residuals do not end the run. On layers of thin cells all residuals are below 1e-6 while
  /// forces still change by a percent in 100 iterations (docs/measurements/solvers.md). Therefore forces decide if there are any.
  double residual_limit() const { return !is_automatic(options.residual) ? options.residual : settles_by.empty() ? 1e-6 : 0.0; }
  bool has_pressure_drop() const { return !inflows.empty() && !outflows.empty(); }
  /// Returns the name of the function object of the pressure drop from an inflow to an outflow.
  std::string pressure_drop(const std::string& inflow, const std::string& outflow) const {
    return inflows.size() == 1 && outflows.size() == 1 ? "pressureDrop" : "pressureDrop_" + inflow + "_" + outflow;
  }
  /// Returns true if shocks are possible; the pressure equation then has its convective part.
  bool is_transonic() const {
    constexpr double k_transonic = 0.6;  // Mach number of the free stream
    return is_compressible && flow.mach >= k_transonic;
  }
  /// Returns the unit vector along the free stream.
  Vec3 drag_direction() const { return normalized(velocity); }
  /// Returns the unit vector perpendicular to the free stream, in the plane of x and z.
  Vec3 lift_direction() const {
    const Vec3 drag = drag_direction();
    return std::hypot(drag.x, drag.z) > 0.0 ? normalized(Vec3{-drag.z, 0.0, drag.x}) : Vec3{0.0, 0.0, 1.0};
  }
  /// Returns the second-order scheme for the convection of the velocity. It works component by component in laminar incompressible flow, else along the
  /// steepest direction.
  std::string convection() const { return model == "laminar" && !is_compressible ? "Gauss linearUpwind grad(U)" : "Gauss linearUpwindV grad(U)"; }
};

/// Returns the files of 0/, one for each field that the solver reads. \p boundaries records which conditions were used.
std::vector<CaseFile> foam_fields(const HybridMesh& mesh, const CasePatches& case_patches, const std::vector<std::string>& names, const FoamSetup& setup,
                                  UsedBoundaries& boundaries, std::vector<PeriodicSides>& joined, CaseProblems& problems);
/// Returns the files of constant/ (except the mesh) and system/, Allrun and Allclean.
std::vector<CaseFile> foam_settings(const FoamSetup& setup);

/// Returns "(1 0 0)".
std::string foam_vector(const Vec3& v);

}  // namespace sterna::scripting
