// Makes a case of OpenFOAM (1912 and newer) for a mesh: fields with their conditions by the kinds of patches, models, schemes, reference values, and scripts to
// run it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/mesh/check.h"
#include "geom/mesh/hybrid_mesh.h"
#include "scripting/verbs/solver_case.h"
#include "volmesh/flow/flow_state.h"

namespace sterna::scripting {

struct FoamOptions {
  std::string model = "automatic";
  bool steady = true;
  std::string compressible = "automatic";
  double turbulence_intensity = 0.001;
  double viscosity_ratio = k_automatic;
  double residual = k_automatic;
  double end_time = k_automatic;
  double courant = 2.0;
  int tasks = 1;
  int write_interval = 500;
  std::string format = "binary";
  std::string numbering = "both";
};

struct CaseFile {
  std::filesystem::path path;  ///< relative to the folder of the case
  std::string text;
  bool is_program = false;
};

/// A whole case except its polyMesh.
struct FoamCase {
  std::string application;  ///< "simpleFoam"
  std::vector<CaseFile> files;
  std::vector<PeriodicSides> joined;  ///< sides of actuator discs, which must become cyclic patches
};

/// Makes the case for a mesh. The solver is simpleFoam or pimpleFoam, for compressible flow rhoSimpleFoam or rhoPimpleFoam. Walls have no slip, or slip if the
/// flow has no viscosity (euler). Slip and symmetry patches keep their kinds. The farfield is free stream or extrapolation, depending on the direction of the
/// flow through each face. Inflow and outflow of tunnels (meshes without farfield) have speed and pressure of the flow, along the patch's normal. Inflow and
/// outflow of bodies in a farfield, and actuator discs, have the conditions in `boundaries`. Forces are computed on all walls except those of tunnels. Half
/// models have half the area; without a reference area there are only forces, no coefficients. A flow of which only the Reynolds number is known gets a speed
/// of 1 m/s. Corrections of normal gradients follow from the largest Measure::non_orthogonality. The decisions go to the log.
/// \throws Error(bad_argument) with all data that are neither in the mesh nor given
FoamCase foam_case(const HybridMesh& mesh, const FoamOptions& options, const CaseOptions& common, const volmesh::FlowState& flow,
                   const CaseReference& reference, const CaseBoundaries& boundaries, const RunContext& context, const CaseMeasure& non_orthogonality = {});

/// Checks the flow data that a case needs, independent of the mesh. Adds problems for the reader of a table, before meshing.
void require_foam_flow(const FoamOptions& options, const volmesh::FlowState& flow, CaseProblems& problems);

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::FoamOptions> {
  using O = scripting::FoamOptions;
  static constexpr std::string_view stage = "foam_case";
  static constexpr std::array fields = {
      Field<O>{.name = "model",
               .member = &O::model,
               .help = "turbulence model; automatic: SpalartAllmaras if the mesh has layers, otherwise euler (no viscosity)",
               .choices = "automatic laminar euler SpalartAllmaras kOmegaSST"},
      Field<O>{.name = "steady", .member = &O::steady, .help = "steady run; false: transient run, second order in time, with time steps by `courant`"},
      Field<O>{.name = "compressible",
               .member = &O::compressible,
               .help = "use rhoSimpleFoam instead of simpleFoam; automatic: from Mach 0.3 on",
               .choices = "automatic yes no"},
      Field<O>{.name = "turbulence_intensity",
               .member = &O::turbulence_intensity,
               .min = 1e-6,
               .max = 1.0,
               .help = "turbulence intensity of the free stream, relative to its speed (kOmegaSST)"},
      Field<O>{.name = "viscosity_ratio",
               .member = &O::viscosity_ratio,
               .min = 1e-6,
               .max = 1e5,
               .help = "ratio of turbulent to molecular viscosity in the free stream",
               .automatic = "0.21 with SpalartAllmaras, so nuTilda is 3 nu; 1 with kOmegaSST"},
      Field<O>{.name = "residual",
               .member = &O::residual,
               .min = 1e-14,
               .max = 1.0,
               .help = "a steady run ends when all initial residuals are below this limit, even if forces still change",
               .automatic = "1e-6 if there are neither forces nor a pressure drop; otherwise only these end the run"},
      Field<O>{.name = "end_time",
               .member = &O::end_time,
               .unit = Unit::second,
               .min = 1e-9,
               .max = 1e9,
               .help = "end time of a transient run",
               .automatic = "time in which the flow covers 20 reference lengths"},
      Field<O>{.name = "courant", .member = &O::courant, .min = 0.01, .max = 1000.0, .help = "largest Courant number of a transient run"},
      Field<O>{.name = "tasks",
               .member = &O::tasks,
               .min = 1,
               .max = 1000000,
               .help = "number of processes: Allrun decomposes (decomposeParDict), runs with mpirun and reconstructs; 1: serial run"},
      Field<O>{.name = "write_interval", .member = &O::write_interval, .min = 1, .max = 100000000, .help = "iterations or time steps between written results"},
      Field<O>{.name = "format", .member = &O::format, .help = "format of mesh and results", .choices = "binary text"},
      Field<O>{
          .name = "numbering",
          .member = &O::numbering,
          .help =
              "order of cells and nodes. lines: columns and growth lines first; bandwidth: neighbours near each other; both: whole lines, ordered by bandwidth",
          .choices = "lines bandwidth both"},
  };
};

}  // namespace sterna
