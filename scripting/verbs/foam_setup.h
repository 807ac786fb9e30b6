// What foam_case has decided before it writes: shared by its fields (foam_fields.cpp) and its settings (foam_settings.cpp).
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "scripting/verbs/foam_case.h"

namespace sterna::scripting {

struct FoamSetup {
  FoamOptions options;
  CaseOptions common;
  volmesh::FlowState flow;  ///< with speed and viscosity
  std::string model;        ///< "euler", "laminar", "SpalartAllmaras", "kOmegaSST"
  bool is_compressible = false;
  bool is_viscous = false;
  bool is_turbulent = false;
  double nu = 0.0;       ///< m^2/s, kinematic viscosity
  double density = 1.0;  ///< kg/m^3, used for the reported forces
  bool is_density_known = false;
  Vec3 velocity;                               ///< m/s, of the free stream
  double nu_tilda = 0.0;                       ///< m^2/s
  double k = 0.0;                              ///< m^2/s^2
  double omega = 0.0;                          ///< 1/s
  double area = k_automatic;                   ///< m^2, reference; automatic: no coefficients
  double length = 0.0;                         ///< m, reference
  Point moment_origin;                         ///< m
  std::vector<std::string> monitored;          ///< names of patches
  std::vector<std::string> inflows, outflows;  ///< openings of tunnels and ducts
  std::string application;
  std::string correction = "corrected";  ///< scheme of normal gradients
  std::string correction_reason;         ///< a sentence for fvSchemes
  int n_correctors = 0;                  ///< solutions for the pressure beside the first
  std::string settles_by;                ///< files, below postProcessing, whose values end a steady run when they settle; empty: residuals alone do
  bool has_fast_openings = false;        ///< openings or discs, by which velocities far above the flow's are right (contractions, jets)

  /// Initial residuals at which a steady run ends; 0: never by them. On layers of thin cells all are below 1e-6 while forces still move by a percent in 100
  /// iterations (docs/measurements/solvers.md), so that forces decide where there are any.
  double residual_limit() const { return !is_automatic(options.residual) ? options.residual : settles_by.empty() ? 1e-6 : 0.0; }
  bool has_pressure_drop() const { return !inflows.empty() && !outflows.empty(); }
  /// Name of the function object of the pressure drop from an inflow to an outflow.
  std::string pressure_drop(const std::string& inflow, const std::string& outflow) const {
    return inflows.size() == 1 && outflows.size() == 1 ? "pressureDrop" : "pressureDrop_" + inflow + "_" + outflow;
  }
  /// Returns true if there may be shocks: the pressure equation has its convective part.
  bool is_transonic() const {
    constexpr double k_transonic = 0.6;  // Mach number of the free stream
    return is_compressible && flow.mach >= k_transonic;
  }
  /// Unit, along the free stream.
  Vec3 drag_direction() const { return normalized(velocity); }
  /// Unit; perpendicular to the free stream, in the plane of x and z.
  Vec3 lift_direction() const {
    const Vec3 drag = drag_direction();
    return std::hypot(drag.x, drag.z) > 0.0 ? normalized(Vec3{-drag.z, 0.0, drag.x}) : Vec3{0.0, 0.0, 1.0};
  }
  /// Scheme of the velocity's convection, second order. Component by component laminar flow has it best, else along its steepest direction.
  std::string convection() const { return model == "laminar" && !is_compressible ? "Gauss linearUpwind grad(U)" : "Gauss linearUpwindV grad(U)"; }
};

/// The files of 0/: one for each field that the solver reads. \p used notes which conditions were asked for.
std::vector<CaseFile> foam_fields(const HybridMesh& mesh, const CaseSite& site, const std::vector<std::string>& names, const FoamSetup& setup,
                                  UsedBoundaries& boundaries, std::vector<PeriodicSides>& joined, CaseProblems& problems);
/// constant/ but the mesh, system/, Allrun, Allclean.
std::vector<CaseFile> foam_settings(const FoamSetup& setup);

/// "(1 0 0)"
std::string foam_vector(const Vec3& v);

}  // namespace sterna::scripting
